"""What things are called, as hints for what is one kind: words that only ever name different things name two kinds.

Kinds that look much alike (a fork and a knife) become one concept as long as looks alone decide. But when those who
speak of a fork never say knife, and those who say block also say cube of the same thing, then fork and knife are two
kinds and block and cube are one. So learning of words feeds back into learning of concepts (thesis 6.3.2, where a
person gives such labels; here sentences do).
"""

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from typing import Any

from learning.saved_numbers import saved_count

LEAST_DEMOS = 3
"""Demos in which a name was heard before it is a hint."""
TOGETHER = 0.35
"""Names of one kind are heard of the same thing in at least this share of the demos of the rarer one,"""
LEAST_TOGETHER = 2
"""and in so many demos."""
MAJORITY = 0.5
"""A thing's name is a hint when more than this share of those who name it agree."""


class Namings:
    """How often names were heard, and how often of the same thing, in one feature space.

    Attributes:
        counts: Name to the demos in which a thing was called so.
        together: Name to the other names of the same thing.
        kinds: Name to one name for its kind.
    """

    def __init__(self) -> None:
        """Start without names."""
        self.counts: Counter[str] = Counter()
        self.together: defaultdict[str, Counter[str]] = defaultdict(Counter)
        self.kinds: dict[str, str] = {}

    def hear(self, names: Iterable[str]) -> None:
        """Count the names of one thing in one demo."""
        said = sorted(set(names))
        self.counts.update(said)
        for name in said:
            self.together[name].update(other for other in said if other != name)

    def kind(self, names: Iterable[str]) -> str | None:
        """One name for the kind of thing that most names are of; None where they disagree or are too new."""
        self._sort()
        votes = Counter(self.kinds[name] for name in names if name in self.kinds and not self._vague(name))
        if not votes:
            return None
        best, count = max(votes.items(), key=lambda entry: (entry[1], entry[0]))
        return best if count > MAJORITY * votes.total() else None

    def to_json(self) -> dict[str, Any]:
        """Names with their counts, and those of pairs that were heard of one thing more than once."""
        pairs = {
            name: {other: n for other, n in sorted(row.items()) if name < other and n >= LEAST_TOGETHER}
            for name, row in sorted(self.together.items())
        }
        pairs = {name: row for name, row in pairs.items() if row}
        return {"counts": dict(self.counts), "together": pairs, "kinds": dict(self.kinds)}

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "Namings":
        """Rebuild; raises KeyError, TypeError, ValueError or AttributeError for what `to_json` did not write."""
        namings = cls()
        for name, count in data["counts"].items():
            namings.counts[name] = int(saved_count(count, f"count of '{name}'", least=1))
        for name, row in data["together"].items():
            for other, count in row.items():
                both = int(saved_count(count, f"count of '{name}' with '{other}'"))
                namings.together[name][other] = namings.together[other][name] = both
        namings.kinds = {str(name): str(kind) for name, kind in data["kinds"].items()}
        return namings

    def _sort(self) -> None:
        """Put each newly established name to a kind: that of a name it goes with, or one of its own."""
        for name, count in self.counts.items():
            if count >= LEAST_DEMOS and name not in self.kinds and not self._vague(name):
                kinds = [self.kinds[other] for other in self.kinds if self._alike(name, other)]
                self.kinds[name] = kinds[0] if kinds else name

    def _vague(self, name: str) -> bool:
        """Whether a name goes with others that are never said of one thing: it names no kind."""
        others = [other for other in self.together.get(name, ()) if self._alike(name, other)]
        return any(self.together[one][two] == 0 for one in others for two in others if one < two)

    def _alike(self, one: str, other: str) -> bool:
        both = self.together[one][other] if one in self.together else 0
        return both >= LEAST_TOGETHER and both >= TOGETHER * min(self.counts[one], self.counts[other])
