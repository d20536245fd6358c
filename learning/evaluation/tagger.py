"""The upper bound of grounding: a hidden Markov tagger trained on the true alignments (thesis 6.4.1)."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from importlib import import_module
from typing import Any

from learning.errors import LearningError
from learning.evaluation.language_pairs import SPACES, Pair
from learning.evaluation.table_gold import GoldSentence

NOTHING = "none"
GAMMA = 0.1
"""Lidstone smoothing of transitions and emissions."""
LEAST_SHARE = 0.12
"""A pair counts when the tagger gives the value to at least this share of the n-gram's occurrences, as with ours."""
SETTINGS = f"NLTK HiddenMarkovModelTrainer, one tag a feature space and value, Lidstone {GAMMA}"


def tagged(sentence: GoldSentence) -> list[tuple[str, str]]:
    """Words of a sentence with their tags, such as `colour:red` or `none`."""
    tags = [NOTHING] * len(sentence.words)
    for leaf in sentence.leaves:
        if leaf.element in SPACES:
            for at in range(leaf.head[0] - 1, leaf.head[1]):
                tags[at] = f"{leaf.element}:{leaf.value}"
    return list(zip(sentence.words, tags, strict=True))


class Tagger:
    """A supervised hidden Markov model of tags."""

    def __init__(self, sentences: Iterable[list[tuple[str, str]]]) -> None:
        """Train on tagged sentences.

        Raises:
            LearningError: There is nothing to train on.
        """
        probability, hmm = import_module("nltk.probability"), import_module("nltk.tag.hmm")
        given = list(sentences)
        states = sorted({tag for sentence in given for _, tag in sentence})
        symbols = sorted({word for sentence in given for word, _ in sentence})
        if not states:
            raise LearningError("there is no tagged sentence to train an HMM on")

        def smoothed(counts: Any, bins: int) -> Any:
            return probability.LidstoneProbDist(counts, GAMMA, max(bins, counts.B() + 1))

        trainer = hmm.HiddenMarkovModelTrainer(states, symbols)
        self._model = trainer.train_supervised(given, estimator=smoothed)
        self._known = set(symbols)

    def tags(self, words: Sequence[str]) -> list[str]:
        """The likeliest tag of each word."""
        if not words:
            return []
        return [str(tag) for _, tag in self._model.tag(list(words))]

    def pairs(self, sentences: Iterable[Sequence[str]]) -> dict[str, set[Pair]]:
        """Pairs that the tagger gives in sentences, by feature space."""
        uses: defaultdict[str, Counter[str]] = defaultdict(Counter)
        for words in sentences:
            tags = self.tags(words)
            at = 0
            while at < len(words):
                after = at + 1
                while after < len(words) and tags[after] == tags[at] != NOTHING:
                    after += 1
                uses[" ".join(words[at:after])][tags[at]] += 1
                at = after
        found: dict[str, set[Pair]] = {}
        for ngram, row in uses.items():
            for tag, count in row.items():
                if tag != NOTHING and count >= LEAST_SHARE * row.total():
                    space, _, value = tag.partition(":")
                    found.setdefault(space, set()).add((ngram, value))
        return found
