"""Grounding and grammar of the board's commands, learned from the key frames of a release, over folds by group."""

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from executor.commands.output import Output
    from learning.evaluation.language_report import LanguageReport


def release_language(out: "Output", directory: Path, *, folds: int, seed: int, jobs: int = 0) -> "LanguageReport":
    """F1 of grounding against the annotation's token alignments, and the sub-tree score against its trees.

    Args:
        out: Shows progress.
        directory: The release.
        folds: Number of folds, by group.
        seed: Seed of learning.
        jobs: Processes; 0 takes one a core.

    Raises:
        ReleaseError: The release is malformed.
        LearningError: It has no annotation, or so many folds are not possible.
    """
    from executor.release_student import LearnRelease
    from learning.evaluation.board_exam import board_exam
    from learning.train_robots import Release
    from robots.workers import worker_count

    release = Release.load(directory)
    with out.progress(f"learning and asking {folds} folds", folds) as advance:
        return board_exam(
            release,
            LearnRelease(seed),
            folds=folds,
            seed=seed,
            jobs=worker_count(jobs),
            on_fold=advance,
        )
