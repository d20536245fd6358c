"""Figures of grounding and grammar over folds, as `showtell evaluate` prints them (design section 4)."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from learning.evaluation.language_pairs import SPACES
from learning.evaluation.machine import machine

Scores = Mapping[str, float | None]


@dataclass(frozen=True, slots=True)
class Failure:
    """Something that was not learned, or not read rightly.

    Attributes:
        cause: Why, in a few words that many failures share.
        text: The sentence or the n-gram.
        language: Its language.
        detail: What was expected, and what came.
    """

    cause: str
    text: str
    language: str
    detail: str


@dataclass(frozen=True, slots=True)
class FoldScores:
    """Figures of one fold.

    Attributes:
        figures: Ours by name.
        baselines: Others' by name.
        failures: What went wrong.
    """

    figures: Scores
    baselines: Scores
    failures: tuple[Failure, ...] = ()


@dataclass(frozen=True, slots=True)
class LanguageReport:
    """All folds.

    Attributes:
        robot: Whose collection.
        folds: Figures of each.
        curve: Demos (or commands) learned from, and F1 by feature space, in rising order (figure 6.19).
        seed: Seed of everything random.
        settings: How the figures were made.
    """

    robot: str
    folds: tuple[FoldScores, ...]
    curve: tuple[tuple[int, Scores], ...] = ()
    seed: int = 0
    settings: Mapping[str, object] = field(default_factory=dict)

    def figures(self) -> dict[str, float | None]:
        """Means over folds."""
        return _mean(fold.figures for fold in self.folds)

    def baselines(self) -> dict[str, float | None]:
        """Means over folds."""
        return _mean(fold.baselines for fold in self.folds)

    def failures(self) -> list[Failure]:
        """All that went wrong, of all folds, each once."""
        return list(dict.fromkeys(each for fold in self.folds for each in fold.failures))

    def causes(self) -> list[tuple[str, int]]:
        """Causes of failures with how many there are, the most frequent first."""
        counts: dict[str, int] = {}
        for each in self.failures():
            counts[each.cause] = counts.get(each.cause, 0) + 1
        return sorted(counts.items(), key=lambda row: (-row[1], row[0]))

    def to_json(self) -> dict[str, Any]:
        """What `--json` prints."""
        return {
            "figures": self.figures(),
            "baselines": self.baselines(),
            "machine": machine(),
            "seed": self.seed,
            "settings": dict(self.settings),
            "folds": [dict(fold.figures) for fold in self.folds],
            "curve": [{"learned": learned, **scores} for learned, scores in self.curve],
            "causes": dict(self.causes()),
            "failures": [
                {"cause": f.cause, "text": f.text, "language": f.language, "detail": f.detail} for f in self.failures()
            ],
        }


def spaces_in(figures: Scores, before: str) -> list[str]:
    """Feature spaces that figures tell of, in the usual order."""
    return [space for space in SPACES if figures.get(f"{before}.{space}") is not None]


def _mean(rows: Iterable[Scores]) -> dict[str, float | None]:
    gathered: dict[str, list[float]] = {}
    for row in rows:
        for name, value in row.items():
            values = gathered.setdefault(name, [])
            if value is not None:
                values.append(value)
    return {name: sum(values) / len(values) if values else None for name, values in gathered.items()}
