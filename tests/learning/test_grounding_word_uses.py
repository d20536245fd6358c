"""How the words of a sentence may be read."""

from learning.concept_id import Concept
from learning.grammar.innate import COUNTS, NEAREST, NEAREST_ONE, SIDES, UNIT
from learning.grammar.weights import Weights
from learning.grounding.alignment import Alignment
from learning.grounding.grounding import Grounding
from learning.grounding.word_uses import SENTENCE_END, UseTable

RED = Concept("colour", 0)


def table_of(word: str, meaning: Concept, times: int) -> UseTable:
    """A word that was heard, aligned with and validated as one meaning so many times, among others."""
    alignment, grounding = Alignment(), Grounding()
    for _ in range(20):
        alignment.observe(("rosso",), (RED,))
    for _ in range(times):
        alignment.observe((word,), (meaning,))
        grounding.add(word, meaning, 1.0)
    return UseTable(alignment, grounding, Weights())


def meanings(table: UseTable, word: str) -> set[Concept]:
    """All meanings tried of a word."""
    return {use.concept for use in table.of((word,), ()).uses}


def test_a_word_for_nearest_to_something_may_be_said_of_the_nearest_one() -> None:
    assert {NEAREST, NEAREST_ONE} <= meanings(table_of("vicino", NEAREST, 20), "vicino")


def test_a_word_seldom_validated_as_nearest_is_not() -> None:
    table = table_of("vicino", NEAREST, 2)
    table.grounding.add("vicino", None, 20.0)
    assert NEAREST_ONE not in meanings(table, "vicino")


def test_a_rare_word_for_a_part_of_a_shift_may_be_any_part() -> None:
    assert {UNIT, *COUNTS, *SIDES} <= meanings(table_of("passi", UNIT, 6), "passi")


def test_a_common_word_for_a_unit_is_no_count() -> None:
    assert not set(COUNTS) & meanings(table_of("passi", UNIT, 60), "passi")


def test_uses_know_the_word_after_them() -> None:
    uses = table_of("sinistra", SIDES[2], 20).of(("sinistra", "del", "sinistra"), ()).uses
    assert {use.following for use in uses if use.first == 0} == {"del"}
    assert {use.following for use in uses if use.first > 0} == {SENTENCE_END}
