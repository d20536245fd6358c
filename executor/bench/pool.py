"""Benchmarks in several processes."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from typing import TypeVar

from robots.workers import end_with_parent, worker_count

Task = TypeVar("Task")
Result = TypeVar("Result")


def spread(work: Callable[[Task], Result], tasks: Sequence[Task], jobs: int = 0) -> Iterator[Result]:
    """Do tasks in processes of their own and yield what each gives, as it is done.

    Leaving the loop early drops what was not begun.

    Args:
        work: A function of a module, which other processes can import.
        tasks: What to give it.
        jobs: Processes; 0 takes one a core, 1 works in this one.
    """
    count = min(worker_count(jobs), len(tasks))
    if count <= 1:
        yield from map(work, tasks)
        return
    with ProcessPoolExecutor(count, mp_context=get_context("spawn"), initializer=end_with_parent) as pool:
        futures = [pool.submit(work, task) for task in tasks]
        try:
            for future in as_completed(futures):
                yield future.result()
        finally:
            for future in futures:
                future.cancel()
