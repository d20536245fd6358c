"""Out of noisy frames, sequences of constant values."""

from collections.abc import Iterator
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from robots.pose import FloatArray

Scalar = TypeVar("Scalar", bound=np.generic)


def smoothed(track: FloatArray) -> FloatArray:
    """Running median over three frames, (F, ...): it takes out noise and leaves jumps where they are."""
    if len(track) < 3:
        return track
    padded = np.concatenate([track[:1], track, track[-1:]])
    return np.asarray(np.median(np.stack([padded[:-2], padded[1:-1], padded[2:]]), axis=0))


def constant_runs(values: NDArray[Scalar]) -> Iterator[tuple[int, int]]:
    """First and one past the last index of each run of equal values (or rows) of (F, ...)."""
    if len(values) == 0:
        return
    rows = values.reshape(len(values), -1)
    changes = np.flatnonzero(np.any(rows[1:] != rows[:-1], axis=1)) + 1
    bounds = [0, *changes.tolist(), len(values)]
    yield from zip(bounds[:-1], bounds[1:], strict=True)


def lasting(values: NDArray[Scalar], shortest: int) -> NDArray[Scalar]:
    """Give values that last less than `shortest` frames to the value before them, (F,).

    A short run at the very beginning takes the first value that lasts; if none lasts, nothing is changed.
    """
    runs = list(constant_runs(values))
    long_runs = [run for run in runs if run[1] - run[0] >= shortest]
    if not long_runs:
        return values.copy()
    result = values.copy()
    current = values[long_runs[0][0]]
    for start, stop in runs:
        if stop - start >= shortest:
            current = values[start]
        result[start:stop] = current
    return result


def without_short_rows(rows: NDArray[Scalar], shortest: int) -> NDArray[Scalar]:
    """Drop combinations that last less than `shortest` frames, (F, m): their changes are one change.

    The first and the last are kept: how a demo begins and ends is no flicker.
    """
    keep = np.ones(len(rows), dtype=bool)
    for start, stop in constant_runs(rows):
        if stop - start < shortest and start > 0 and stop < len(rows):
            keep[start:stop] = False
    return rows[keep]
