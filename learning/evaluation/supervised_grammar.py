"""The upper bound of grammar on the board: a smoothed PCFG over the tags of a supervised tagger (after Abney 1996).

The tagger gives each word an element and a value, or nothing; the grammar, counted from annotated trees, puts the
elements together. Rules are binarised with all of their history, and a rule of two elements never seen together is not
impossible but rare.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from learning.evaluation.public_tree import PublicNode

UNSEEN = -9.0
"""Log probability of joining what was never seen joined: the next element of a rule that was never so long."""
MOST_ELEMENTS = 30
"""Elements of the longest sentence that is parsed."""
ROOTS = ("event", "sequence")
SETTINGS = "HMM tags, then a PCFG counted from the annotated trees (relative frequencies, unseen joins allowed), CKY"


@dataclass(frozen=True, slots=True)
class _Cell:
    """The best way to cover a span with a symbol."""

    score: float
    node: PublicNode | None
    children: tuple[PublicNode, ...] = ()


Symbol = tuple[str, tuple[str, ...]]
"""An element (with no parts), or a rule that has got so far: element and the labels of its children up to here."""


class SupervisedGrammar:
    """Rules counted from annotated trees."""

    def __init__(self, trees: Iterable[PublicNode]) -> None:
        """Count the rules of aligned nodes, children in the order of their words."""
        counts: defaultdict[str, Counter[tuple[str, ...]]] = defaultdict(Counter)
        for tree in trees:
            for node in tree.nodes():
                labels = tuple(child.label for child in _aligned(node))
                if labels and node.tokens is None:
                    counts[node.label][labels] += 1
        self._ends: dict[tuple[str, tuple[str, ...]], float] = {}
        self._goes_on: defaultdict[str, set[Symbol]] = defaultdict(set)
        self._starts: defaultdict[str, set[str]] = defaultdict(set)
        self._labels = sorted(counts)
        for label, rows in counts.items():
            for labels, count in rows.items():
                self._ends[label, labels] = math.log(count / rows.total())
                self._starts[labels[0]].add(label)
                for length in range(1, len(labels)):
                    self._goes_on[labels[length]].add((label, labels[:length]))

    def parse(self, leaves: Sequence[PublicNode]) -> PublicNode | None:
        """The likeliest tree over leaves in the order of their words; None where there are none, or too many.

        Args:
            leaves: Nodes with a label, a value and tokens.
        """
        size = len(leaves)
        if not 0 < size <= MOST_ELEMENTS:
            return None
        chart: dict[tuple[int, int], dict[Symbol, _Cell]] = {}
        for length in range(1, size + 1):
            for first in range(size - length + 1):
                after = first + length
                cells: dict[Symbol, _Cell] = {}
                if length == 1:
                    _better(cells, (leaves[first].label, ()), _Cell(0.0, leaves[first]))
                for middle in range(first + 1, after):
                    self._join(cells, chart[first, middle], chart[middle, after])
                self._close(cells)
                chart[first, after] = cells
        whole = [
            (cell.score, cell.node) for (label, parts), cell in chart[0, size].items() if not parts and label in ROOTS
        ]
        if whole:
            return max(whole, key=lambda entry: entry[0])[1]
        return PublicNode("event", None, None, tuple(leaves))

    def _join(self, cells: dict[Symbol, _Cell], left: Mapping[Symbol, _Cell], right: Mapping[Symbol, _Cell]) -> None:
        for (label, parts), one in left.items():
            if not parts:
                continue
            for (other, more), two in right.items():
                if more or two.node is None:
                    continue
                seen = (label, parts) in self._goes_on.get(other, ())
                score = one.score + two.score + (0.0 if seen else UNSEEN)
                if seen or len(parts) < 3:
                    _better(cells, (label, (*parts, other)), _Cell(score, None, (*one.children, two.node)))

    def _close(self, cells: dict[Symbol, _Cell]) -> None:
        """Finish rules and begin new ones, until nothing changes: elements of one part stack up a little."""
        for _ in range(3):
            for (label, parts), cell in list(cells.items()):
                if parts:
                    end = self._ends.get((label, parts), UNSEEN)
                    node = PublicNode(label, None, None, cell.children)
                    _better(cells, (label, ()), _Cell(cell.score + end, node))
                elif cell.node is not None:
                    for above in self._starts.get(label, ()):
                        _better(cells, (above, (label,)), _Cell(cell.score, None, (cell.node,)))


def _better(cells: dict[Symbol, _Cell], symbol: Symbol, cell: _Cell) -> None:
    if symbol not in cells or cell.score > cells[symbol].score:
        cells[symbol] = cell


def _aligned(node: PublicNode) -> list[PublicNode]:
    """Children with words, in the order of their words."""
    spans = [(span, child) for child in node.children if (span := child.span()) is not None]
    return [child for _, child in sorted(spans, key=lambda entry: entry[0])]
