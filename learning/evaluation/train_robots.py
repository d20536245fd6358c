"""The Train-Robots examination: how many commands are understood rightly (design sections 4 and 6)."""

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np

from learning.evaluation.annotation import annotations_of
from learning.evaluation.answers import Learn, Student, ask
from learning.evaluation.baselines import SETTINGS, baseline_credits
from learning.evaluation.command_score import CommandScore, cause_of, score
from learning.evaluation.examination import Examined, examine_fold
from learning.evaluation.fold_workers import in_folds
from learning.evaluation.folds import Split, make_folds
from learning.evaluation.kinds import kinds_of, outside_vocabulary
from learning.evaluation.machine import machine
from learning.evaluation.public_tree import PublicNode
from learning.train_robots.release import Release

MILESTONES = (80, 90)
"""Execution accuracies [%] for which it is told after how many commands they are reached."""


@dataclass(frozen=True)
class TrainRobotsReport:
    """Scores of all asked commands.

    Attributes:
        scores: One a command, in rising order of command id.
        kinds: Kinds of each annotated command, by command id.
        outside: Labels of each annotated command that the vocabulary of meaning lacks, by command id.
        starts_held: Command ids whose scene starts with a block in the gripper.
        baselines: Name to the expected correctness of each command, in an order of its own.
        seed: Seed of everything random.
        settings: How the figures were made: folds, split, baselines' settings.
        curve: Commands heard, and the execution accuracy of a sample then: the mean of all folds (figure 6.19).
        costs: Times: `learn_seconds`, `median_ms` and so on.
    """

    scores: tuple[CommandScore, ...]
    kinds: Mapping[int, tuple[str, ...]]
    outside: Mapping[int, tuple[str, ...]]
    starts_held: frozenset[int]
    baselines: Mapping[str, Sequence[float]]
    seed: int
    settings: Mapping[str, object] = field(default_factory=dict)
    curve: tuple[tuple[int, float], ...] = ()
    costs: Mapping[str, float] = field(default_factory=dict)

    def kind_table(self) -> list[tuple[str, int, int]]:
        """Rows of kind, commands, and commands that were done rightly; the most frequent kind first."""
        right = {s.command.id for s in self.scores if s.right}
        members: dict[str, list[int]] = {}
        for command, kinds in self.kinds.items():
            for kind in kinds:
                members.setdefault(kind, []).append(command)
        rows = [(kind, len(ids), sum(number in right for number in ids)) for kind, ids in members.items()]
        return sorted(rows, key=lambda row: (-row[1], row[0]))

    def failures(self) -> list[dict[str, object]]:
        """Command id, sentence and reason of every wrong answer."""
        return [
            {"command": s.command.id, "scene": s.command.scene, "sentence": s.command.sentence, "reason": s.reason}
            for s in self.scores
            if not s.right
        ]

    def reasons(self) -> list[tuple[str, int]]:
        """Causes of wrong answers with their counts, the most frequent first."""
        causes = Counter(cause_of(s.reason) for s in self.scores if not s.right)
        return sorted(causes.items(), key=lambda entry: (-entry[1], entry[0]))

    def figures(self) -> dict[str, float | None]:
        """All figures by their dotted names; None where there is nothing to measure."""
        within = [s for s in self.scores if s.command.id in self.outside and not self.outside[s.command.id]]
        annotated = bool(self.outside)
        figures: dict[str, float | None] = {
            "commands": len(self.scores),
            "execution_accuracy": _mean(s.right for s in self.scores),
            "rcl_exact": _mean(s.rcl_exact for s in self.scores if s.rcl_exact is not None),
            "subtree_score": _mean(s.subtree for s in self.scores if s.subtree is not None),
            "understood": _mean(s.understood for s in self.scores),
            "execution_accuracy_without_held": _mean(
                s.right for s in self.scores if s.command.id not in self.starts_held
            ),
            "vocabulary.commands": len(within) if annotated else None,
            "vocabulary.ceiling": len(within) / len(self.outside) if annotated else None,
            "vocabulary.execution_accuracy": _mean(s.right for s in within),
        }
        if self.curve:
            for percent in MILESTONES:
                reached = [heard for heard, share in self.curve if share >= percent / 100]
                figures[f"commands_to_{percent}"] = reached[0] if reached else None
        for kind, commands, right in self.kind_table():
            name = kind.replace(",", "").replace(" ", "_")
            figures[f"kind.{name}.commands"] = commands
            figures[f"kind.{name}.execution_accuracy"] = right / commands
        return figures

    def to_json(self) -> dict[str, Any]:
        """Return the object that `showtell evaluate train-robots --json` prints."""
        return {
            "figures": {**self.figures(), **self.costs},
            "baselines": {f"{name}.execution_accuracy": _mean(credit) for name, credit in self.baselines.items()},
            "machine": machine(),
            "seed": self.seed,
            "settings": dict(self.settings),
            "curve": [list(point) for point in self.curve],
            "reasons": dict(self.reasons()),
            "failures": self.failures(),
        }


def cross_validate(
    release: Release,
    learn: Learn,
    *,
    folds: int = 4,
    split: Split = "groups",
    seed: int = 0,
    jobs: int = 1,
    curve: bool = False,
    on_fold: Callable[[int, int], None] = lambda done, total: None,
) -> TrainRobotsReport:
    """Learn on all folds but one and ask that one, for every fold.

    Args:
        release: Commands and scenes.
        learn: Makes a student from scenes and commands; with more than one job it must be picklable.
        folds: Number of folds.
        split: `groups` or `commands`, see `make_folds`.
        seed: Seed of the split by commands.
        jobs: Processes to use; each works on a fold of its own.
        curve: Whether to ask on the way, for a learning curve.
        on_fold: Called with the number of folds done and their total.

    Raises:
        LearningError: So many folds are not possible.
        ReleaseError: `annotation.txt` is malformed.
    """
    annotations = annotations_of(release)
    parts = make_folds(release, folds, split, np.random.default_rng(seed))
    scores: list[CommandScore] = []
    baselines: dict[str, list[float]] = {}
    examined: list[Examined] = []
    work = partial(examine_fold, learn, release, curve)
    for done, (fold, result) in enumerate(in_folds(work, parts, jobs), start=1):
        examined.append(result)
        scores += _scored(release, result, annotations)
        for name, credit in baseline_credits(release.scenes, fold.learned, fold.asked).items():
            baselines.setdefault(name, []).extend(credit)
        on_fold(done, len(parts))
    settings = {"folds": folds, "split": split, "baselines": SETTINGS}
    report = _report(release, scores, annotations, baselines, seed, settings)
    return replace(report, curve=_mean_curve(examined), costs=_costs(examined))


def examine(
    release: Release,
    student: Student,
    *,
    seed: int = 0,
    on_answer: Callable[[], None] = lambda: None,
) -> TrainRobotsReport:
    """Ask a student that has learned already all commands of a release.

    Args:
        release: Commands and scenes, of the release that was learned from or of another.
        student: Who is asked.
        seed: Seed that the student was made with, for the report.
        on_answer: Called after every answer.

    Raises:
        ReleaseError: `annotation.txt` is malformed.
    """
    annotations = annotations_of(release)
    answers, names = ask(student, release.scenes, release.commands, on_answer)
    credit = baseline_credits(release.scenes, (), release.commands)
    settings = {"folds": None, "split": None, "baselines": {"random_move": SETTINGS["random_move"]}}
    examined = Examined(answers, names)
    report = _report(release, _scored(release, examined, annotations), annotations, credit, seed, settings)
    return replace(report, costs=_costs([examined]))


def _scored(release: Release, examined: Examined, annotations: Mapping[int, PublicNode] | None) -> list[CommandScore]:
    trees = annotations or {}
    return [
        score(one, release.scenes[one.command.scene], trees.get(one.command.id), examined.names)
        for one in examined.answers
    ]


def _mean_curve(examined: Sequence[Examined]) -> tuple[tuple[int, float], ...]:
    """Mean of the folds' curves where all have a point; their ends, which differ a little, are one point."""
    if not all(each.curve for each in examined):
        return ()
    common = set.intersection(*(set(dict(each.curve[:-1])) for each in examined))
    points = [(mark, float(np.mean([dict(each.curve)[mark] for each in examined]))) for mark in sorted(common)]
    ends = [each.curve[-1] for each in examined]
    return (*points, (min(heard for heard, _ in ends), float(np.mean([share for _, share in ends]))))


def _costs(examined: Sequence[Examined]) -> dict[str, float]:
    """Times of learning, the mean of the folds, and of answering, over all commands."""
    costs: dict[str, float] = {}
    if any(each.learn_seconds for each in examined):
        costs["learn_seconds"] = float(np.mean([each.learn_seconds for each in examined]))
        costs["learn_cpu_seconds"] = float(np.mean([each.learn_cpu_seconds for each in examined]))
    quarters = [each.quarters for each in examined if each.quarters]
    for number, values in enumerate(zip(*quarters, strict=False), start=1):
        costs[f"learn_cpu_ms_per_command.quarter_{number}"] = 1e3 * float(np.mean(values))
    for name, times in (
        ("", [answer.seconds for each in examined for answer in each.answers]),
        ("cpu_", [answer.cpu_seconds for each in examined for answer in each.answers]),
    ):
        if times:
            costs[f"{name}median_ms"] = 1e3 * float(np.median(times))
            costs[f"{name}p99_ms"] = 1e3 * float(np.percentile(times, 99))
    return costs


def _report(
    release: Release,
    scores: Iterable[CommandScore],
    annotations: Mapping[int, PublicNode] | None,
    baselines: Mapping[str, Sequence[float]],
    seed: int,
    settings: Mapping[str, object],
) -> TrainRobotsReport:
    ordered = tuple(sorted(scores, key=lambda one: one.command.id))
    asked = {one.command.id for one in ordered}
    trees = {number: tree for number, tree in (annotations or {}).items() if number in asked}
    return TrainRobotsReport(
        scores=ordered,
        kinds={number: kinds_of(tree) for number, tree in trees.items()},
        outside={number: outside_vocabulary(tree) for number, tree in trees.items()},
        starts_held=frozenset(
            one.command.id for one in ordered if release.scenes[one.command.scene].before.held is not None
        ),
        baselines=baselines,
        seed=seed,
        settings=settings,
    )


def _mean(values: Iterable[float | bool | None]) -> float | None:
    numbers = [float(value) for value in values if value is not None]
    return sum(numbers) / len(numbers) if numbers else None
