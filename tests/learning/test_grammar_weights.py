"""Weights of features."""

import pytest

from learning.grammar.weights import PRIORS, Weights


@pytest.mark.parametrize("how", ["modified", "ranked"])
def test_saying_what_tells_nothing_is_never_praised(how: str) -> None:
    weights, vain = Weights(), (how, "in vain")
    weights.follow({vain: -1.0})
    lower = weights.of(vain)
    for _ in range(50):
        weights.follow({vain: 1.0})
    assert lower < weights.of(vain) <= PRIORS[vain]


def test_what_leads_to_the_shown_move_is_praised() -> None:
    weights = Weights()
    weights.follow({("order", "colour", "shape"): 1.0})
    assert weights.of(("order", "colour", "shape")) > 0.0
