"""How deep objects overlap, by boxes and by parts; and the files that physics reads."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from twin.objects import object_model
from twin.objects.files import object_files, shrunk
from twin.objects.overlap import box_depth, footprint_depth, parts_depth

UNIT = (0.5, 0.5, 0.5)
FLOOR = 0.005
"""Thickness of a bowl's floor [m]."""


def test_boxes_overlap_by_their_least_depth() -> None:
    assert box_depth(UNIT, UNIT, (0.9, 0.2, 0.1)) == pytest.approx(0.1)
    assert box_depth(UNIT, UNIT, (0.2, 0.1, 1.5)) == pytest.approx(-0.5)
    # Turned by 45 degrees, a square reaches sqrt(1/2) along x.
    assert footprint_depth(UNIT, UNIT, (1.3, 0.0), 0.0, np.pi / 4) == pytest.approx(0.5 + np.sqrt(0.5) - 1.3)


@given(st.floats(-3, 3), st.floats(-3, 3), st.floats(-1, 1), st.floats(-1, 1))
def test_footprints_do_not_depend_on_who_is_first(one: float, other: float, x: float, y: float) -> None:
    long, wide = (0.6, 0.1, 0.1), (0.3, 0.2, 0.1)
    forth = footprint_depth(long, wide, (x, y), one, other)
    assert forth == pytest.approx(footprint_depth(wide, long, (-x, -y), other, one))


def test_an_apple_in_a_bowl_does_not_overlap_it_but_in_its_wall_it_does() -> None:
    bowl, apple = object_model("white_bowl"), object_model("red_apple")
    in_bowl = float(apple.half_extents[2]) + FLOOR - float(bowl.half_extents[2]) + 0.0001
    middle = (0.0, 0.0, 0.0)
    assert parts_depth((bowl, middle, 0.3), (apple, (0.0, 0.0, in_bowl), 1.0)) == 0.0
    assert parts_depth((bowl, middle, 0.3), (apple, (0.045, 0.0, 0.0), 1.0)) > 0.003
    assert parts_depth((bowl, middle, 0.3), (apple, (0.0, 0.0, in_bowl - 0.004), 1.0)) > 0.003


@given(st.integers(0, 2**32 - 1))
def test_shrunk_hulls_have_every_face_a_margin_further_in(seed: int) -> None:
    corners = np.random.default_rng(seed).uniform(-0.02, 0.02, (8, 3))
    faces = ConvexHull(corners).equations
    try:
        inner = shrunk(corners, 0.0005)
    except Exception:  # a sliver thinner than two margins has nothing inside
        assert ConvexHull(corners).volume < 1e-7
        return
    reach = (inner @ faces[:, :3].T + faces[:, 3]).max(axis=0)
    assert reach.max() < -0.0005 + 1e-8


def test_files_hold_a_group_for_each_hull() -> None:
    model = object_model("blue_mug")
    files = object_files(model)
    assert files.hulls is not None
    assert files.hulls.read_text(encoding="ascii").count("\no part_") + 1 == len(model.parts)
    assert len(files.drawn) == len(model.visuals)
    assert object_files(model) is files
    assert object_files(object_model("red_cube")).hulls is None
