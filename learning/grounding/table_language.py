"""Language of tables: a tongue for each script that sentences were heard in, over the concepts that all share."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from learning.concept_id import Concept
from learning.concepts.concept_spaces import ConceptSpaces
from learning.grammar.rcl import RclNode
from learning.grounding.evidence import ANY
from learning.grounding.kind_sizes import KindSizes
from learning.grounding.namings import Namings
from learning.grounding.scripts import script_of
from learning.grounding.sorts import Sorts
from learning.grounding.table_scene import RestingPlaces, TableRecord, TableScene, kinds_and_sizes, table_scene
from learning.grounding.tongue import Tongue
from learning.saved_numbers import saved_count

SORTED = ("colour", "shape")
"""Spaces of looks in which words help to tell sorts of things apart."""


class TableLanguage:
    """What is known of all languages heard at tables.

    Attributes:
        tongues: Script to what is known of its language.
        resting: Where things rest, which is what far, near, left and right are measured by.
        namings: Space of looks to what things were called there.
        sorts: Space of looks to the sorts that words tell apart there.
        sizes: How large things of each kind are.
    """

    def __init__(self) -> None:
        """Start knowing nothing."""
        self.tongues: dict[str, Tongue] = {}
        self.resting = RestingPlaces()
        self.namings = {space: Namings() for space in SORTED}
        self.sorts = {space: Sorts() for space in SORTED}
        self.sizes = KindSizes()

    def learn(self, sentences: Iterable[tuple[str, ...]], record: TableRecord, spaces: ConceptSpaces) -> int:
        """Learn from the sentences about one demo; returns how many could be read so that they do what was shown.

        Args:
            sentences: Words of each.
            record: What was shown.
            spaces: Concepts, already updated with the demo.
        """
        for place in record.resting():
            self.resting.add(place)
        sentences = list(sentences)
        self._sort(sentences, record)
        for kind, size in kinds_and_sizes(record, spaces, self.sorts):
            self.sizes.see(kind, size)
        scene = self.scene(record, spaces)
        by_script: dict[str, list[tuple[str, ...]]] = {}
        for words in sentences:
            by_script.setdefault(script_of(words), []).append(words)
        return sum(
            self.tongues.setdefault(script, Tongue()).learn(said, record, scene)
            for script, said in sorted(by_script.items())
        )

    def scene(self, record: TableRecord, spaces: ConceptSpaces) -> TableScene:
        """What a record shows, in symbols, by all that is known now."""
        return table_scene(record, spaces, self.resting, self.sorts, self.sizes)

    def _sort(self, sentences: Iterable[tuple[str, ...]], record: TableRecord) -> None:
        """Learn what sort of thing the one in hand is, from what it is called."""
        said = [(self.tongues[script], words) for words in sentences if (script := script_of(words)) in self.tongues]
        for space in SORTED:
            names = [name for tongue, words in said if (name := tongue.name_of_thing(words, space)) is not None]
            self.namings[space].hear(names)
            kind = self.namings[space].kind(names)
            if kind is not None and space in record.looks:
                self.sorts[space].see(kind, record.looks[space][record.moved])

    def refresh(self, spaces: ConceptSpaces) -> None:
        """See all scenes in memory with the concepts of today."""
        for tongue in self.tongues.values():
            tongue.refresh(lambda record: self.scene(record, spaces))

    def settle(self, rounds: int = 1) -> None:
        """Read all sentences in memory again, so many times."""
        for _ in range(rounds):
            for tongue in self.tongues.values():
                tongue.settle()

    def parse(self, words: tuple[str, ...], scene: TableScene | None = None) -> RclNode | None:
        """The most likely tree of a sentence, see `Tongue.parse`; None in a script that was never heard."""
        tongue = self.tongues.get(script_of(words))
        return None if tongue is None else tongue.parse(words, scene)

    def meanings(self, ngram: str) -> dict[Concept, float]:
        """What an n-gram means, see `Tongue.meanings`; nothing in a script that was never heard."""
        tongue = self.tongues.get(script_of(tuple(ngram.split(" "))))
        return {} if tongue is None else tongue.meanings(ngram)

    def speaks_of(self, concept: Concept) -> bool:
        """Whether any word was heard with a concept."""
        return any(
            concept in tongue.correlation.concept_counts or concept in tongue.grounding.concept_totals
            for tongue in self.tongues.values()
        )

    def rename(self, old: Concept, new: Concept) -> None:
        """Carry over all that was learned of a concept that turned out to be another."""
        self.sizes.rename(old, new)
        for tongue in self.tongues.values():
            tongue.rename(old, new)

    def concepts(self) -> set[Concept]:
        """All concepts that any word was heard with."""
        found: set[Concept] = set()
        for tongue in self.tongues.values():
            found |= {concept for concept in tongue.grounding.concept_totals if concept is not None}
            found |= {each for each in tongue.correlation.concept_counts if not each.space.startswith(ANY)}
        return found

    def to_json(self) -> dict[str, Any]:
        """Plain numbers, lists and strings."""
        resting = self.resting
        return {
            "resting": [resting.count, resting.mean.tolist(), resting.square.tolist()],
            "namings": {space: namings.to_json() for space, namings in sorted(self.namings.items())},
            "sorts": {space: sorts.to_json() for space, sorts in sorted(self.sorts.items())},
            "sizes": self.sizes.to_json(),
            "tongues": {script: tongue.to_json() for script, tongue in sorted(self.tongues.items())},
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "TableLanguage":
        """Rebuild; raises KeyError, TypeError, ValueError or AttributeError for what `to_json` did not write."""
        language = cls()
        count, mean, square = data["resting"]
        language.resting = RestingPlaces(
            saved_count(count, "number of resting places", least=1),
            np.array(mean, dtype=np.float64).reshape(2),
            np.array(square, dtype=np.float64).reshape(2),
        )
        language.namings = {space: Namings.from_json(data["namings"][space]) for space in SORTED}
        language.sorts = {space: Sorts.from_json(data["sorts"][space]) for space in SORTED}
        language.sizes = KindSizes.from_json(data.get("sizes", {}))  # older files hold none
        language.tongues = {script: Tongue.from_json(tongue) for script, tongue in data["tongues"].items()}
        return language
