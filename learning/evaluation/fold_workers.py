"""Folds in processes of their own: each learns by itself, and may use a core."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import TypeVar

from learning.evaluation.folds import Fold
from robots.workers import end_with_parent

Result = TypeVar("Result")


def in_folds(work: Callable[[Fold], Result], folds: Sequence[Fold], jobs: int = 1) -> Iterator[tuple[Fold, Result]]:
    """Do something in every fold, and give the folds with what came of them, in their order.

    One process or many add up to the same last digit.

    Args:
        work: What is done; with more than one job it must be picklable.
        folds: The folds.
        jobs: Processes; each works on a fold of its own.
    """
    if jobs <= 1:
        for fold in folds:
            yield fold, work(fold)
        return
    context = get_context("spawn")
    with ProcessPoolExecutor(min(jobs, len(folds)), mp_context=context, initializer=end_with_parent) as pool:
        yield from zip(folds, pool.map(work, folds), strict=True)
