"""The integer program (4.2) against an exhaustive search, and the case analysis (4.3 to 4.6)."""

from itertools import combinations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from learning.concept_id import Concept
from learning.grounding.case_analysis import filter_hypotheses
from learning.grounding.grounding import Grounding
from learning.grounding.integer_program import Pair, select_groundings
from learning.grounding.ngrams import ngrams_of, words_of

RED, TAKE, CUBE = Concept("colour", 1), Concept("action", 1), Concept("shape", 1)


def best_by_search(strengths: dict[Pair, float], epsilon: float) -> float:
    usable = [pair for pair, k in strengths.items() if k > 0]
    columns = {concept for _, concept in usable}
    limit = max(int(epsilon * len(strengths)), len(columns))
    values = [
        sum(strengths[pair] for pair in chosen)
        for size in range(len(columns), min(limit, len(usable)) + 1)
        for chosen in combinations(usable, size)
        if {concept for _, concept in chosen} == columns
    ]
    return max(values, default=0.0)


@settings(max_examples=25, deadline=None)
@given(st.lists(st.sampled_from([0.0, 0.1, 0.3, 0.5, 0.8, 1.0]), min_size=12, max_size=12), st.sampled_from([0.1, 0.4]))
def test_the_integer_program_finds_the_optimum(values: list[float], epsilon: float) -> None:
    pairs = [(ngram, concept) for ngram in "abcd" for concept in (RED, TAKE, CUBE)]
    strengths = dict(zip(pairs, values, strict=True))
    chosen = select_groundings(strengths, epsilon)
    assert sum(strengths[pair] for pair in chosen) == pytest.approx(best_by_search(strengths, epsilon), abs=1e-6)
    assert {concept for _, concept in chosen} == {pair[1] for pair, k in strengths.items() if k > 0}


def test_nothing_is_chosen_where_nothing_is_associated() -> None:
    assert select_groundings({("a", RED): 0.0}) == set()
    assert select_groundings({}) == set()


def test_a_longer_ngram_subsumes_two_that_mean_the_same() -> None:  # 4.3
    hypotheses = {("pick up", TAKE), ("pick", TAKE), ("up", TAKE)}
    assert filter_hypotheses(hypotheses) == {("pick up", TAKE)}


@pytest.mark.parametrize("extra", [set(), {("the", CUBE)}])
def test_a_longer_ngram_that_adds_nothing_goes(extra: set[Pair]) -> None:  # 4.4, 4.5
    assert filter_hypotheses({("the red", RED), ("red", RED)} | extra) == {("red", RED)} | extra
    assert filter_hypotheses({("red cube", RED), ("red", RED), ("cube", CUBE)}) == {("red", RED), ("cube", CUBE)}


def test_ngrams_that_mean_different_things_all_stay() -> None:  # 4.6
    hypotheses = {("break down", TAKE), ("break", RED), ("down", CUBE)}
    assert filter_hypotheses(hypotheses) == hypotheses


def test_words_are_lower_case_without_punctuation_in_any_script() -> None:
    assert words_of("Pick-up the RED block, that’s it!") == ("pick", "up", "the", "red", "block", "that's", "it")
    assert words_of("ضع المكعب الأحمر") == ("ضع", "المكعب", "الأحمر")
    assert words_of(" ...  ") == ()


def test_ngrams_know_all_their_spans() -> None:
    found = ngrams_of(("a", "b", "a", "b"))
    assert found["a b"] == [(0, 2), (2, 4)]
    assert found["a b a"] == [(0, 3)]
    assert "a b a b" not in found


def test_phi_is_equation_4_7() -> None:
    grounding = Grounding()
    apple, mug = Concept("shape", 1), Concept("shape", 2)
    for _ in range(9):
        grounding.add("apple", apple)
    grounding.add("apple", mug)
    grounding.add("apple", None, 5.0)
    assert grounding.probability("apple", apple) == pytest.approx(0.9)
    assert grounding.meanings("apple") == pytest.approx({apple: 0.9, mug: 0.1})
    assert Grounding.from_json(grounding.to_json()).meanings("apple") == pytest.approx({apple: 0.9, mug: 0.1})
    grounding.rename(mug, apple)
    assert grounding.probability("apple", apple) == pytest.approx(1.0)
