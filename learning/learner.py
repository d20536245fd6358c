"""The learner: one incremental pass over demos and the sentences that describe them."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from learning.concepts import DemoConcepts, fit_demo
from learning.errors import PerceptionError
from learning.grammar.scene import SceneSets
from learning.grounding.ngrams import words_of
from learning.knowledge import Knowledge
from learning.perception import Observation, observe_demo, perceive

if TYPE_CHECKING:
    from teleop import Demo


@dataclass(frozen=True, slots=True)
class Lesson:
    """What came of one demo.

    Attributes:
        sentences: Sentences heard with it.
        validated: How many of them were read in a way that does what was shown.
    """

    sentences: int
    validated: int


class Learner:
    """Learns from one demo at a time; no demo is needed again (thesis 3.4, 4.8)."""

    def __init__(self, knowledge: Knowledge | None = None, seed: int = 0) -> None:
        """Go on from earlier knowledge, or start knowing nothing.

        Args:
            knowledge: What was learned before; it is updated in place.
            seed: Seed of the noise of perception and of the choice of points to cluster.
        """
        self.knowledge = Knowledge() if knowledge is None else knowledge
        self.rng = np.random.default_rng([seed, self.knowledge.demos])

    def observe(self, demo: "Demo") -> Lesson:
        """Learn from a recorded demo and its utterances."""
        return self.study(observe_demo(demo, self.rng), demo.utterances)

    def study(
        self, observation: Observation, utterances: Iterable[str], concepts: DemoConcepts | None = None
    ) -> Lesson:
        """Learn from tracks and the sentences that describe them.

        Args:
            observation: Tracks of one demo.
            utterances: Sentences about it.
            concepts: The demo's own mixtures where they were computed before (`fit_demo`).
        """
        knowledge = self.knowledge
        knowledge.spaces.update(fit_demo(observation, self.rng) if concepts is None else concepts)
        knowledge.follow_aliases()
        knowledge.demos += 1
        try:
            percept, shown = perceive(observation, knowledge.spaces)
        except PerceptionError:
            return Lesson(0, 0)  # nothing moved: there is an arrangement to look at but no action to speak of
        knowledge.count_bearing(percept)
        scene = SceneSets(percept, knowledge.bearing_shapes())
        table = knowledge.action_table()
        heard = validated = 0
        for utterance in utterances:
            words = words_of(utterance)
            if words:
                heard += 1
                validated += knowledge.language.learn(words, percept, shown, scene, table)
        knowledge.sentences += heard
        return Lesson(heard, validated)
