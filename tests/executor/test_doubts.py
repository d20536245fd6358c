"""When a reading had better not be acted on, as far as words tell."""

import pytest

from executor.doubts import far_fetched
from learning import Knowledge
from learning.concept_id import Concept
from learning.grammar.innate import EXTREMES, FURTHEST, NEAREST, SIDES
from learning.grammar.rcl import RclNode
from learning.grounding.reading_learner import ReadingLearner


def known(word: str, uses: dict[Concept | None, float], **more: dict[Concept | None, float]) -> Knowledge:
    knowledge = Knowledge()
    language = ReadingLearner()
    for each, row in {word: uses, **more}.items():
        for concept, count in row.items():
            language.grounding.add(each, concept, count)
    knowledge.language = language
    return knowledge


def leaf(concept: Concept, last: int) -> RclNode:
    return RclNode(concept.space, concept, 1, last)


@pytest.mark.parametrize(("uses", "doubted"), [(12.0, ()), (2.0, ("zu",))])
def test_a_word_that_is_mostly_passed_over_means_what_it_means_otherwise(uses: float, doubted: tuple[str, ...]) -> None:
    knowledge = known("zu", {None: 600.0, NEAREST: uses})
    assert far_fetched(("zu",), leaf(NEAREST, 1), knowledge) == doubted


def test_a_word_for_something_else_is_doubted() -> None:
    knowledge = known("zu", {None: 100.0, NEAREST: 100.0, SIDES[0]: 1.0})
    assert far_fetched(("zu",), leaf(SIDES[0], 1), knowledge) == ("zu",)


def test_an_extreme_may_be_said_as_furthest_and_a_side() -> None:
    knowledge = known("am", {FURTHEST: 50.0}, weitesten={None: 50.0}, links={SIDES[2]: 80.0})
    assert far_fetched(("am", "links"), leaf(EXTREMES[2], 2), knowledge) == ()
    assert far_fetched(("links",), leaf(EXTREMES[0], 1), knowledge) == ("links",)
