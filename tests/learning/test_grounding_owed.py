"""What a sentence owes: explaining away between its words."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from learning.concept_id import Concept
from learning.grounding.alignment import ENOUGH, Alignment, Observed
from learning.grounding.owed import MOST_ODDS, is_in_ways, log_odds_told, log_untold, with_owed

CUBE, PRISM = (Concept("shape", number) for number in range(2))
COLOURS = [Concept("colour", number) for number in range(6)]
SIDES = [Concept("side", number) for number in range(4)]
NAMES = ("rosso", "blu", "verde", "giallo", "nero", "bianco")
RARE = 60.0


def experienced() -> Alignment:
    alignment = Alignment()
    alignment.sentences = ENOUGH
    return alignment


def heard(rng: np.random.Generator, sentences: int) -> tuple[Alignment, list[tuple[tuple[str, ...], Observed]]]:
    """Things of many colours, nearly all of them cubes, called "cubo" or, seldom, "dado"; sides are rarely told."""
    alignment = Alignment()
    memory = []
    for number in range(sentences):
        colours = [int(each) for each in rng.choice(len(COLOURS), 2, replace=False)]
        is_prism = rng.random() < 0.4
        side = SIDES[int(rng.integers(4))] if rng.random() < 0.5 else None
        head = "dado" if number % 30 == 7 else "cubo"
        words = ["metti", "il", "prisma" if is_prism else head, NAMES[colours[0]], "sul", head, NAMES[colours[1]]]
        if side is not None and rng.random() < 0.2:
            words += ["lato", str(side)]
        salient = {
            CUBE,
            *(COLOURS[each] for each in colours),
            *([PRISM] if is_prism else []),
            *([side] if side else []),
        }
        memory.append((tuple(words), alignment.observe(words, tuple(sorted(salient)))))
        for _ in range(3):
            other = int(rng.integers(len(memory)))
            known, observed = memory[other]
            memory[other] = known, alignment.observe(known, observed.salient, observed)
    return alignment, memory


def test_a_rare_word_for_what_is_there_in_every_scene_is_learned_by_what_its_sentences_leave_untold() -> None:
    alignment, memory = heard(np.random.default_rng(3), 600)
    memory = [(words, alignment.level(words, observed, RARE)) for words, observed in memory]
    for _ in range(6):
        memory = [(words, alignment.observe(words, observed.salient, observed)) for words, observed in memory]
    meanings = alignment.meanings("dado")
    others = [share for meaning, share in meanings.items() if meaning not in (None, CUBE)]
    # "Cubo" is said with nearly everything, so it is itself not told from words like "il" by alignment alone; reading
    # does that. What counts is that "dado" is tried for a cube before all else. Words by themselves: 0.02.
    assert meanings[CUBE] > 0.08
    assert meanings[CUBE] > 1.5 * max(others)


def test_levelling_takes_back_what_was_made_of_rare_words_alone() -> None:
    alignment, memory = heard(np.random.default_rng(0), 200)
    frequent = alignment.meanings("cubo")
    for words, observed in memory:
        alignment.level(words, observed, RARE)
    assert alignment.meanings("cubo") == pytest.approx(frequent, abs=1e-9)  # sums in another order
    assert alignment.joint["dado"][CUBE] == pytest.approx(
        sum(words.count("dado") / len(observed.meanings) for words, observed in memory)
    )


def test_what_is_told_for_certain_draws_a_word_to_it() -> None:
    near = Concept("relation", 2)
    words, salient = ("il", "cubo", "vicino"), (CUBE, near)
    doubted = experienced().observe(words, salient)
    certain = experienced().observe(words, salient, told=frozenset((near,)))
    index = salient.index(near) + 1
    assert all(sure[index] > unsure[index] for sure, unsure in zip(certain.shares, doubted.shares, strict=True))


@pytest.mark.parametrize(("told_once", "untold"), [(False, [0.9, 0.9, 0.25]), (True, [0.45, 0.45, 0.25])])
def test_the_same_word_twice_is_no_other_word_but_for_an_action(told_once: bool, untold: list[float]) -> None:
    shares = np.array([[0.5, 0.5], [0.5, 0.5], [0.9, 0.1]])
    in_ways = np.array([False, told_once])
    twice, once = (
        np.exp(log_untold(words, shares, in_ways)[1]) for words in (("red", "red", "the"), ("red", "blue", "the"))
    )
    assert twice[:, 1] == pytest.approx(untold)
    assert once[:, 1] == pytest.approx([0.45, 0.45, 0.25])


@given(st.integers(1, 5), st.integers(1, 5), st.randoms(use_true_random=False))
def test_shares_stay_shares(words: int, concepts: int, random: object) -> None:
    rng = np.random.default_rng(random.getrandbits(32))  # type: ignore[attr-defined]
    shares = rng.dirichlet(np.ones(concepts + 1), words)
    in_ways = rng.random(concepts + 1) < 0.3
    untold = log_untold([str(rng.integers(3)) for _ in range(words)], shares, in_ways)[1]
    odds = rng.uniform(-MOST_ODDS, MOST_ODDS, concepts + 1)
    shifted = with_owed(shares, untold, odds, rng.integers(1, 500, words).astype(float))
    assert np.all(shifted >= 0.0)
    assert shifted.sum(axis=1) == pytest.approx(np.ones(words))


def test_odds_follow_how_often_something_is_told_and_are_bounded() -> None:
    assert log_odds_told(CUBE, 1000, 990) > log_odds_told(CUBE, 1000, 500) > log_odds_told(CUBE, 1000, 10)
    assert log_odds_told(CUBE, 1e6, 1e6) == MOST_ODDS
    assert log_odds_told(CUBE, 1e6, 0.0) == -MOST_ODDS


@pytest.mark.parametrize("space", ["action", "reference"])
def test_nothing_is_owed_of_what_ways_of_speaking_tell_apart(space: str) -> None:
    other = Concept(space, 1)
    assert is_in_ways(other) and not is_in_ways(None) and not is_in_ways(CUBE)
    shares = experienced().observe(("metti", "il", "cubo"), (CUBE, other)).shares
    again = experienced().observe(("metti", "il", "cubo"), (CUBE, other), told=frozenset((other,))).shares
    assert again == shares
    assert log_odds_told(other, 1000, 990) == 0.0


def test_the_first_sentences_owe_nothing() -> None:
    words, salient = ("il", "cubo"), (CUBE,)
    plain = Alignment().observe(words, salient)
    assert Alignment().observe(words, salient, told=frozenset(salient)) == plain
    assert experienced().observe(words, salient, told=frozenset(salient)) != plain
