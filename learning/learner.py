"""The learner: one incremental pass over demos and the sentences that describe them."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from learning.concepts import DemoConcepts, fit_demo
from learning.concepts.space_set import BOARD, COUNTER, TABLE
from learning.errors import PerceptionError
from learning.grammar.arrangement import Arrangement
from learning.grammar.scene import SceneSets
from learning.graphs.action_states import shown_action
from learning.grounding.language_learner import LanguageLearner
from learning.grounding.ngrams import words_of
from learning.grounding.table_scene import table_record
from learning.knowledge import Knowledge
from learning.perception import Observation, perceive, perceive_any

if TYPE_CHECKING:
    from teleop import Demo

REFRESHED = 20
"""Demos of tables after which all scenes in memory are seen with the concepts of then."""


@dataclass(frozen=True, slots=True)
class Lesson:
    """What came of one demo.

    Attributes:
        sentences: Sentences heard with it.
        validated: How many of them were read in a way that does what was shown.
        unheard: How many more came with it, of which nothing could be learned, as no action was seen.
    """

    sentences: int
    validated: int
    unheard: int = 0


class Learner:
    """Learns from one demo at a time; no demo is needed again (thesis 3.4, 4.8).

    What is shown on the board and what a camera saw at a table both teach concepts, actions and language.
    """

    def __init__(self, knowledge: Knowledge | None = None, seed: int = 0, method: str = "readings") -> None:
        """Go on from earlier knowledge, or start knowing nothing.

        Args:
            knowledge: What was learned before; it is updated in place. Where there is none, the first demo says in
                which feature spaces to learn.
            seed: Seed of the noise of perception and of the choice of points to cluster.
            method: How language is learned where there is no earlier knowledge: `readings` or `thesis`.

        Raises:
            KnowledgeError: There is no such method.
        """
        self._unsettled = knowledge is None
        self.knowledge = Knowledge(method=method) if knowledge is None else knowledge
        self.rng = np.random.default_rng([seed, self.knowledge.demos])

    def observe(self, demo: "Demo") -> Lesson:
        """Learn from a recorded demo and its utterances.

        Raises:
            PerceptionError: The demo shows what this knowledge has no feature spaces for, or cannot be perceived.
        """
        return self.study(perceive_any(demo, self.rng).observation, demo.utterances)

    def study(
        self, observation: Observation, utterances: Iterable[str], concepts: DemoConcepts | None = None
    ) -> Lesson:
        """Learn from tracks and the sentences that describe them.

        Args:
            observation: Tracks of one demo.
            utterances: Sentences about it.
            concepts: The demo's own mixtures where they were computed before (`fit_demo`).

        Raises:
            PerceptionError: This knowledge has no feature spaces for what is shown.
        """
        self._settle(observation)
        knowledge = self.knowledge
        spaces = knowledge.spaces
        words = [each for each in map(words_of, utterances) if each]
        spaces.update(fit_demo(observation, self.rng, spaces.space_set) if concepts is None else concepts)
        knowledge.follow_aliases()
        knowledge.demos += 1
        try:
            if observation.extent is not None:
                return Lesson(len(words), self._study_table(observation, words))
            percept, shown = perceive(observation, spaces)
            knowledge.follow_aliases()  # the action may have shown another one to be a variant
        except PerceptionError:
            return Lesson(0, 0, len(words))  # nothing moved: an arrangement to look at, but no action to speak of
        knowledge.count_bearing(percept)
        language, table, bearing = knowledge.language, knowledge.action_table(), knowledge.bearing_shapes()
        if isinstance(language, LanguageLearner):
            scene = SceneSets(percept, bearing)
            validated = sum(language.learn(each, percept, shown, scene, table) for each in words)
        else:
            arrangement = Arrangement.of(percept)
            validated = sum(language.learn(each, arrangement, shown, table, bearing, self.rng) for each in words)
        knowledge.sentences += len(words)
        return Lesson(len(words), validated)

    def settle(self) -> None:
        """Read all sentences about tables that are still in memory once more, with what is known by now.

        How languages are spoken is learned then, of all that is in memory and was not counted before.
        """
        language = self.knowledge.table_language
        language.refresh(self.knowledge.spaces)
        language.settle()
        self.knowledge.rehear()

    def _study_table(self, observation: Observation, words: list[tuple[str, ...]]) -> int:
        """Learn action and language of a demo at a table; returns how many sentences could be read.

        Raises:
            PerceptionError: No object was handled.
        """
        knowledge = self.knowledge
        graphlet, measures, moved = shown_action(observation, knowledge.spaces)
        number = knowledge.spaces.actions.match_or_add(graphlet, measures)
        knowledge.follow_aliases()  # it may have shown another action to be a variant
        knowledge.sentences += len(words)
        language = knowledge.table_language
        if knowledge.demos % REFRESHED == 0:
            language.refresh(knowledge.spaces)
        record = table_record(observation, knowledge.spaces, number, graphlet, moved)
        return language.learn(words, record, knowledge.spaces)

    def _settle(self, observation: Observation) -> None:
        """Choose feature spaces by the first demo; refuse what they are not made for."""
        at_table = observation.extent is not None
        if self._unsettled:
            self._unsettled = False
            if at_table:
                # What things weigh can be learned where the wrist feels.
                spaces = TABLE if observation.wrist_force is None else COUNTER
                self.knowledge = Knowledge(spaces, self.knowledge.language.method)
        name = self.knowledge.spaces.space_set.name
        if at_table == (name == BOARD.name):
            shown, made = ("a table", "the board") if at_table else ("the board", "tables")
            raise PerceptionError(
                f"the demo shows {shown}, but this knowledge was made on {made} (feature spaces '{name}'): "
                "learn it into a file of its own"
            )
