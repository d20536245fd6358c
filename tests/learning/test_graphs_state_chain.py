import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from learning.graphs.state_chain import most_likely_states, switching_cost


def costs(states: int, change: float) -> np.ndarray:
    return change * (1.0 - np.eye(states))


sequences = st.integers(1, 4).flatmap(
    lambda states: st.lists(st.lists(st.floats(-3, 0), min_size=states, max_size=states), min_size=1, max_size=6)
)


def total(likelihood: np.ndarray, path: tuple[int, ...], change: float) -> float:
    """Log probability of a path, up to a constant."""
    return sum(likelihood[i, s] for i, s in enumerate(path)) - change * sum(
        a != b for a, b in zip(path, path[1:], strict=False)
    )


@given(sequences, st.floats(0, 5))
def test_no_other_path_is_likelier(rows: list[list[float]], change: float) -> None:
    likelihood = np.array(rows)
    frames, states = likelihood.shape
    path = most_likely_states(likelihood, costs(states, change))
    best = max(total(likelihood, other, change) for other in np.ndindex(*(states,) * frames))
    assert total(likelihood, tuple(path), change) == pytest.approx(best, abs=1e-9)  # sums of up to twelve doubles


@given(st.lists(st.integers(0, 2), min_size=1, max_size=30))
def test_where_changes_cost_nothing_each_frame_has_its_best_state(states: list[int]) -> None:
    assert most_likely_states(np.eye(3)[states], costs(3, 0.0)).tolist() == states


@given(st.integers(1, 4), st.integers(4, 20), st.integers(5, 20))
def test_a_state_is_seen_where_it_gains_more_than_two_changes_cost(length: int, before: int, after: int) -> None:
    truth = np.zeros(before + 1 + length + after, dtype=int)
    truth[before + 1 : before + 1 + length] = 1
    likelihood = np.zeros((len(truth), 2))
    likelihood[np.arange(len(truth)), truth] = 3.0
    found = most_likely_states(likelihood, costs(2, 5.0))
    assert found.tolist() == (truth if 3.0 * length > 10.0 else 0 * truth).tolist()


def test_what_cannot_be_is_not_found() -> None:
    likelihood = np.array([[0.0, -9.0, -9.0], [-9.0, -9.0, 0.0], [-9.0, -9.0, 0.0]])
    change = costs(3, 1.0)
    assert most_likely_states(likelihood, change).tolist() == [0, 2, 2]
    change[0, 2] = np.inf  # only by way of state 1
    assert most_likely_states(likelihood, change).tolist() in ([0, 1, 2], [2, 2, 2])
    assert most_likely_states(likelihood[:, :2], change[:2, :2]).tolist() == [0, 0, 0]


def test_the_cost_is_the_log_odds_of_staying() -> None:
    assert switching_cost(15.0, 13) == pytest.approx(np.log(14 / 15) - np.log(1 / 15 / 12))
    assert switching_cost(30.0, 13) > switching_cost(15.0, 13) > switching_cost(15.0, 2)


def test_nothing_to_smooth_is_no_error() -> None:
    assert most_likely_states(np.zeros((0, 3)), costs(3, 1.0)).tolist() == []
