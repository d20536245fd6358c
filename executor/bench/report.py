"""What a benchmark found."""

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class BenchReport:
    """Figures of a benchmark and of what it was compared with, all measured in the same run.

    Attributes:
        figures: Ours, by dotted name; None where one could not be measured.
        baselines: Theirs, by dotted name.
        settings: How each was run, by name.
        notes: What a reader must know, such as why a baseline is missing.
    """

    figures: dict[str, float | None]
    baselines: dict[str, float | None] = field(default_factory=dict)
    settings: dict[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def to_json(self, seed: int) -> dict[str, object]:
        """The object that `--json` prints."""
        from learning.evaluation.machine import machine

        return {
            "figures": self.figures,
            "baselines": self.baselines,
            "settings": self.settings,
            "notes": list(self.notes),
            "machine": machine(),
            "seed": seed,
        }
