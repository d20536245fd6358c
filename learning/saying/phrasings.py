"""How each language is spoken, learned from the sentences that are still in memory when they can be read rightly."""

from collections.abc import Iterator, Mapping
from typing import Any

from learning.concept_id import Concept
from learning.grammar.actions import ActionTable
from learning.grammar.board_elements import BoardElements
from learning.grammar.reading_tree import tree_of
from learning.grounding.reading_learner import ReadingLearner
from learning.grounding.scripts import script_of
from learning.grounding.table_language import TableLanguage
from learning.saved_numbers import saved_count
from learning.saying.phrasing import Phrasing
from learning.saying.wording import marked

MOST = 1000
"""Sentences of a language that are heard again at a time."""
BOARD = "board"
"""Stands for the language of the board among those that tell how many sentences were heard."""


class Phrasings:
    """Phrasing of each script.

    Attributes:
        by_script: Script to how its language is spoken.
        heard: Script of a language of tables, or `BOARD`, to how many of its sentences were heard when they were
            counted last: these are not counted again.
    """

    def __init__(self) -> None:
        """Start without a word."""
        self.by_script: dict[str, Phrasing] = {}
        self.heard: dict[str, int] = {}

    def rehear_board(self, language: ReadingLearner, actions: ActionTable, bearing: frozenset[int]) -> None:
        """Count how sentences about the board were spoken, the newest of those that were not counted before.

        Args:
            language: What was learned, with its memory.
            actions: The known actions.
            bearing: Shape concepts that something can rest on.
        """
        fresh = language.sentences - self.heard.get(BOARD, 0)
        self.heard[BOARD] = language.sentences
        for episode in language.memory.newest(min(MOST, fresh)):
            found = language.read(episode.words, BoardElements(episode.arrangement, bearing), actions)
            shown = episode.shown
            right = [each for each in found.readings if each.does(shown.moved, shown.placement)]
            if right:
                self._of(script_of(episode.words)).hear(episode.words, tree_of(right[0], found.kept))
        for phrasing in self.by_script.values():
            phrasing.learn_names(language.grounding.counts)

    def rehear_tables(self, language: TableLanguage) -> None:
        """The same for sentences about tables."""
        for script, tongue in language.tongues.items():
            total = int(tongue.correlation.demos)
            fresh = total - self.heard.get(script, 0)
            self.heard[script] = total
            for pieces, origin, tree in tongue.heard_lately(min(MOST, fresh)):
                if tree is not None:
                    self._of(script).hear(marked(pieces, origin), tree)

    def _of(self, script: str) -> Phrasing:
        return self.by_script.setdefault(script, Phrasing())

    def rename(self, old: Concept, new: Concept) -> None:
        """Carry over the names of a concept that turned out to be another."""
        for phrasing in self.by_script.values():
            phrasing.rename(old, new)

    def concepts(self) -> Iterator[Concept]:
        """All concepts that have a name in any language."""
        for phrasing in self.by_script.values():
            yield from phrasing.concepts()

    def to_json(self) -> dict[str, Any]:
        """Plain numbers and strings."""
        return {
            "heard": dict(sorted(self.heard.items())),
            "languages": {script: phrasing.to_json() for script, phrasing in sorted(self.by_script.items())},
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "Phrasings":
        """Rebuild; raises KeyError, TypeError, ValueError or AttributeError for what `to_json` did not write."""
        phrasings = cls()
        phrasings.heard = {
            str(name): int(saved_count(count, f"sentences heard of {name}")) for name, count in data["heard"].items()
        }
        phrasings.by_script = {str(script): Phrasing.from_json(each) for script, each in data["languages"].items()}
        return phrasings
