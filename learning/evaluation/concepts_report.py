"""Figures of `showtell evaluate concepts`: tables 6.1 and 6.3 to 6.5, and figure 6.24."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from learning.evaluation.concepts_memory import MemoryPoint
from learning.evaluation.concepts_metrics import ClusterScores
from learning.evaluation.concepts_thesis import THESIS, ThesisTable
from learning.evaluation.machine import machine


@dataclass(frozen=True, slots=True)
class ConceptRow:
    """One column of tables 6.3 to 6.5.

    Attributes:
        name: Name of the row: the feature space, or the space and a further rule of truth.
        space: Feature space.
        instances: How many instances were scored.
        classes: True classes among them.
        concepts: Concepts that hold for them.
        known: All concepts of the space.
        ours: Our scores.
        pure: Scores of the pure IGMM; None where it was not asked for.
        pure_known: All its concepts.
        svm: V-measure of the SVM with the best C; None where there are too few demos.
        labelled: V-measure with a few labels; None where none were given.
        labelled_concepts: Concepts that then hold for the instances.
        unmeasured: Objects with a class that was never measured of them: scored for nobody.
    """

    name: str
    space: str
    instances: int
    classes: int
    concepts: int
    known: int
    ours: ClusterScores
    pure: ClusterScores | None = None
    pure_known: int | None = None
    svm: float | None = None
    labelled: float | None = None
    labelled_concepts: int | None = None
    unmeasured: int = 0


@dataclass(frozen=True, slots=True)
class CollectionSummary:
    """A line of table 6.1.

    Attributes:
        clips: Demos.
        frames: Frames of observation.
        commands: Sentences.
        words: Unique words.
        objects: Mean number of tracked objects in a demo.
    """

    clips: int
    frames: int
    commands: int
    words: int
    objects: float


@dataclass(frozen=True, slots=True)
class ConceptsReport:
    """What came of the experiment.

    Attributes:
        robot: Whose table it is.
        rows: Its rows.
        summary: Its line of table 6.1.
        memory: Figure 6.24.
        first_ms: Median time that a demo costs from the 10th on [ms], perception apart.
        last_ms: The same of the last ones.
        seed: Seed of everything random.
        settings: What was run, for people.
    """

    robot: str
    rows: tuple[ConceptRow, ...]
    summary: CollectionSummary
    memory: tuple[MemoryPoint, ...]
    first_ms: float
    last_ms: float
    seed: int
    settings: Mapping[str, object]

    @property
    def thesis(self) -> ThesisTable | None:
        """The thesis's figures, on its own data."""
        return THESIS.get(self.robot)

    def figures(self) -> dict[str, float | None]:
        """Our figures, flat."""
        figures: dict[str, float | None] = {}
        for row in self.rows:
            key = row.name.replace(", ", "_")
            scores = {
                "v_measure": row.ours.v_measure,
                "mutual_information": row.ours.mutual_information,
                "normalised_mi": row.ours.normalised,
                "homogeneity": row.ours.homogeneity,
                "completeness": row.ours.completeness,
                "concepts": float(row.concepts),
                "true_concepts": float(row.classes),
                "known_concepts": float(row.known),
                "instances": float(row.instances),
                "unmeasured": float(row.unmeasured),
            }
            if row.labelled is not None:
                scores["labelled_v_measure"] = row.labelled
            figures.update({f"{name}.{key}": value for name, value in scores.items()})
        last = self.memory[-1] if self.memory else None
        if last is not None:
            figures["bytes"] = float(last.total)
            figures.update({f"bytes.{name}": float(size) for name, size in last.parts.items()})
        figures["first_ms"], figures["last_ms"] = self.first_ms, self.last_ms
        for name in ("clips", "frames", "commands", "words", "objects"):
            figures[f"collection.{name}"] = float(getattr(self.summary, name))
        return figures

    def baselines(self) -> dict[str, float | None]:
        """The baselines' figures, flat."""
        found: dict[str, float | None] = {}
        for row in self.rows:
            key = row.name.replace(", ", "_")
            found[f"svm.{key}"] = row.svm
            if row.pure is not None:
                found[f"pure_igmm.{key}"] = row.pure.v_measure
                found[f"pure_igmm_concepts.{key}"] = row.pure_known
            if self.thesis is not None and key in self.thesis.rows:
                theirs = self.thesis.rows[key]
                found[f"thesis.{key}"] = theirs.v_measure
                found[f"thesis_svm.{key}"] = theirs.svm
                found[f"thesis_concepts.{key}"] = float(theirs.concepts)
        return found

    def to_json(self) -> dict[str, Any]:
        """Figures, baselines, machine, seed, settings, and the memory curve."""
        return {
            "figures": self.figures(),
            "baselines": self.baselines(),
            "machine": machine(),
            "seed": self.seed,
            "settings": dict(self.settings),
            "memory": [{"demos": p.demos, "parts": dict(p.parts), "raw": p.raw} for p in self.memory],
        }
