"""From a sentence and what the camera sees of a table to what is to be done with which thing, and where it goes."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from learning.concept_id import REFERENCE, Concept
from learning.grammar.rcl import RclNode
from learning.grounding.ngrams import ngrams_of
from learning.grounding.scripts import script_of
from learning.grounding.table_scene import PLACE_SPACE, TableRecord, TableScene, still_record
from learning.grounding.tongue import Tongue
from learning.interpretation.also_meant import also_meant
from learning.interpretation.interpretation import listed
from learning.interpretation.left_out import absent_phrases, unheeded_nodes
from learning.interpretation.nearly import NearlyDenotation
from learning.knowledge import Knowledge
from learning.perception.gaps import gap_offsets
from learning.perception.handling import FRAGMENT, felt
from learning.perception.observation import Observation
from learning.perception.tracks import anchors
from learning.saying.table_understanding import TableDenotation, TableUnderstanding


@dataclass(frozen=True, slots=True)
class TableGoal:
    """Where a thing goes.

    Attributes:
        concepts: Relations to a ground, or places.
        grounds: Indices of the things that the relation may be to; none for a place.
    """

    concepts: frozenset[Concept]
    grounds: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class TableReading:
    """How a sentence was understood at a table.

    Attributes:
        words: The sentence's words; a node's `first` and `last` count them from 1.
        tree: The RCL tree; None when nothing was understood.
        action: Number of the action; None where none is told.
        things: Indices of the things that it may be done to, in the observation.
        goal: Where they go; None where that is not told.
        unknown: Words that were never heard.
        explanation: What was understood, or why it was not.
        unheeded: Words that surely name what a thing is like, and that the tree passes over.
        absent: Words for things that nothing here is, among those that were understood and those passed over.
        unlearned: Words that were heard and not understood yet, neither alone nor with those beside them.
    """

    words: tuple[str, ...]
    tree: RclNode | None
    action: int | None
    things: tuple[int, ...]
    goal: TableGoal | None
    unknown: tuple[str, ...]
    explanation: str
    unheeded: tuple[str, ...] = ()
    absent: tuple[str, ...] = ()
    unlearned: tuple[str, ...] = ()

    @property
    def understood(self) -> bool:
        """Whether there is an action and a thing to do it to, and a ground where one is spoken of."""
        return self.action is not None and bool(self.things) and not self.nowhere

    @property
    def nowhere(self) -> bool:
        """Whether it goes to a thing that is not there."""
        return self.goal is not None and any(_relates(each) for each in self.goal.concepts) and not self.goal.grounds


class TableInterpreter:
    """Reads sentences about a table with what was learned; the knowledge is not changed."""

    def __init__(self, knowledge: Knowledge) -> None:
        """Use this knowledge."""
        self.knowledge = knowledge

    def interpret(
        self,
        words: tuple[str, ...],
        observation: Observation,
        *,
        held: int | None = None,
        last: int | None = None,
        choice: int | None = None,
    ) -> TableReading:
        """Understand a sentence about a world that stands still.

        Args:
            words: The sentence.
            observation: What is seen of the world.
            held: Index of the thing in the hand.
            last: Index of the thing that was handled last, which a reference may mean.
            choice: Index of the thing that was meant where several fit.
        """
        tongue = self.knowledge.table_language.tongues.get(script_of(words))
        if tongue is None:
            return TableReading(words, None, None, (), None, words, "no sentence in this script was ever heard")
        unknown = unknown_words(tongue, words)
        tree = tongue.parse(words)
        if tree is None:
            why = "nothing of the sentence was understood"
            why += f"; never heard {listed(unknown)}" if unknown else ""
            return TableReading(words, None, None, (), None, unknown, why, unlearned=unlearned_words(tongue, words))
        also = also_meant(tongue, words, tree, self.knowledge.spaces.mixtures)
        denotation = self._denotation(observation, held, also)
        meant = denotation.understand(tree)
        things = _indices(meant.things)
        if not things and last is not None and any(node.concept == REFERENCE for node in tree.nodes()):
            things = (last,)
        if choice in things:
            things = (choice,)
        action = None if meant.action is None else self.knowledge.spaces.actions.resolve(meant.action)
        if held is not None and action is not None and self._starts_held(action):
            things = (held,)  # what is in the hand is what is put down, however little of it is seen
        goal = None if meant.goal is None else TableGoal(meant.goal[0], _indices(meant.goal[1]))
        passed = unheeded_nodes(tongue, words, tree, self.knowledge.spaces.mixtures)
        reading = TableReading(
            words,
            tree,
            action,
            things,
            goal,
            unknown,
            "",
            tuple(words[node.first - 1] for node in passed),
            tuple(dict.fromkeys(absent_phrases(words, [*tree.nodes(), *passed], denotation))),
            unlearned_words(tongue, words),
        )
        return replace(reading, explanation=self._said(reading, meant))

    def scene(self, observation: Observation, held: int | None = None) -> TableScene:
        """What the camera sees, in the learner's symbols; nothing is shown in it."""
        return self.knowledge.table_language.scene(self._record(observation, held), self.knowledge.spaces)

    def _denotation(
        self, observation: Observation, held: int | None, also: Mapping[Concept, frozenset[Concept]]
    ) -> TableDenotation:
        """What words denote in what is seen."""
        spaces, language = self.knowledge.spaces, self.knowledge.table_language
        record = self._record(observation, held)
        return NearlyDenotation(language.scene(record, spaces), record.looks, spaces, language.sorts, also)

    def _record(self, observation: Observation, held: int | None) -> TableRecord:
        return still_record(observation, self.knowledge.spaces, anchors(observation)[1], held)

    def _starts_held(self, action: int) -> bool:
        return self.knowledge.spaces.actions[action].states[0].holds

    def _said(self, reading: TableReading, meant: TableUnderstanding) -> str:
        """What was understood, in plain words."""
        named = [
            f"{listed((' '.join(reading.words[node.first - 1 : node.last]),))} as {node.concept}"
            for node in meant.tree.nodes()
            if node.concept is not None
        ]
        parts = [f"understood {', '.join(named)}"]
        if reading.unknown:
            parts.append(f"never heard {listed(reading.unknown)}")
        if reading.unlearned:
            parts.append(f"not understood yet {listed(reading.unlearned)}")
        if reading.action is None:
            parts.append("no word says what to do")
        elif not reading.things:
            parts.append("nothing here is what the words say")
        elif reading.nowhere:
            parts.append("what it shall go to is not here")
        elif len(reading.things) > 1:
            parts.append(f"{len(reading.things)} things fit the words")
        return "; ".join(parts)


def held_thing(observation: Observation) -> int | None:
    """Index of the thing between the closed fingers; None where they feel nothing."""
    if not len(observation.object_ids) or not bool(felt(observation)[-1]):
        return None
    gap = np.linalg.norm(gap_offsets(observation)[-1], axis=1)
    nearest = int(np.argmin(gap))
    return nearest if gap[nearest] < FRAGMENT else None


def unknown_words(tongue: Tongue, words: tuple[str, ...]) -> tuple[str, ...]:
    """Words of which no piece was ever heard."""
    return tuple(word for word in dict.fromkeys(words) if not _heard(tongue, word))


def unlearned_words(tongue: Tongue, words: tuple[str, ...]) -> tuple[str, ...]:
    """Words that were heard and of which no piece was ever read, neither alone nor with those beside it."""
    pieces, origin = tongue.joined.split(words)
    read: set[int] = set()
    for ngram, spans in ngrams_of(pieces).items():
        if tongue.grounding.total(ngram) > 0.0:
            read.update(origin[at] for first, after in spans for at in range(first, after))
    left = dict.fromkeys(word for at, word in enumerate(words) if at not in read)
    return tuple(word for word in left if _heard(tongue, word))


def _heard(tongue: Tongue, word: str) -> bool:
    pieces = (word, *tongue.joined.pieces(word))
    return any(tongue.joined.counts.get(each, 0.0) > 0.0 or tongue.grounding.total(each) > 0.0 for each in pieces)


def _relates(concept: Concept) -> bool:
    return concept.space != PLACE_SPACE


def _indices(mask: int) -> tuple[int, ...]:
    return tuple(index for index in range(mask.bit_length()) if mask >> index & 1)
