"""K: equation 4.1, its correction for chance, habituation, forgetting."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from learning.concept_id import Concept
from learning.grounding.correlation import MEMORY, CorrelationMatrix

RED, BLUE = Concept("colour", 1), Concept("colour", 2)


def matrix_of(pairs: list[tuple[list[str], list[Concept]]], **options: float) -> CorrelationMatrix:
    matrix = CorrelationMatrix(**options)
    for ngrams, concepts in pairs:
        matrix.observe(ngrams, concepts)
    return matrix


def test_strength_is_equation_4_1() -> None:
    # "red" heard 4 times, the concept seen 3 times, both together 2 times.
    matrix = matrix_of(
        [(["red"], [RED])] * 2 + [(["red"], [BLUE])] * 2 + [(["blue"], [RED])],
        tau=5.0,
    )
    expected = max(2 / 4, 2 / 3) * (1 - math.exp(-min(4, 3) / 5.0))
    assert matrix.strength("red", RED) == pytest.approx(expected, abs=1e-12)


def test_a_name_shared_by_two_concepts_is_fully_associated_with_each() -> None:
    # The example of thesis 4.3: 20 clips named "eris", ten with one face, ten with another.
    one, other = Concept("face", 1), Concept("face", 2)
    matrix = matrix_of([(["eris"], [one])] * 10 + [(["eris"], [other])] * 10, tau=1e-9)
    assert matrix.strength("eris", one) == pytest.approx(1.0)
    assert matrix.strength("eris", other) == pytest.approx(1.0)


def test_pairs_never_seen_together_have_no_strength() -> None:
    matrix = matrix_of([(["red"], [RED])])
    assert matrix.strength("red", BLUE) == 0.0
    assert matrix.strength("green", RED) == 0.0
    assert "green" not in matrix.joint_counts


def test_a_word_of_every_sentence_has_no_strength_beyond_chance() -> None:
    pairs = [(["the", "red"], [RED]), (["the", "blue"], [BLUE])] * 30
    matrix = matrix_of(pairs)
    assert matrix.strength("the", RED) > 0.9
    assert matrix.strength_beyond_chance("the", RED) == 0.0
    assert matrix.strength_beyond_chance("red", RED) > 0.8
    assert matrix.strongest("the") < 0.1 < matrix.strongest("red")


def test_an_habituated_row_stops_growing_and_keeps_its_strength() -> None:
    matrix = matrix_of([(["red"], [RED]), (["blue"], [BLUE])] * 20, habituation=10.0)
    assert matrix.ngram_counts["red"] == 10
    before = matrix.strength("red", RED)
    for _ in range(50):
        matrix.observe(["red"], [BLUE])
    assert matrix.strength("red", BLUE) == 0.0
    assert matrix.ngram_counts["red"] == 10
    assert matrix.strength("red", RED) <= before


def test_chance_combinations_are_forgotten_and_words_kept() -> None:
    matrix = CorrelationMatrix()
    for number in range(int(2 * MEMORY)):
        matrix.observe(["red", f"once{number}"], [RED])
    assert matrix.ngram_counts["red"] == 2 * MEMORY or matrix.ngram_counts["red"] == matrix.habituation
    assert len(matrix.ngram_counts) <= MEMORY + 1


def test_renaming_adds_the_counts_up() -> None:
    matrix = matrix_of([(["red"], [RED])] * 3 + [(["red"], [BLUE])] * 2)
    matrix.rename(BLUE, RED)
    assert matrix.joint_counts["red"][RED] == 5
    assert matrix.concept_counts[RED] == 5
    assert BLUE not in matrix.concept_counts


def test_renaming_what_was_never_counted_leaves_no_trace() -> None:
    matrix = matrix_of([(["red"], [RED])])
    before = matrix.to_json()
    matrix.rename(BLUE, Concept("colour", 7))
    assert matrix.to_json() == before


words = st.lists(st.sampled_from("abcd"), min_size=1, max_size=3)
concepts = st.lists(st.sampled_from([RED, BLUE, Concept("shape", 1)]), max_size=3)


@given(st.lists(st.tuples(words, concepts), max_size=25))
def test_strengths_stay_in_the_unit_interval_and_survive_json(pairs: list[tuple[list[str], list[Concept]]]) -> None:
    matrix = matrix_of(pairs)
    again = CorrelationMatrix.from_json(matrix.to_json())
    for ngram in "abcd":
        for concept in (RED, BLUE):
            assert 0.0 <= matrix.strength(ngram, concept) <= 1.0
            assert 0.0 <= matrix.strength_beyond_chance(ngram, concept) <= 1.0
            assert again.strength(ngram, concept) == matrix.strength(ngram, concept)
            assert again.strength_beyond_chance(ngram, concept) == matrix.strength_beyond_chance(ngram, concept)
