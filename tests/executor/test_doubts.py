"""When a reading had better not be acted on, as far as words tell."""

import pytest

from executor.doubts import far_fetched, passed_over
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


BLUE, PALE, RED = (Concept("colour", number) for number in range(3))


@pytest.mark.parametrize(
    ("pale", "lost"),
    [
        ({PALE: 6.0, None: 4.0}, ("za",)),  # "pale blue" is another colour than blue
        ({BLUE: 6.0, None: 4.0}, ()),  # a shade of it
        ({None: 9.0, PALE: 1.0}, ()),  # says nothing
        ({PALE: 2.0}, ()),  # hardly heard
        ({PALE: 6.0, RED: 400.0, None: 300.0}, ()),  # not the word that tells of the two
    ],
)
def test_the_rarer_word_of_a_name_is_not_passed_over_where_it_means_another_look(
    pale: dict[Concept | None, float], lost: tuple[str, ...]
) -> None:
    knowledge = known("za", pale, blau={BLUE: 200.0, None: 10.0})
    tree = RclNode("entity", None, 1, 2, (RclNode("colour", BLUE, 2, 2),))
    assert passed_over(("za", "blau"), tree, knowledge) == lost


def test_the_commoner_word_of_a_name_may_be_passed_over() -> None:
    knowledge = known("za", {PALE: 6.0}, blau={BLUE: 200.0, None: 10.0})
    tree = RclNode("entity", None, 1, 2, (RclNode("colour", PALE, 1, 1),))
    assert passed_over(("za", "blau"), tree, knowledge) == ()
