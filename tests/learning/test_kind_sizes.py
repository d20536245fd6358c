"""Small and large among things of one kind, whatever things of other kinds are like."""

import math

import pytest

from learning.concept_id import Concept
from learning.grounding.kind_sizes import LARGER, SMALLER, KindSizes

BOTTLE, CUP = Concept("shape", 0), Concept("shape", 1)
SMALL, LARGE = math.log(0.06), math.log(0.09)


def seen(kind: Concept, *sizes: float) -> KindSizes:
    known = KindSizes()
    for size in sizes:
        known.see(kind, size)
    return known


def test_a_thing_is_compared_with_its_like_alone() -> None:
    known = seen(BOTTLE, *[SMALL, LARGE] * 4)
    for _ in range(4):
        known.see(CUP, LARGE)
        known.see(CUP, LARGE + 0.4)
    assert known.among(BOTTLE, LARGE) == LARGER
    assert known.among(CUP, LARGE) == SMALLER
    assert known.among(BOTTLE, SMALL) == SMALLER


def test_nothing_is_small_among_few_or_among_equals() -> None:
    assert seen(BOTTLE, SMALL, LARGE).among(BOTTLE, SMALL) is None
    assert seen(BOTTLE, *[LARGE, LARGE + 0.01] * 6).among(BOTTLE, LARGE) is None
    assert KindSizes().among(CUP, SMALL) is None


def test_kinds_that_turn_out_to_be_one_are_counted_together() -> None:
    parts = seen(BOTTLE, SMALL, SMALL, LARGE)
    for size in (LARGE, LARGE, SMALL, LARGE):
        parts.see(CUP, size)
    parts.rename(CUP, BOTTLE)
    whole = seen(BOTTLE, SMALL, SMALL, LARGE, LARGE, LARGE, SMALL, LARGE)
    assert list(parts.kinds) == [BOTTLE]
    assert parts.kinds[BOTTLE] == pytest.approx(whole.kinds[BOTTLE])


def test_sizes_survive_json() -> None:
    saved = seen(BOTTLE, *[SMALL, LARGE] * 4).to_json()
    assert KindSizes.from_json(saved).to_json() == saved


def test_a_damaged_count_is_refused() -> None:
    with pytest.raises(ValueError, match="things of shape_0 is -1"):
        KindSizes.from_json({"shape_0": [-1, 0.0, 0.0]})
