import numpy as np
import pytest

from executor.paraphrase import paraphrase, told


def test_all_words_are_replaced_by_others_of_their_meaning() -> None:
    for seed in range(20):
        rng = np.random.default_rng(seed)
        said = paraphrase("pick up the gray prism and put it on top of the red cube", rng, 1.0)
        verb, _, rest = said.partition(" the ")
        assert verb in {"take", "grab", "lift"}
        assert rest.startswith("grey pyramid and ")
        assert " red " in rest  # has no synonym


@pytest.mark.parametrize("sentence", ["put down the blue cube", "release the blue cube"])
def test_letting_go_stays_letting_go(sentence: str) -> None:
    """`put down` begins with another verb."""
    for seed in range(20):
        said = paraphrase(sentence, np.random.default_rng(seed), 1.0)
        assert said.split(" the ")[0] in {"drop", "put down", "release"}


def test_nothing_changes_without_variety() -> None:
    assert paraphrase("take the cyan block", np.random.default_rng(0), 0.0) == "take the cyan block"


def test_told_begins_with_the_sentence_and_says_nothing_twice() -> None:
    said = told("take the red cube", 5, np.random.default_rng(1))
    assert said[0] == "take the red cube"
    assert len(set(said)) == len(said) <= 5
    assert told("take the red cube", 1, np.random.default_rng(1)) == ("take the red cube",)
