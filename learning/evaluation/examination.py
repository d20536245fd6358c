"""One fold of an examination: learning with a clock, asking on the way for a learning curve, asking at the end."""

from collections.abc import Sequence
from dataclasses import dataclass
from time import perf_counter, process_time

import numpy as np

from learning.concept_id import Concept
from learning.evaluation.answers import Answer, Learn, Steps, Student, ask
from learning.evaluation.command_score import fault
from learning.evaluation.folds import Fold
from learning.train_robots.release import Command, Release

MARKS = (16, 32, 48, 64, 96, 128, 192, 256, 384, 512, 768, 1024, 1536, 2048)
"""Numbers of commands heard after which some are asked for the learning curve."""
ASKED = 125
"""About how many commands of a fold are asked each time."""
QUARTERS = 4


@dataclass(frozen=True)
class Examined:
    """What came of one fold.

    Attributes:
        answers: Answers to all asked commands.
        names: Public values of concepts.
        curve: Commands heard, and the share of a sample of the asked that was done rightly then.
        learn_seconds: Time of learning [s].
        learn_cpu_seconds: Processor time of it [s].
        quarters: Processor time a command in each quarter of the commands heard [s]; empty when it was not watched.
    """

    answers: list[Answer]
    names: dict[Concept, str]
    curve: tuple[tuple[int, float], ...] = ()
    learn_seconds: float = 0.0
    learn_cpu_seconds: float = 0.0
    quarters: tuple[float, ...] = ()


def examine_fold(learn: Learn, release: Release, with_curve: bool, fold: Fold) -> Examined:
    """Learn from a fold and ask what it holds back.

    Args:
        learn: Makes a student from scenes and commands.
        release: All scenes.
        with_curve: Whether to ask a sample on the way; only a learner that learns in steps can be asked so.
        fold: What to learn from and what to ask.
    """
    begun, cpu_begun = perf_counter(), process_time()
    curve: list[tuple[int, float]] = []
    spent: list[tuple[int, float]] = []
    aside, cpu_aside = 0.0, 0.0
    student: Student | None = None
    steps: Steps | None = getattr(learn, "steps", None)
    if steps is not None:
        sample = fold.asked[:: max(1, len(fold.asked) // ASKED)]
        marks = [mark for mark in MARKS if mark < len(fold.learned)] if with_curve and sample else []
        for student, heard, seconds in steps(fold.scenes, fold.learned):
            spent.append((heard, seconds))
            if marks and heard >= marks[0]:
                paused, cpu_paused = perf_counter(), process_time()
                curve.append((marks[0], _share_right(student, release, sample)))
                marks = [mark for mark in marks if mark > heard]
                aside, cpu_aside = aside + perf_counter() - paused, cpu_aside + process_time() - cpu_paused
    if student is None:
        student = learn(fold.scenes, fold.learned)
    seconds, cpu_seconds = perf_counter() - begun - aside, process_time() - cpu_begun - cpu_aside
    answers, names = ask(student, release.scenes, fold.asked)
    if with_curve and spent and answers:
        right = [not fault(each, release.scenes[each.command.scene]) for each in answers]
        curve.append((len(fold.learned), float(np.mean(right))))
    return Examined(answers, names, tuple(curve), seconds, cpu_seconds, _quarters(spent))


def _share_right(student: Student, release: Release, sample: Sequence[Command]) -> float:
    answers, _ = ask(student, release.scenes, sample)
    return float(np.mean([not fault(each, release.scenes[each.command.scene]) for each in answers]))


def _quarters(spent: Sequence[tuple[int, float]]) -> tuple[float, ...]:
    """Time a command in each quarter of the commands heard."""
    total = spent[-1][0] if spent else 0
    if total < QUARTERS:
        return ()
    sums = np.zeros(QUARTERS)
    counts = np.zeros(QUARTERS)
    before = 0
    for heard, seconds in spent:
        quarter = min(QUARTERS - 1, before * QUARTERS // total)
        sums[quarter] += seconds
        counts[quarter] += heard - before
        before = heard
    return tuple(float(s / c) for s, c in zip(sums, counts, strict=True) if c)
