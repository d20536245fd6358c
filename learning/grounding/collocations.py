"""Words that belong together: what nearly always stands next to a word is part of its expression ("pick up").

Which of the words around it a meaning is said with cannot be told from what was shown: a reading that passes over "up"
does the same as one that does not. How often words stand side by side tells (collocations; Manning & Schütze 1999,
chapter 5), whatever their order in the language.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from learning.concept_id import ACTION_SPACE
from learning.grammar.rcl import RclNode
from learning.saved_numbers import saved_count

SHARE = 0.8
"""Share of a word's uses next to another one that makes the two one expression."""
LEAST_COUNT = 5
"""Uses of a word before its neighbours tell anything."""
NEIGHBOURS = 3
"""Neighbours that are counted of one word on one side. With so few counters (Misra & Gries 1982) what takes more than a
quarter of its uses is never lost, and the memory does not grow with the language."""
SAVED_SHARE = 0.5
"""Neighbours with a smaller share are not saved."""
EXPRESSIONS = (ACTION_SPACE, "relation", "direction", "distance", "side")
"""Labels of leaves that several words may make up."""

Row = dict[str, int]


class Collocations:
    """How often words stand next to each other, one sentence at a time."""

    def __init__(self) -> None:
        """Start knowing nothing."""
        self.counts: dict[str, int] = {}
        self._before: dict[str, Row] = {}
        self._after: dict[str, Row] = {}

    def hear(self, words: Sequence[str]) -> None:
        """Count one sentence."""
        for word in words:
            self.counts[word] = self.counts.get(word, 0) + 1
        for left, right in zip(words, words[1:], strict=False):
            _count(self._after.setdefault(left, {}), right)
            _count(self._before.setdefault(right, {}), left)

    def belongs_before(self, word: str, other: str) -> bool:
        """Whether nearly all uses of a word stand before another one."""
        return self._share(self._after, word, other) >= SHARE

    def belongs_after(self, word: str, other: str) -> bool:
        """Whether nearly all uses of a word stand after another one."""
        return self._share(self._before, word, other) >= SHARE

    def joined(self, tree: RclNode, words: Sequence[str]) -> RclNode:
        """Give each leaf for an action or a relation the words of its expression.

        A word that no leaf has is added to its neighbour when it nearly always stands there; one that was read as part
        of an action is taken out at either end when it stands beside other words too ("and place", "and put").

        Args:
            tree: Tree of a sentence.
            words: The sentence.

        Returns:
            The tree with other first and last words of leaves, and of what they are part of.
        """
        taken = {at for node in tree.nodes() if node.concept is not None for at in range(node.first - 1, node.last)}
        return self._joined(tree, words, taken)

    def _joined(self, node: RclNode, words: Sequence[str], taken: set[int]) -> RclNode:
        if node.concept is None:
            if not node.children:
                return node
            children = tuple(self._joined(child, words, taken) for child in node.children)
            first, last = min(child.first for child in children), max(child.last for child in children)
            return replace(node, children=children, first=first, last=last)
        if node.label not in EXPRESSIONS:
            return node
        first, after = node.first - 1, node.last
        if node.label == ACTION_SPACE:
            while after - first > 1 and not self._together(words[first], words[first + 1]):
                first += 1
            while after - first > 1 and not self._together(words[after - 2], words[after - 1]):
                after -= 1
        while after < len(words) and after not in taken and self.belongs_after(words[after], words[after - 1]):
            taken.add(after)
            after += 1
        while first > 0 and first - 1 not in taken and self.belongs_before(words[first - 1], words[first]):
            first -= 1
            taken.add(first)
        return replace(node, first=first + 1, last=after)

    def _together(self, left: str, right: str) -> bool:
        return self.belongs_before(left, right) or self.belongs_after(right, left)

    def _share(self, table: Mapping[str, Row], word: str, other: str) -> float:
        count = self.counts.get(word, 0)
        return table.get(word, {}).get(other, 0) / count if count >= LEAST_COUNT else 0.0

    def to_json(self) -> dict[str, Any]:
        """Word to its count and its frequent neighbours before and after it; words without any are left out."""
        saved = {}
        for word, count in sorted(self.counts.items()):
            sides = [
                {other: n for other, n in sorted(table.get(word, {}).items()) if n >= SAVED_SHARE * count}
                for table in (self._before, self._after)
            ]
            if count >= LEAST_COUNT and any(sides):
                saved[word] = [count, *sides]
        return saved

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "Collocations":
        """Rebuild; raises TypeError, ValueError or AttributeError for what `to_json` did not write."""
        collocations = cls()
        for word, (count, before, after) in data.items():
            collocations.counts[word] = int(saved_count(count, f"count of '{word}'", least=1))
            for table, row in ((collocations._before, before), (collocations._after, after)):
                table[word] = {
                    other: int(saved_count(number, f"count of '{other}' beside '{word}'"))
                    for other, number in row.items()
                }
        return collocations


def _count(row: Row, other: str) -> None:
    """Count a neighbour; a new one that finds no room takes one off all others."""
    if other in row or len(row) < NEIGHBOURS:
        row[other] = row.get(other, 0) + 1
        return
    for known in list(row):
        row[known] -= 1
        if not row[known]:
            del row[known]
