import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from learning.concepts.feature_space import FAR, FEATURE_SPACES, NEAR, Colour, Direction, Distance, Location

unit = st.floats(0.0, 1.0)
length = st.floats(-0.5, 0.5)


@given(unit, unit, unit)
def test_hue_is_a_circle(hue: float, saturation: float, lightness: float) -> None:
    here, around = Colour.embed(np.array([[hue, saturation, lightness], [(hue + 1.0), saturation, lightness]]))
    assert np.allclose(here, around, atol=1e-12)  # cos and sin of angles 2 pi apart
    assert np.hypot(here[0], here[1]) == pytest.approx(saturation, abs=1e-12)


def test_reds_on_both_sides_of_the_wrap_are_close_and_greys_have_no_hue() -> None:
    reds = Colour.embed(np.array([[0.99, 0.8, 0.5], [0.01, 0.8, 0.5]]))
    assert np.linalg.norm(reds[0] - reds[1]) == pytest.approx(2 * 0.8 * np.sin(0.02 * np.pi), abs=1e-12)  # the chord
    greys = Colour.embed(np.array([[0.1, 0.0, 0.5], [0.6, 0.0, 0.5]]))
    assert np.array_equal(greys[0], greys[1])


@given(length, length, length)
def test_a_direction_is_its_two_angles_and_not_its_length(x: float, y: float, z: float) -> None:
    offset = np.array([x, y, z])
    if np.linalg.norm(offset) < 1e-6:
        return
    direction = Direction.embed(offset)
    azimuth, altitude = Direction.azimuth_altitude(offset)
    again = [np.cos(altitude) * np.cos(azimuth), np.cos(altitude) * np.sin(azimuth), np.sin(altitude)]
    assert np.allclose(direction, again, atol=1e-9)
    assert np.allclose(Direction.embed(3.0 * offset), direction, atol=1e-12)
    assert np.allclose(Direction.embed(-offset), -direction, atol=1e-12)


def test_the_direction_of_nothing_is_nothing() -> None:
    assert np.array_equal(Direction.embed(np.zeros((2, 3))), np.zeros((2, 3)))


def test_far_is_just_far() -> None:
    offsets = np.array([[0.0, 0.0, 0.038], [0.0, NEAR + 1e-6, 0.0], [0.3, 0.0, 0.4]])
    assert np.allclose(Distance.embed(offsets)[:, 0], [0.038, FAR, FAR])


def test_a_place_has_no_height() -> None:
    assert np.array_equal(Location.embed(np.array([[0.1, 0.2, 0.3]])), [[0.1, 0.2]])


@pytest.mark.parametrize("name", FEATURE_SPACES)
def test_spaces_say_what_they_embed_to(name: str) -> None:
    space = FEATURE_SPACES[name]
    measured = 33 if name == "shape" else 3
    assert space.name == name
    assert space.embed(np.full((4, 5, measured), 0.1)).shape == (4, 5, space.dimension)
