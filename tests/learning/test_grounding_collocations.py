"""Words that belong together."""

import json
from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from learning.concept_id import Concept
from learning.grammar.rcl import RclNode
from learning.grounding.collocations import NEIGHBOURS, Collocations

TAKE, DROP, RED = Concept("action", 1), Concept("action", 2), Concept("colour", 0)


def heard(*sentences: str, times: int = 6) -> Collocations:
    collocations = Collocations()
    for _ in range(times):
        for sentence in sentences:
            collocations.hear(tuple(sentence.split()))
    return collocations


def leaf(concept: Concept, first: int, last: int) -> RclNode:
    return RclNode(concept.space, concept, first, last)


def spans(collocations: Collocations, sentence: str, leaves: Sequence[RclNode]) -> list[tuple[int, int]]:
    """First and last word of the event and of its leaves."""
    event = RclNode("event", None, min(each.first for each in leaves), max(each.last for each in leaves), tuple(leaves))
    return [(node.first, node.last) for node in collocations.joined(event, tuple(sentence.split())).nodes()]


def test_a_particle_that_always_follows_its_verb_is_part_of_it() -> None:
    collocations = heard("tira su il cubo", "tira il cubo", "posa il cubo", "posa il prisma")
    assert spans(collocations, "tira su il cubo", [leaf(TAKE, 1, 1)]) == [(1, 2), (1, 2)]


def test_a_verb_before_the_particle_that_was_taken_for_it_is_part_of_it() -> None:
    collocations = heard("tira su il cubo", "posa il cubo", "posa il prisma")
    assert spans(collocations, "tira su il cubo", [leaf(TAKE, 2, 2)]) == [(1, 2), (1, 2)]


def test_what_joins_sentences_is_no_part_of_a_verb() -> None:
    collocations = heard("prendi e posa", "prendi e metti", "prendi e lascia", "posa", "metti")
    assert spans(collocations, "prendi e posa", [leaf(TAKE, 1, 1), leaf(DROP, 2, 3)]) == [(1, 3), (1, 1), (3, 3)]


def test_a_word_is_never_part_of_two_leaves() -> None:
    collocations = heard("tira su")
    assert spans(collocations, "tira su", [leaf(TAKE, 1, 1), leaf(DROP, 2, 2)]) == [(1, 2), (1, 1), (2, 2)]


def test_looks_have_no_words_around_them() -> None:
    assert spans(heard("cubo rosso"), "cubo rosso", [leaf(RED, 2, 2)]) == [(2, 2), (2, 2)]


def test_a_rare_word_belongs_to_nothing() -> None:
    assert not heard("tira su", times=4).belongs_after("su", "tira")
    assert heard("tira su", times=5).belongs_after("su", "tira")


def test_learning_goes_on_from_a_file() -> None:
    collocations = heard("tira su il cubo", "tira il cubo", times=20)
    again = Collocations.from_json(json.loads(json.dumps(collocations.to_json())))
    assert again.to_json() == collocations.to_json()
    assert again.belongs_after("su", "tira") and not again.belongs_before("tira", "su")


def test_counts_that_nobody_can_have_made_are_refused() -> None:
    with pytest.raises(ValueError, match="beside 'su'"):
        Collocations.from_json({"su": [5, {"tira": -1}, {}]})


@given(st.lists(st.lists(st.sampled_from("abcdefg"), min_size=1, max_size=6), max_size=60))
def test_a_share_is_never_told_too_high_and_never_far_too_low(sentences: list[list[str]]) -> None:
    collocations = Collocations()
    for sentence in sentences:
        collocations.hear(sentence)
    pairs = [pair for sentence in sentences for pair in zip(sentence, sentence[1:], strict=False)]
    for word, other in set(pairs):
        told = collocations._share(collocations._after, word, other)
        count = collocations.counts[word]
        true = pairs.count((word, other)) / count
        assert told <= true
        assert told == 0.0 or told >= true - 1 / (NEIGHBOURS + 1)
