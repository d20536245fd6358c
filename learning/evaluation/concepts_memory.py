"""How the size of what was learned grows with the demos, part by part (thesis 6.6, figure 6.24)."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True, slots=True)
class MemoryPoint:
    """What was kept after some demos.

    Attributes:
        demos: How many were seen.
        parts: Name of each part to its size in the knowledge file [bytes].
        raw: Size of the pictures that were looked at so far, uncompressed [bytes]; 0 on the board.
    """

    demos: int
    parts: Mapping[str, int]
    raw: int

    @property
    def total(self) -> int:
        """Size of all parts [bytes]."""
        return sum(self.parts.values())


def sizes(spaces: Mapping[str, Any], language: Mapping[str, Any] | None) -> dict[str, int]:
    """Size of each part of saved knowledge [bytes].

    Args:
        spaces: `ConceptSpaces.to_json()`.
        language: `LanguageLearner.to_json()`, None where no sentences were learned.
    """
    parts = {name: _size(part) for name, part in spaces["spaces"].items()}
    parts["action"] = _size(spaces["actions"])
    for name, part in (language or {}).items():
        parts[f"language.{name}"] = _size(part)
    return parts


def plot_memory(points: Sequence[MemoryPoint], path: Path) -> None:
    """Draw figure 6.24: the size of each part of the knowledge, and of the pictures, over the demos.

    Args:
        points: At least one point, in the order of the demos.
        path: Picture to write; its suffix says the format.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 5.0), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    demos = [point.demos for point in points]
    for name in points[-1].parts:
        axes.plot(demos, [point.parts.get(name, 0) / 1000 for point in points], label=name)
    axes.plot(demos, [point.total / 1000 for point in points], "k", linewidth=2, label="all that is kept")
    if points[-1].raw:
        axes.plot(demos, [point.raw / 1000 for point in points], "k--", label="pictures seen")
        axes.set_yscale("log")
    axes.set_xlabel("demos seen")
    axes.set_ylabel("size [kB]")
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small")
    figure.savefig(path)


def _size(part: Any) -> int:
    return len(json.dumps(part, ensure_ascii=False).encode())
