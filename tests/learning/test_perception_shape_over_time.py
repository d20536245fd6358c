import numpy as np
import pytest

from learning.perception.height_slices import height_weights
from learning.perception.shape_over_time import Glimpse, shape_over_time
from learning.perception.surface_colour import surface_colour
from learning.perception.table import Table, TableView
from robots.pose import FloatArray
from twin.camera.camera_model import CameraModel, looking_at

CAMERA = CameraModel.kinect2()
UP = np.array([0.0, 0.0, 1.0])
OUTLINE = np.array([[1.0, 0.0, 2.0], [-1.0, 0.0, 2.0], [0.0, 1.0, 2.0], [0.0, -1.0, 2.0]])
TABLE = Table(UP, 0.0, np.full(3, 100.0), np.eye(3), OUTLINE)
CENTRE = np.array([0.8, 0.0, 0.05])
VIEW = TableView(TABLE, CAMERA, looking_at((0.0, 0.0, 0.5), (0.8, 0.0, 0.05)))


def glimpse(frame: int, rows: int, *, whole: bool = True) -> Glimpse:
    """The nearer rows of a slab with a step of 2 cm after the sixth, 12 columns wide, seen at a metre or so."""
    middle = CAMERA.height // 2
    row, column = np.mgrid[middle - rows : middle, 150:162]
    pixels = (row * CAMERA.width + column).reshape(-1)
    slope = VIEW.points_at(np.ones(len(pixels)), pixels)[:, 2] - 0.5
    height = np.where(row.reshape(-1) < middle - 6, 0.05, 0.03)
    depth: FloatArray = (height - 0.5) / slope
    return Glimpse(frame, whole, CENTRE, pixels, depth, VIEW)


def test_what_was_never_seen_has_no_shape() -> None:
    found = shape_over_time([], 5)
    assert found.best.shape == found.glimpsed.shape == (5, 33)
    assert np.isnan(found.best).all() and np.isnan(found.glimpsed).all()


def test_what_is_never_seen_whole_is_measured_where_most_of_it_is_seen() -> None:
    halves = [glimpse(frame, 5, whole=False) for frame in range(10)]
    most = [glimpse(frame, 12, whole=False) for frame in range(10, 20)]
    found = shape_over_time([*halves, *most], 20)
    assert np.allclose(found.best.sum(axis=1), 1.0)
    assert np.array_equal(found.best[0], found.best[-1])  # half of it is no measurement
    assert not np.array_equal(found.glimpsed[0], found.glimpsed[-1])  # but it tells what hiding does


def test_whole_views_are_the_best_even_from_afar() -> None:
    found = shape_over_time([glimpse(0, 12, whole=False), glimpse(1, 6)], 2)
    alone = shape_over_time([glimpse(1, 6)], 2)
    assert np.array_equal(found.best, alone.best)


def test_a_sliver_is_not_looked_at() -> None:
    found = shape_over_time([glimpse(0, 12), glimpse(1, 3, whole=False)], 2)
    assert np.array_equal(found.glimpsed, found.best)


def test_every_height_counts_alike() -> None:
    heights = np.concatenate((np.full(90, 0.0), np.full(10, 0.1)))
    weights = height_weights(heights)
    assert weights.sum() == pytest.approx(100.0)
    assert weights[:90].sum() == pytest.approx(weights[90:].sum())
    assert height_weights(np.full(7, 0.03)) == pytest.approx(np.ones(7))


def test_a_lid_does_not_outweigh_the_body_that_the_hand_hides() -> None:
    red, lid = [180.0, 20.0, 20.0], [200.0, 200.0, 205.0]
    colours = np.concatenate((np.tile(lid, (60, 1)), np.tile(red, (25, 1))))
    heights = np.concatenate((np.full(60, 0.10), np.linspace(0.04, 0.09, 25)))
    assert surface_colour(colours, heights, hidden=True) == pytest.approx(red)


def test_a_lid_does_not_outweigh_the_body_that_is_looked_at_from_above() -> None:
    red, lid = [180.0, 20.0, 20.0], [200.0, 200.0, 205.0]
    colours = np.concatenate((np.tile(lid, (60, 1)), np.tile(red, (50, 1))))
    heights = np.concatenate((np.full(60, 0.07), np.linspace(0.0, 0.06, 50)))
    assert surface_colour(colours) == pytest.approx(lid)
    assert surface_colour(colours, heights) == pytest.approx(red)


def test_the_base_of_a_thing_does_not_outweigh_the_larger_part_that_is_seen_of_it() -> None:
    red, base = [180.0, 20.0, 20.0], [90.0, 90.0, 92.0]
    colours = np.concatenate((np.tile(red, (70, 1)), np.tile(base, (30, 1))))
    heights = np.concatenate((np.linspace(0.028, 0.043, 70), np.linspace(0.0, 0.026, 30)))
    assert surface_colour(colours, heights) == pytest.approx(red)


def test_a_white_cap_is_not_the_lit_side_of_a_black_bottle() -> None:
    black, cap = [10.0, 9.0, 11.0], [210.0, 210.0, 212.0]
    colours = np.concatenate((np.tile(black, (70, 1)), np.tile(cap, (40, 1))))
    assert surface_colour(colours) == pytest.approx(black)
