"""Aligning words with what is salient."""

import numpy as np
import pytest

from learning.concept_id import Concept
from learning.grounding.alignment import Alignment, Observed, Way

COLOURS = {name: Concept("colour", number) for number, name in enumerate(("rosso", "blu", "verde"))}
SHAPES = {name: Concept("shape", number) for number, name in enumerate(("cubo", "prisma"))}


def taught(sentences: int = 200) -> Alignment:
    rng = np.random.default_rng(0)
    alignment = Alignment()
    for _ in range(sentences):
        colour, shape = str(rng.choice(list(COLOURS))), str(rng.choice(list(SHAPES)))
        alignment.observe(("il", shape, colour), (COLOURS[colour], SHAPES[shape]))
    return alignment


@pytest.mark.parametrize(("word", "concept"), [*COLOURS.items(), *SHAPES.items()])
def test_a_word_is_aligned_with_what_it_always_goes_with(word: str, concept: Concept) -> None:
    meanings = taught().meanings(word)
    assert max(meanings, key=lambda meaning: meanings[meaning]) == concept


def test_a_word_of_every_sentence_is_of_no_concept_alone() -> None:
    meanings = taught().meanings("il")
    assert max(meanings, key=lambda meaning: meanings[meaning]) is None


def test_what_was_never_heard_means_nothing() -> None:
    assert taught().meanings("giallo") == {}


def test_looking_again_replaces_what_was_counted() -> None:
    alignment = Alignment()
    words, salient = ("il", "cubo"), (COLOURS["rosso"], SHAPES["cubo"])
    observed = alignment.observe(words, salient)
    for _ in range(3):
        observed = alignment.observe(words, salient, observed)
    assert alignment.word_counts == {"il": 1, "cubo": 1}
    # Each word's shares sum to one, so two words count two in all (floating point aside).
    assert sum(alignment.totals.values()) == pytest.approx(2.0)


def test_it_survives_a_file_but_for_rounding() -> None:
    alignment = taught()
    again = Alignment.from_json(alignment.to_json(), alignment.told_to_json())
    assert again.word_counts == alignment.word_counts
    assert again.salient == alignment.salient
    assert again.told == pytest.approx(alignment.told, abs=0.01)
    for word in COLOURS:
        # Counts are saved with two decimals.
        assert again.meanings(word)[COLOURS[word]] == pytest.approx(alignment.meanings(word)[COLOURS[word]], abs=1e-3)


def test_counts_that_nobody_can_have_made_are_refused() -> None:
    with pytest.raises(ValueError, match="count of 'cubo'"):
        Alignment.from_json({"cubo": [-1, {}]})


def test_what_is_told_part_by_part_is_told_apart_from_what_is_told_as_one() -> None:
    """Taking is also seen alone; carrying is told as one ("porta"), or as taking and putting ("prendi", "posa")."""
    carry, take, put = (Concept("action", number) for number in (1, 2, 3))
    ways = Way(untold=frozenset((take, put))), Way(frozenset((take,)), frozenset((carry,)))
    told = {("prendi",): 2, ("porta",): 3, ("prendi", "posa"): 1}
    kinds = [verbs for verbs, often in told.items() for _ in range(often)]
    rng = np.random.default_rng(1)
    alignment = Alignment()
    memory: list[tuple[tuple[str, ...], Observed, tuple[Way, ...]]] = []
    for _ in range(600):
        colour = str(rng.choice(list(COLOURS)))
        verbs = kinds[int(rng.integers(len(kinds)))]
        words = (verbs[0], "il", colour, *verbs[1:])
        how: tuple[Way, ...] = (Way(),) if verbs == ("prendi",) else ways
        salient = (take,) if verbs == ("prendi",) else (carry, take, put)
        memory.append((words, alignment.observe(words, (COLOURS[colour], *salient), None, how), how))
        for index in rng.integers(len(memory), size=5):  # looked at again, as the learner does
            known, observed, how = memory[int(index)]
            memory[int(index)] = known, alignment.observe(known, observed.salient, observed, how), how
    for word, concept in (("prendi", take), ("porta", carry), ("posa", put)):
        meanings = alignment.meanings(word)
        assert max(meanings, key=lambda meaning: meanings[meaning]) == concept


def test_words_never_heard_are_rather_told_part_by_part_than_as_one() -> None:
    carry, take, put = (Concept("action", number) for number in (1, 2, 3))
    ways = Way(untold=frozenset((take, put))), Way(untold=frozenset((carry,)))
    observed = Alignment().observe(tuple("abcdefgh"), (carry, take, put), None, ways)
    for _, as_one, *as_parts in observed.shares:
        assert as_one < sum(as_parts)
