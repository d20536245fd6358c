"""How the words of a sentence may be read."""

from learning.concept_id import Concept
from learning.grammar.innate import COLLECTIVE, COUNTS, EXTREMES, FURTHEST, GROUP, SIDES, UNIT
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


def test_a_word_for_one_extreme_may_mean_furthest_beside_a_side() -> None:
    assert FURTHEST in meanings(table_of("più", EXTREMES[2], 20), "più")


def test_a_word_before_a_unit_may_be_a_number() -> None:
    table = table_of("passi", UNIT, 60)
    table.alignment.observe(("due",), (RED,))
    uses = table.of(("due", "passi"), ()).uses
    assert set(COUNTS) <= {use.concept for use in uses if use.first == 0}


def test_a_word_after_a_unit_may_be_a_side() -> None:
    """ "Two steps up": elsewhere the word is part of a verb."""
    table = table_of("passi", UNIT, 60)
    table.alignment.observe(("su",), (RED,))
    uses = table.of(("su", "passi", "su"), ()).uses
    assert not set(SIDES) & {use.concept for use in uses if use.first == 0}
    assert set(SIDES) <= {use.concept for use in uses if use.first == 2}


def test_an_open_mind_takes_any_word_without_a_plain_meaning_for_an_action() -> None:
    table = table_of("metti", RED, 100)
    for number in (1, 2):
        table.grounding.add("metti", Concept("shape", number), 100.0)
    take = Concept("action", 2)
    assert take not in meanings(table, "metti")
    assert take in {use.concept for use in table.of(("metti",), (2,), open_minded=True).uses}


def test_a_rare_word_for_a_part_of_a_shift_may_be_any_part() -> None:
    assert {UNIT, *COUNTS, *SIDES} <= meanings(table_of("passi", UNIT, 6), "passi")


def test_a_common_word_for_a_unit_is_no_count() -> None:
    assert not set(COUNTS) & meanings(table_of("passi", UNIT, 60), "passi")


def test_uses_know_the_word_after_them() -> None:
    uses = table_of("sinistra", SIDES[2], 20).of(("sinistra", "del", "sinistra"), ()).uses
    assert {use.following for use in uses if use.first == 0} == {"del"}
    assert {use.following for use in uses if use.first > 0} == {SENTENCE_END}


def test_a_word_that_was_never_heard_is_read_as_the_one_it_is_a_slip_for() -> None:
    table = table_of("rosso", RED, 20)
    assert RED in meanings(table, "rossso")
    assert RED in meanings(table, "rosos")
    assert RED not in meanings(table, "grosse")


def test_a_word_that_was_heard_is_never_taken_for_a_slip() -> None:
    table = table_of("rosse", SIDES[0], 20)
    assert RED not in meanings(table, "rosse")


def test_a_name_of_its_own_for_things_on_one_another_is_no_longer_form_of_a_name_of_one() -> None:
    """ "Cubes" says what a stack is made of, "stack" does not, whatever the sentences that have both made of it."""
    table = table_of("cubo", Concept("shape", 0), 50)
    for word in ("cubos", "pila"):
        table.alignment.observe((word,), (RED,))
        table.grounding.add(word, GROUP, 20.0)
    assert GROUP in meanings(table, "cubos")
    assert COLLECTIVE in meanings(table, "pila")
    assert GROUP not in meanings(table, "pila")


def test_a_word_that_was_often_said_of_one_action_is_hardly_said_of_another() -> None:
    take, put = Concept("action", 2), Concept("action", 3)

    def odds(times: int) -> float:
        uses = {use.concept: use.score for use in table_of("prendi", take, times).of(("prendi",), (2, 3)).uses}
        return uses[take] - uses[put]

    assert odds(1000) > odds(5) + 1.0
