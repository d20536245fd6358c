"""The most probable tree of a sentence under a PCFG: CKY (Younger 1967) over a binarised grammar, compiled.

Rules of any length are taken. Longer ones are made binary by symbols of their own, and chains of unary rules are joined
into the best chain beforehand, so that a cell needs one pass over them. The time grows with the third power of the
number of words, times the number of binary rules.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from learning.errors import LearningError
from robots.ik_kernel import compiled
from robots.pose import FloatArray

IntArray = NDArray[np.int64]

NONE = -1
RULE, SPLIT, BELOW = 0, 1, 2
"""What back pointers tell: the binary rule, where it splits the span, and where a chain of unary rules ends."""


@dataclass(frozen=True, slots=True)
class Production:
    """A rule.

    Attributes:
        left: Symbol.
        right: Symbols, or words.
        probability: P(right | left), above 0.
        lexical: Whether `right` is words.
    """

    left: str
    right: tuple[str, ...]
    probability: float
    lexical: bool = False


@dataclass(frozen=True, slots=True)
class Bracket:
    """A part of a tree.

    Attributes:
        label: Symbol.
        first: Position of its first word.
        after: Position after its last.
        children: Parts from left to right; none for what consists of words.
    """

    label: str
    first: int
    after: int
    children: tuple["Bracket", ...] = ()


class ViterbiGrammar:
    """A PCFG that sentences are parsed with."""

    def __init__(self, productions: Iterable[Production], start: str) -> None:
        """Compile a grammar.

        Args:
            productions: Its rules.
            start: Symbol of a sentence.

        Raises:
            LearningError: A probability is not above 0, or a rule is empty.
        """
        self.start = start
        self.productions = tuple(productions)
        self._numbers: dict[str, int] = {}
        self._symbols: list[str] = []
        self._made: set[int] = set()
        self._words: dict[str, list[tuple[int, float]]] = {}
        binary: list[tuple[int, int, int, float]] = []
        unary: dict[tuple[int, int], float] = {}
        self._number(start)
        for rule in self.productions:
            if not rule.right or not rule.probability > 0.0:
                raise LearningError(f"the rule {rule} is empty or has no probability above 0")
            self._take(rule, binary, unary)
        symbols = len(self._symbols)
        binary.sort(key=lambda rule: rule[1])
        self._binary = np.array([rule[:3] for rule in binary], dtype=np.int64).reshape(-1, 3)
        self._binary_weight = np.array([rule[3] for rule in binary], dtype=np.float64)
        # Rules by their left part: those of symbol s are from begins[s] on, up to begins[s + 1].
        self._begins = np.searchsorted(self._binary[:, 1], np.arange(symbols + 1)).astype(np.int64)
        pairs, self._through = _chains(unary)
        ordered = sorted(pairs, key=lambda pair: pair[1])
        self._unary = np.array(ordered, dtype=np.int64).reshape(-1, 2)
        self._unary_weight = np.array([pairs[pair] for pair in ordered], dtype=np.float64)
        self._unary_begins = np.searchsorted(self._unary[:, 1], np.arange(symbols + 1)).astype(np.int64)
        self._chart = _Chart(0, symbols)

    def _number(self, symbol: str) -> int:
        if symbol not in self._numbers:
            self._numbers[symbol] = len(self._symbols)
            self._symbols.append(symbol)
        return self._numbers[symbol]

    def _make(self, name: str) -> int:
        """Number of a symbol that is only there to make rules binary."""
        number = self._number(name)
        self._made.add(number)
        return number

    def _take(
        self, rule: Production, binary: list[tuple[int, int, int, float]], unary: dict[tuple[int, int], float]
    ) -> None:
        left, weight = self._number(rule.left), math.log(rule.probability)
        if rule.lexical and len(rule.right) == 1:
            self._words.setdefault(rule.right[0], []).append((left, weight))
            return
        parts = [self._word(word) if rule.lexical else self._number(word) for word in rule.right]
        if len(parts) == 1:
            unary[left, parts[0]] = max(unary.get((left, parts[0]), -math.inf), weight)
            return
        while len(parts) > 2:
            name = f"<{rule.left}: {' '.join(rule.right[: len(parts) - 1])}>"
            known = name in self._numbers
            made = self._make(name)
            binary.append((left, made, parts[-1], weight))
            if known:
                return  # another rule begins in the same way
            left, weight, parts = made, 0.0, parts[:-1]
        binary.append((left, parts[0], parts[1], weight))

    def _word(self, word: str) -> int:
        """Number of a symbol that is one word."""
        name = f"<{word}>"
        known = name in self._numbers
        made = self._make(name)
        if not known:
            self._words.setdefault(word, []).append((made, 0.0))
        return made

    def covers(self, words: Sequence[str]) -> bool:
        """Whether every word is in some rule."""
        return all(word in self._words for word in words)

    def parse(self, words: Sequence[str]) -> tuple[float, Bracket] | None:
        """The most probable tree and its log probability; None where there is none."""
        count = len(words)
        if not count or not self.covers(words):
            return None
        if len(self._chart.scores) < count:
            self._chart = _Chart(count, len(self._symbols))
        chart = self._chart
        entries = [(position, *entry) for position, word in enumerate(words) for entry in self._words[word]]
        lexical = np.array([entry[:2] for entry in entries], dtype=np.int64)
        weights = np.array([entry[2] for entry in entries], dtype=np.float64)
        best = float(
            _fill(
                count,
                lexical,
                weights,
                chart.scores,
                chart.pointers,
                chart.present,
                chart.counts,
                self._binary,
                self._binary_weight,
                self._begins,
                self._unary,
                self._unary_weight,
                self._unary_begins,
            )
        )
        if best == -math.inf:
            return None
        (tree,) = self._tree(0, count, 0)
        return best, tree

    def _tree(self, first: int, after: int, symbol: int) -> tuple[Bracket, ...]:
        """Brackets of a symbol over a span; those of a made symbol are its parts."""
        pointers = self._chart.pointers[first, after]
        chain = [symbol]
        lower = int(pointers[symbol, BELOW])
        if lower != NONE:
            chain = self._through[symbol, lower]
        rule, middle = int(pointers[chain[-1], RULE]), int(pointers[chain[-1], SPLIT])
        parts: tuple[Bracket, ...] = ()
        if rule != NONE:
            _, left, right = (int(number) for number in self._binary[rule])
            parts = (*self._tree(first, middle, left), *self._tree(middle, after, right))
        for each in reversed(chain):
            if each not in self._made:
                parts = (Bracket(self._symbols[each], first, after, parts),)
        return parts


class _Chart:
    """Room for a chart of up to n words and s symbols, used again from sentence to sentence.

    Attributes:
        scores: Log probability of each symbol over each span, (n, n + 1, s).
        pointers: Binary rule, split and lower end of a unary chain by which it came about, (n, n + 1, s, 3).
        present: Symbols that are possible over each span, (n, n + 1, s).
        counts: How many these are, (n, n + 1).
    """

    def __init__(self, words: int, symbols: int) -> None:
        self.scores = np.empty((words, words + 1, symbols))
        self.pointers = np.empty((words, words + 1, symbols, 3), dtype=np.int64)
        self.present = np.empty((words, words + 1, symbols), dtype=np.int64)
        self.counts = np.empty((words, words + 1), dtype=np.int64)


def _chains(
    unary: dict[tuple[int, int], float],
) -> tuple[dict[tuple[int, int], float], dict[tuple[int, int], list[int]]]:
    """The best chain of unary rules from each symbol to each that it reaches (Floyd 1962): weights and symbols."""
    best = dict(unary)
    through = {pair: list(pair) for pair in unary}
    for middle in sorted({pair[0] for pair in unary} & {pair[1] for pair in unary}):
        for (upper, one), first in list(best.items()):
            for (other, lower), second in list(best.items()):
                if one == other == middle and upper != lower:
                    pair = upper, lower
                    if first + second > best.get(pair, -math.inf):
                        best[pair] = first + second
                        through[pair] = [*through[upper, middle], *through[middle, lower][1:]]
    return best, through


@compiled
def _fill(
    count: int,
    lexical: IntArray,
    lexical_weight: FloatArray,
    scores: FloatArray,
    pointers: IntArray,
    present: IntArray,
    counts: IntArray,
    binary: IntArray,
    binary_weight: FloatArray,
    begins: IntArray,
    unary: IntArray,
    unary_weight: FloatArray,
    unary_begins: IntArray,
) -> float:
    """Fill a chart, shorter spans first; returns the log probability of the first symbol over the whole sentence."""
    for width in range(1, count + 1):
        for first in range(count - width + 1):
            after = first + width
            cell, back, found = scores[first, after], pointers[first, after], present[first, after]
            cell[:] = -np.inf
            number = 0
            if width == 1:
                for entry in range(len(lexical)):
                    if lexical[entry, 0] == first:
                        upper = lexical[entry, 1]
                        if cell[upper] == -np.inf:
                            found[number] = upper
                            number += 1
                        if lexical_weight[entry] > cell[upper]:
                            cell[upper] = lexical_weight[entry]
                            back[upper, RULE] = back[upper, BELOW] = NONE
            for middle in range(first + 1, after):
                left, right, symbols = scores[first, middle], scores[middle, after], present[first, middle]
                if counts[middle, after] == 0:
                    continue
                for at in range(counts[first, middle]):
                    symbol = symbols[at]
                    for rule in range(begins[symbol], begins[symbol + 1]):
                        value = left[symbol] + right[binary[rule, 2]] + binary_weight[rule]
                        upper = binary[rule, 0]
                        if value > cell[upper]:
                            if cell[upper] == -np.inf:
                                found[number] = upper
                                number += 1
                            cell[upper] = value
                            back[upper, RULE] = rule
                            back[upper, SPLIT] = middle
                            back[upper, BELOW] = NONE
            plain = cell.copy()
            for at in range(number):
                symbol = found[at]
                for rule in range(unary_begins[symbol], unary_begins[symbol + 1]):
                    value = plain[symbol] + unary_weight[rule]
                    upper = unary[rule, 0]
                    if value > cell[upper]:
                        if cell[upper] == -np.inf:
                            found[number] = upper
                            number += 1
                        cell[upper] = value
                        back[upper, BELOW] = symbol
            counts[first, after] = number
    return float(scores[0, count, 0])
