"""Figures of sentences that were made for demos and for objects, as `showtell evaluate describe` prints them."""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from learning.evaluation.machine import machine

EVENT = "event"
OBJECT = "object"
SAID = {EVENT: "same", OBJECT: "alone"}
"""What it is called that a sentence is understood as it should be."""


@dataclass(frozen=True, slots=True)
class Described:
    """One thing to be said.

    Attributes:
        what: `EVENT` or `OBJECT`.
        language: Its language.
        source: The demo, and the object.
        text: The sentence; empty where there is none.
        same: Whether it is understood as the same event, or as the object alone, when the scene is looked at afresh.
        true: The same by the truth of the scene and a reader that is not ours, in all ways in which its parts can be
            attached; None where that was not asked.
        possible: The same in at least one of these ways.
        cause: Why not, in a few words that many failures share.
        sort: What sort of event or object it is.
    """

    what: str
    language: str
    source: str
    text: str
    same: bool
    true: bool | None
    possible: bool | None
    cause: str = ""
    sort: str = ""


@dataclass(frozen=True, slots=True)
class DescribeReport:
    """All that was to be said.

    Attributes:
        described: One entry each.
        baselines: People's own sentences in the same measures.
        seed: Seed of everything random.
        settings: How the figures were made.
    """

    described: tuple[Described, ...]
    baselines: Mapping[str, float | None] = field(default_factory=dict)
    seed: int = 0
    settings: Mapping[str, object] = field(default_factory=dict)

    def figures(self) -> dict[str, float | None]:
        """Shares of all that was to be said; what no sentence was found for counts as wrong."""
        found: dict[str, float | None] = {}
        for what, name in SAID.items():
            mine = [each for each in self.described if each.what == what]
            found |= _shares(mine, what, name)
            for language in sorted({each.language for each in mine}):
                found |= _shares([each for each in mine if each.language == language], f"{what}.{language}", name)
            for sort in sorted({each.sort for each in mine if each.sort}):
                found |= _shares([each for each in mine if each.sort == sort], f"{what}.{sort}", name)
        texts = [each.text for each in self.described if each.text]
        found["words"] = _mean(float(len(text.split())) for text in texts)
        found["different"] = len(set(texts)) / len(texts) if texts else None
        return found

    def causes(self) -> list[tuple[str, int]]:
        """Causes of failures with how many there are, the most frequent first."""
        return Counter(each.cause for each in self.described if each.cause).most_common()

    def to_json(self) -> dict[str, Any]:
        """What `--json` prints."""
        return {
            "figures": self.figures(),
            "baselines": dict(self.baselines),
            "machine": machine(),
            "seed": self.seed,
            "settings": dict(self.settings),
            "causes": dict(self.causes()),
            "sentences": [
                {"what": each.what, "of": each.source, "text": each.text, "cause": each.cause}
                for each in self.described
            ],
        }


def _shares(rows: list[Described], before: str, name: str) -> dict[str, float | None]:
    known = [each.true for each in rows if each.true is not None]
    some = [each.possible for each in rows if each.possible is not None]
    return {
        f"{before}.count": float(len(rows)),
        f"{before}.described": _mean(bool(each.text) for each in rows),
        f"{before}.{name}": _mean(each.same for each in rows),
        f"{before}.true": _mean(known) if known else None,
        f"{before}.possible": _mean(some) if some else None,
    }


def _mean(values: Iterable[float | bool]) -> float | None:
    numbers = [float(value) for value in values]
    return sum(numbers) / len(numbers) if numbers else None
