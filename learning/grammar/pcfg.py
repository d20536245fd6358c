"""The grammar Π: a probabilistic context-free grammar learned from RCL trees (thesis 5.4)."""

import math
from collections import defaultdict
from collections.abc import Mapping
from typing import Any

from learning.saved_numbers import saved_count

Rule = tuple[str, tuple[str, ...]]

UNSEEN = 0.05
"""What a rule that was never seen counts, so that a new order of words can still be tried while learning."""

POSSIBLE = 20
"""Number of rules of one element that are taken to be possible, seen or not."""

FLOOR = 0.03
"""No rule is searched as if it were rarer than this: what was learned first must not shut out what comes later."""

KEPT = 0.05
"""Smallest count that is saved."""


class Pcfg:
    """Counts of productions and their probabilities.

    Productions between elements and productions to n-grams are counted apart; their probabilities together sum to one
    for every left-hand side (equation 5.3).
    """

    def __init__(self) -> None:
        """Start with an empty rule set (thesis 5.4.1)."""
        self.rules: defaultdict[str, defaultdict[tuple[str, ...], float]] = defaultdict(lambda: defaultdict(float))
        self.terminals: defaultdict[str, defaultdict[str, float]] = defaultdict(lambda: defaultdict(float))
        self._totals: defaultdict[str, float] = defaultdict(float)

    def clear(self) -> None:
        """Forget everything."""
        self.rules.clear()
        self.terminals.clear()
        self._totals.clear()

    def add_rule(self, left: str, right: tuple[str, ...], amount: float = 1.0) -> None:
        """Count one sighting of left → right (elements)."""
        self.rules[left][right] += amount
        self._totals[left] += amount

    def add_terminal(self, left: str, ngram: str, amount: float = 1.0) -> None:
        """Count one sighting of left → n-gram."""
        self.terminals[left][ngram] += amount
        self._totals[left] += amount

    def probability(self, left: str, right: tuple[str, ...]) -> float:
        """P(C1 ... Cm | B), equation 5.1; 0 for a rule never seen."""
        total = self._totals.get(left, 0.0)
        return (
            self.rules[left][right] / total if total > 0 and left in self.rules and right in self.rules[left] else 0.0
        )

    def terminal_probability(self, left: str, ngram: str) -> float:
        """P(Z | B), equation 5.2; 0 for a production never seen."""
        total = self._totals.get(left, 0.0)
        return self.terminals[left].get(ngram, 0.0) / total if total > 0 and left in self.terminals else 0.0

    def log_weight(self, left: str, right: tuple[str, ...]) -> float:
        """Log probability of a rule for searching: `UNSEEN` counts more for every rule, and never below `FLOOR`."""
        seen = self.rules[left].get(right, 0.0) if left in self.rules else 0.0
        share = (seen + UNSEEN) / (self._totals.get(left, 0.0) + POSSIBLE * UNSEEN)
        return math.log(max(share, FLOOR))

    def total(self, left: str) -> float:
        """How often an element was seen at all."""
        return self._totals.get(left, 0.0)

    def seen_start(self, left: str, right: tuple[str, ...]) -> bool:
        """Whether any rule of `left` seen so far (for more than half a reading) begins with the children `right`."""
        return any(rule[: len(right)] == right and count > 0.5 for rule, count in self.rules.get(left, {}).items())

    def to_json(self) -> dict[str, Any]:
        """Rules as `left` to `children joined by a space` to count, and terminals as `left` to n-gram to count."""
        return {
            "rules": {
                left: {" ".join(right): round(n, 3) for right, n in sorted(row.items()) if n >= KEPT}
                for left, row in sorted(self.rules.items())
                if any(n >= KEPT for n in row.values())
            },
            "terminals": {
                left: {ngram: round(n, 3) for ngram, n in sorted(row.items()) if n >= KEPT}
                for left, row in sorted(self.terminals.items())
                if any(n >= KEPT for n in row.values())
            },
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "Pcfg":
        """Rebuild Π; raises KeyError, TypeError, ValueError or AttributeError for what `to_json` did not write."""
        grammar = cls()
        for left, row in data["rules"].items():
            for right, count in row.items():
                grammar.add_rule(left, tuple(right.split(" ")), saved_count(count, f"count of '{left} -> {right}'"))
        for left, row in data["terminals"].items():
            for ngram, count in row.items():
                grammar.add_terminal(left, ngram, saved_count(count, f"count of '{left} -> {ngram}'"))
        return grammar
