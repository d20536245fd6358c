"""The thesis's way from a sentence and a percept to a goal: the learned Φ, Π and preferences."""

import math

from learning.concept_id import Concept
from learning.grammar.chart import Chart, LexicalEntry, Reading
from learning.grammar.scene import SceneSets, bits
from learning.grounding.language_learner import LanguageLearner
from learning.grounding.lexicon import lexical_entries
from learning.interpretation.interpretation import (
    ESTABLISHED,
    MEANINGFUL,
    Interpretation,
    listed,
    refusal,
    understanding,
)
from learning.knowledge import Knowledge
from learning.percept import Percept


class ThesisInterpreter:
    """Reads sentences with what the thesis's method learned."""

    def __init__(self, knowledge: Knowledge, language: LanguageLearner) -> None:
        """Use this knowledge and this part of it; neither is changed."""
        self.knowledge = knowledge
        self.language = language

    def interpret(self, words: tuple[str, ...], percept: Percept) -> Interpretation:
        """Find the most probable reading that the scene allows."""
        language = self.language
        unknown = tuple(dict.fromkeys(w for w in words if w not in language.correlation.ngram_counts))
        entries, skip = lexical_entries(words, language.grounding, language.preferences)
        if not any(entry.concept.space == "action" for entry in entries):
            said = (
                f"never heard: {listed(unknown, quoted=False)}"
                if unknown
                else "the words are known, but not as an action"
            )
            return refusal(words, f"no word of the sentence is known to name an action ({said})", unknown)
        scene = SceneSets(percept, self.knowledge.bearing_shapes())
        chart = Chart(
            len(words), entries, skip, language.grammar, scene, self.knowledge.action_table(), language.preferences
        )
        readings = chart.readings()
        if not readings:
            return refusal(words, self._why_nothing(words, entries, scene), unknown)
        weights = [language.log_weight(reading) for reading in readings]
        best = max(range(len(readings)), key=weights.__getitem__)
        share = 1.0 / sum(math.exp(min(weight - weights[best], 0.0)) for weight in weights)
        return self._interpretation(words, unknown, readings[best], share, percept)

    def _interpretation(
        self, words: tuple[str, ...], unknown: tuple[str, ...], reading: Reading, share: float, percept: Percept
    ) -> Interpretation:
        moved, places = bits(reading.moved), bits(reading.places)
        return understanding(
            words,
            percept,
            (reading.action, self.knowledge.spaces.actions[reading.action]),
            (moved[0], places[0] if places else None),
            (moved, places),
            (unknown, self._unheeded(words, reading)),
            reading.item.tree(),
            share,
        )

    def _unheeded(self, words: tuple[str, ...], reading: Reading) -> tuple[str, ...]:
        """Words with an established meaning that the reading passes over."""
        covered = reading.item.covered()
        grounding = self.language.grounding
        found = []
        for position, word in enumerate(words):
            total = grounding.total(word)
            if position in covered or total < ESTABLISHED:
                continue
            about = sum(
                amount
                for concept, amount in grounding.counts[word].items()
                if concept is not None and concept.space in ("colour", "shape", "location")
            )
            if about / total >= MEANINGFUL:
                found.append(word)
        return tuple(dict.fromkeys(found))

    def _why_nothing(self, words: tuple[str, ...], entries: list[LexicalEntry], scene: SceneSets) -> str:
        """Name the words whose meanings nothing in the scene has."""
        meanings: dict[tuple[int, int], list[Concept]] = {}
        for entry in entries:
            if entry.concept.space in ("colour", "shape"):
                meanings.setdefault((entry.first, entry.after), []).append(entry.concept)
        missing = [
            " ".join(words[first:after])
            for (first, after), concepts in sorted(meanings.items())
            if not any(scene.objects.get(concept) for concept in concepts)
        ]
        if missing:
            return f"nothing in the scene fits {listed(tuple(dict.fromkeys(missing)))}"
        return "the words do not add up to something that can be done in this scene"
