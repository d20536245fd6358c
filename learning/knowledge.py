"""All that is kept of the demos seen: concepts, graphlets, K, Φ, Π, and how often what was borne by what."""

import json
import os
from collections import defaultdict, deque
from pathlib import Path
from typing import Any

from learning.concept_id import ACTION_SPACE, Concept
from learning.concepts import ConceptSpaces
from learning.concepts.space_set import BOARD, SpaceSet
from learning.errors import KnowledgeError
from learning.grammar.actions import ActionTable
from learning.graphs.action_graphlet import ActionGraphlet
from learning.grounding.language_learner import LanguageLearner
from learning.grounding.reading_learner import ReadingLearner
from learning.grounding.table_language import TableLanguage
from learning.knowledge_check import check_language, check_phrasings, check_table_language
from learning.percept import Percept
from learning.saved_numbers import saved_count
from learning.saying.phrasings import Phrasings

SCHEMA_VERSION = 1
LEAST_SIGHTINGS = 20
"""Sightings of a shape before its never bearing anything means that it cannot."""
LEAST_BEARING = 0.005
"""Share of sightings with something on top below which a shape is taken not to bear anything (noise aside)."""
MOST_LESSONS = 500
"""Demos that are remembered by their fingerprints."""

Language = LanguageLearner | ReadingLearner
METHODS: dict[str, type[LanguageLearner] | type[ReadingLearner]] = {
    ReadingLearner.method: ReadingLearner,
    LanguageLearner.method: LanguageLearner,
}
"""Ways to learn language by their names."""


class Knowledge:
    """What was learned. Saved as one readable JSON file; nothing in it is a demo or a sentence.

    Attributes:
        spaces: Visual concepts and action graphlets.
        language: Words and grammar of the board: by readings, or the thesis's way (K, Φ, Π and preferences).
        table_language: K, Φ and Π of each language heard at tables.
        phrasings: How each language is spoken: names of concepts, and words that stand between them.
        demos: Demos seen.
        sentences: Sentences heard.
        seen: Sightings of each shape concept.
        bearing: Sightings of each shape concept with something on top.
        lessons: Fingerprints of demos that were learned one at a time, so that none is learned twice: the latest ones.
    """

    def __init__(self, spaces: SpaceSet | str = BOARD, method: str = ReadingLearner.method) -> None:
        """Start knowing nothing.

        Args:
            spaces: The feature spaces to learn in, or the name of a known set of them.
            method: How language is learned: `readings` or `thesis`.

        Raises:
            KnowledgeError: No set has that name, or there is no such method.
        """
        self.spaces = ConceptSpaces(spaces)
        self.language: Language = _language(method)()
        self.table_language = TableLanguage()
        self.phrasings = Phrasings()
        self.demos = 0
        self.sentences = 0
        self.seen: defaultdict[int, float] = defaultdict(float)
        self.bearing: defaultdict[int, float] = defaultdict(float)
        self.lessons: deque[str] = deque(maxlen=MOST_LESSONS)
        self._table: tuple[dict[int, ActionGraphlet], ActionTable] | None = None

    def action_table(self) -> ActionTable:
        """Give the properties of the known action graphlets, and which two amount to which third."""
        library = self.spaces.actions
        known = dict(library.numbered)
        if self._table is None or self._table[0] != known:
            composed = {}
            for first, one in known.items():
                for second, two in known.items():
                    if one.states[-1].holds and two.states[0].holds:
                        number = library.find(one.followed_by(two))
                        if number is not None and number not in (first, second):
                            composed[first, second] = number
            self._table = (
                known,
                ActionTable(
                    {n: graphlet.states[0].holds for n, graphlet in known.items()},
                    {n: graphlet.states[-1].holds for n, graphlet in known.items()},
                    composed,
                ),
            )
        return self._table[1]

    def count_bearing(self, percept: Percept) -> None:
        """Count which shapes have something on top."""
        for number, clear in zip(percept.properties["shape"], percept.clear, strict=True):
            self.seen[int(number)] += 1
            self.bearing[int(number)] += not clear

    def bearing_shapes(self) -> frozenset[int]:
        """Shapes that something can rest on: seen to do so, or not seen often enough to tell."""
        return frozenset(
            number
            for number, seen in self.seen.items()
            if seen < LEAST_SIGHTINGS or self.bearing[number] > LEAST_BEARING * seen
        )

    def follow_aliases(self) -> None:
        """Rename concepts that were merged into older ones wherever language speaks of them."""
        numbers = {space: range(mixture.numbers_given) for space, mixture in self.spaces.mixtures.items()}
        numbers[ACTION_SPACE] = range(1, self.spaces.actions.numbers_given + 1)
        for space in numbers:
            for number in numbers[space]:
                kept = self.spaces.resolve(space, number)
                if kept != number and self.language.speaks_of(Concept(space, number)):
                    self.language.rename(Concept(space, number), Concept(space, kept))
                if kept != number and self.table_language.speaks_of(Concept(space, number)):
                    self.table_language.rename(Concept(space, number), Concept(space, kept))
                if kept != number:
                    self.phrasings.rename(Concept(space, number), Concept(space, kept))
        for counts in (self.seen, self.bearing):
            for number in [n for n in counts if self.spaces.resolve("shape", n) != n]:
                counts[self.spaces.resolve("shape", number)] += counts.pop(number)

    def rehear(self) -> None:
        """Learn how languages are spoken from the sentences that are still in memory."""
        if isinstance(self.language, ReadingLearner):
            self.phrasings.rehear_board(self.language, self.action_table(), self.bearing_shapes())
        self.phrasings.rehear_tables(self.table_language)

    def to_json(self) -> dict[str, Any]:
        """Plain numbers, lists and strings."""
        return {
            "schema": "showtell.knowledge",
            "version": SCHEMA_VERSION,
            "demos": self.demos,
            "sentences": self.sentences,
            "concepts": self.spaces.to_json(),
            "bearing": {str(n): [self.bearing[n], self.seen[n]] for n in sorted(self.seen)},
            "language": self.language.to_json(),
            "table_language": self.table_language.to_json(),
            "phrasings": self.phrasings.to_json(),
            "lessons": list(self.lessons),
        }

    @classmethod
    def from_json(cls, data: Any, source: str = "knowledge") -> "Knowledge":
        """Rebuild knowledge.

        Raises:
            KnowledgeError: `data` is not what `to_json` wrote; the message names `source` and the field.
        """
        if not isinstance(data, dict) or data.get("schema") != "showtell.knowledge":
            raise KnowledgeError(
                f"{source}: field 'schema' is not 'showtell.knowledge'; give a file that `showtell learn` wrote"
            )
        if data.get("version") != SCHEMA_VERSION:
            raise KnowledgeError(
                f"{source}: field 'version' is {data.get('version')!r}, expected {SCHEMA_VERSION}; learn again"
            )
        knowledge = cls()
        field = "concepts"
        try:
            knowledge.spaces = ConceptSpaces.from_json(data["concepts"])
            field = "language"
            # Files from before there was a choice are of the thesis's method.
            method = str(data["language"].get("method", LanguageLearner.method))
            knowledge.language = _language(method).from_json(data["language"])
            check_language(knowledge.language, knowledge.spaces)
            if "table_language" in data:  # older files know none
                field = "table_language"
                knowledge.table_language = TableLanguage.from_json(data["table_language"])
                check_table_language(knowledge.table_language, knowledge.spaces)
            if "phrasings" in data:  # older files do not say how a language is spoken
                field = "phrasings"
                knowledge.phrasings = Phrasings.from_json(data["phrasings"])
                check_phrasings(knowledge.phrasings, knowledge.spaces)
            field = "bearing"
            for number, (bearing, seen) in data["bearing"].items():
                knowledge.bearing[int(number)] = saved_count(bearing, f"bearing of shape_{number}")
                knowledge.seen[int(number)] = saved_count(seen, f"sightings of shape_{number}")
            field = "demos"
            knowledge.demos = int(saved_count(data["demos"], "number of demos"))
            field = "sentences"
            knowledge.sentences = int(saved_count(data["sentences"], "number of sentences"))
            field = "lessons"
            knowledge.lessons.extend(str(each) for each in data.get("lessons", ()))
        except KnowledgeError as error:
            raise KnowledgeError(f"{source}: {error}") from None
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise KnowledgeError(
                f"{source}: field '{field}' is malformed ({type(error).__name__}: {error}); learn again"
            ) from None
        return knowledge

    def save(self, path: str | Path) -> None:
        """Write one JSON file, first beside its place and then moved there, so that a failure loses nothing."""
        path = Path(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = path.with_name(f".{path.name}.{os.getpid()}")
        try:
            temporary.write_text(_readable(self.to_json()), encoding="utf-8")
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)

    @classmethod
    def load(cls, path: str | Path) -> "Knowledge":
        """Read a knowledge file.

        Raises:
            KnowledgeError: The file is missing, is no JSON, or has another schema version; the message names it.
        """
        path = Path(path)
        try:
            data = json.loads(path.read_text(encoding="utf-8"))
        except OSError as error:
            raise KnowledgeError(f"{path}: cannot be read ({error.strerror}); give a knowledge file") from None
        except (ValueError, RecursionError) as error:  # RecursionError: brackets nested without end
            raise KnowledgeError(f"{path}: is not JSON ({error}); give a file that `showtell learn` wrote") from None
        return cls.from_json(data, str(path))


def _language(method: str) -> type[LanguageLearner] | type[ReadingLearner]:
    if method not in METHODS:
        raise KnowledgeError(f"there is no method '{method}' to learn language; choose one of {', '.join(METHODS)}")
    return METHODS[method]


def _readable(data: Any, depth: int = 0) -> str:
    """JSON with one line an entry down to the fourth level, so that files can be read and compared."""
    if not isinstance(data, dict) or depth >= 5 or not data:
        return json.dumps(data, ensure_ascii=False)
    pad = " " * (depth + 1)
    rows = [f"{pad}{json.dumps(key, ensure_ascii=False)}: {_readable(value, depth + 1)}" for key, value in data.items()]
    return "{\n" + ",\n".join(rows) + "\n" + " " * depth + "}"
