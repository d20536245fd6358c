"""A bounded memory of recent sentences with what was shown, for looking at them again (design section 5)."""

from collections import defaultdict
from dataclasses import dataclass, replace

import numpy as np

from learning.concept_id import Concept
from learning.grammar.arrangement import Arrangement
from learning.grammar.innate import ONE
from learning.grounding.alignment import Observed
from learning.percept import ShownAction

LARGEST = 1024
"""Most pairs kept. The oldest are forgotten first; none is saved with the knowledge."""

AT_HAND = frozenset((ONE,))
"""Kinds of meaning that nothing in a scene shows or denies."""
CERTAIN = 0.5
"""What readings of a larger share say is taken to be told."""


@dataclass(slots=True)
class Episode:
    """One sentence with what was shown.

    Attributes:
        words: The sentence.
        arrangement: The scene before the action.
        shown: The action.
        salient: What was salient in it.
        observed: What the sentence added to the alignment when it was looked at last.
        grounded: What it added to Φ when it was read last: word, meaning, amount.
        counted: Whether its rules were counted.
    """

    words: tuple[str, ...]
    arrangement: Arrangement
    shown: ShownAction
    salient: tuple[Concept, ...]
    observed: Observed
    grounded: tuple[tuple[str, Concept | None, float], ...] = ()
    counted: bool = False

    def told(self) -> frozenset[Concept]:
        """What the readings that did what was shown say for certain, in some words of the sentence.

        What any scene allows is left out: where it is told for certain, any rare word may have been read so.
        """
        amounts: defaultdict[Concept, float] = defaultdict(float)
        for _, concept, amount in self.grounded:
            if concept is not None and concept not in AT_HAND:
                amounts[concept] += amount
        return frozenset(concept for concept, amount in amounts.items() if amount > CERTAIN)


class Memory:
    """The last `LARGEST` episodes."""

    def __init__(self) -> None:
        """Start empty."""
        self.episodes: list[Episode] = []
        self._next = 0

    def keep(self, episode: Episode) -> None:
        """Keep an episode, in the place of the oldest when the memory is full."""
        if len(self.episodes) < LARGEST:
            self.episodes.append(episode)
        else:
            self.episodes[self._next] = episode
            self._next = (self._next + 1) % LARGEST

    def recall(self, count: int, rng: np.random.Generator) -> list[Episode]:
        """Choose some episodes at random."""
        if not self.episodes:
            return []
        return [self.episodes[int(index)] for index in rng.integers(len(self.episodes), size=count)]

    def newest(self, count: int) -> list[Episode]:
        """The last so many episodes that are kept, the oldest first."""
        in_order = [*self.episodes[self._next :], *self.episodes[: self._next]]
        return in_order[max(0, len(in_order) - count) :] if count > 0 else []

    def rename(self, old: Concept, new: Concept) -> None:
        """Rename a concept that was merged into another, in all that is kept."""
        for episode in self.episodes:
            episode.arrangement = episode.arrangement.renamed(old, new)
            episode.salient = tuple(new if concept == old else concept for concept in episode.salient)
            salient = tuple(new if concept == old else concept for concept in episode.observed.salient)
            episode.observed = episode.observed._replace(salient=salient)
            episode.grounded = tuple((word, new if c == old else c, n) for word, c, n in episode.grounded)
            if old.space == "action" and old.number in (shown := episode.shown).parts:
                parts = tuple(dict.fromkeys(new.number if part == old.number else part for part in shown.parts))
                action = new.number if shown.action == old.number else shown.action
                episode.shown = replace(shown, action=action, parts=parts)
