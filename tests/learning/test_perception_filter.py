import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from learning.perception.particle_filter import ParticleFilter
from learning.perception.surface_colour import hsl_of, surface_colour
from learning.perception.upright_box import held_points, upright_box

STATE = np.array([0.5, 0.1, 0.03, 200.0, 20.0, 10.0])
SIGMA = np.array([0.003] * 3 + [8.0] * 3)
STILL = np.array([0.4, 0.0, 0.2, 0.0, 0.0, 0.0, 1.0])
EYE = np.array([0.0, 0.0, 0.6])


def test_a_thing_at_rest_is_known_better_than_it_is_measured() -> None:
    rng = np.random.default_rng(0)
    belief = ParticleFilter(STATE, SIGMA, rng)
    errors = []
    for _ in range(100):
        belief.predict(STILL, STILL)
        belief.update(STATE + SIGMA * rng.standard_normal(6), SIGMA)
        errors.append(np.abs(belief.estimate()[:3] - STATE[:3]).max())
    assert np.median(errors) < 0.003  # one standard deviation of one measurement


def test_a_sudden_motion_is_followed_within_two_frames() -> None:
    belief = ParticleFilter(STATE, SIGMA, np.random.default_rng(0))
    there = STATE + np.array([0.10, 0, 0, 0, 0, 0])
    for _ in range(2):
        belief.predict(STILL, STILL)
        belief.update(there, SIGMA)
    assert np.linalg.norm(belief.estimate()[:3] - there[:3]) < 0.006  # two standard deviations


def test_a_held_thing_moves_and_turns_with_the_tool() -> None:
    belief = ParticleFilter(STATE, np.full(6, 1e-9), np.random.default_rng(0))
    belief.suppose_held(1.0)
    half = np.sqrt(0.5)
    turned = np.array([0.4, 0.0, 0.3, 0.0, 0.0, half, half])  # 10 cm up, a quarter turn about the vertical
    belief.predict(STILL, turned)
    # slip of 2 mm a frame, averaged over 200 particles
    assert belief.estimate()[:3] == pytest.approx([0.4 - 0.1, 0.0 + 0.1, 0.13], abs=0.001)
    belief.let_go()
    belief.predict(turned, STILL)
    assert belief.estimate()[:3] == pytest.approx([0.3, 0.1, 0.13], abs=0.001)


def test_of_two_hypotheses_the_measurement_chooses() -> None:
    belief = ParticleFilter(STATE, SIGMA, np.random.default_rng(0))
    belief.suppose_held(0.5)
    moved = STILL + np.array([0.0, 0.0, 0.05, 0, 0, 0, 0])
    belief.predict(STILL, moved)
    belief.update(STATE, SIGMA)
    assert belief.held_share < 0.05


def test_filterpy_leaves_numpys_own_generator_alone_and_the_seed_decides() -> None:
    np.random.seed(5)  # noqa: NPY002
    expected = np.random.random()  # noqa: NPY002
    results = []
    for _ in range(2):
        np.random.seed(5)  # noqa: NPY002
        rng = np.random.default_rng(1)
        belief = ParticleFilter(STATE, SIGMA, rng)
        for _ in range(5):
            belief.predict(STILL, STILL)
            belief.update(STATE, SIGMA)
        results.append(belief.estimate())
        assert np.random.random() == expected  # noqa: NPY002
    assert np.array_equal(*results)


@settings(max_examples=30, deadline=None)
@given(x=st.floats(0.3, 0.8), y=st.floats(-0.3, 0.3), size=st.floats(0.02, 0.1))
def test_the_box_of_a_lying_square_is_exact_but_for_its_pixels(x: float, y: float, size: float) -> None:
    line = np.linspace(-size / 2, size / 2, 15)
    u, v = np.meshgrid(line, line)
    points = np.column_stack((x + u.ravel(), y + v.ravel(), np.full(u.size, 0.01)))
    box = upright_box(points, EYE, 0.0)
    # the ends are quantiles: 2% of the width are cut off on each side at most
    assert box.centre[:2] == pytest.approx([x, y], abs=0.02 * size)
    assert box.extent[:2] == pytest.approx([size, size], rel=0.08)
    assert box.extent[2] == pytest.approx(0.01)


def test_a_round_thing_is_completed_behind() -> None:
    angle = np.linspace(np.pi / 2, 3 * np.pi / 2, 40)  # the half that looks to a camera at x < 0
    ring = np.column_stack((0.5 + 0.03 * np.cos(angle), 0.03 * np.sin(angle)))
    points = np.concatenate([np.column_stack((ring, np.full(40, z))) for z in np.linspace(0.0, 0.12, 20)])
    points = np.concatenate((points, [[0.51, 0.0, 0.12]] * 40))  # its shoulder
    box = upright_box(points, EYE, 0.0)
    assert box.centre[:2] == pytest.approx([0.5, 0.0], abs=0.004)


def test_what_is_felt_fills_the_gap_between_the_fingers() -> None:
    tool = np.array([0.5, 0.0, 0.2])
    seen = np.array([[0.5, 0.0, 0.28]])  # a cap that looks out over the hand
    felt = held_points(seen, tool, 0.06)
    assert np.linalg.norm(felt[:, :2] - tool[:2], axis=1) == pytest.approx(np.full(len(felt), 0.03))
    assert felt[:, 2].min() == pytest.approx(0.12)  # held by its middle
    both = np.concatenate((seen, [[0.5, 0.0, 0.1]]))
    assert held_points(both, tool, 0.06)[:, 2].min() == pytest.approx(0.2)


def test_colour_is_that_of_the_well_lit_main_colour() -> None:
    red = np.array([200.0, 20.0, 20.0])
    pixels = np.concatenate((np.tile(red, (40, 1)), np.tile(0.4 * red, (40, 1)), np.tile([220.0] * 3, (20, 1))))
    assert surface_colour(pixels) == pytest.approx(red)


@pytest.mark.parametrize(
    ("rgb", "hsl"),
    [((255, 0, 0), (0, 1, 0.5)), ((0, 255, 0), (1 / 3, 1, 0.5)), ((0, 0, 255), (2 / 3, 1, 0.5)),
     ((128, 128, 128), (0, 0, 128 / 255)), ((255, 255, 255), (0, 0, 1))],
)  # fmt: skip
def test_hsl_of_known_colours(rgb: tuple[int, ...], hsl: tuple[float, ...]) -> None:
    assert hsl_of(np.array(rgb, dtype=float)) == pytest.approx(hsl)
