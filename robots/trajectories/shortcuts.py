"""Shorter ways from longer ones, by straight shortcuts that are free."""

import numpy as np

from robots.pose import FloatArray

from .free_space import FreeSpace


def shorten(waypoints: FloatArray, space: FreeSpace, generator: np.random.Generator, attempts: int) -> FloatArray:
    """Cut a path short where that is free.

    Waypoints that are not needed are left out; then between two random places on the path all joints, or in every
    second attempt a random one of them, go straight (Geraerts and Overmars 2007, Creating high-quality paths for motion
    planning, Int. J. Robotics Research 26(8), sections 3.2 and 3.3).

    Args:
        waypoints: (k, n).
        space: The geometry.
        generator: Of the places.
        attempts: How many random shortcuts to try.

    Returns:
        Waypoints of a path that is no longer, with the same ends, (m, n).
    """
    points = _needed(waypoints, space)
    for attempt in range(attempts):
        if len(points) == 2:
            break
        ends = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        low, high = np.sort(generator.uniform(0.0, ends[-1], 2))
        joint = generator.integers(points.shape[1])
        first, last = np.searchsorted(ends, (low, high), side="right") - 1
        if first == last:
            continue
        part = _place(points, ends, np.concatenate([[low], ends[first + 1 : last + 1], [high]]))
        if attempt % 2 == 0:
            new = part[[0, -1]]
        else:
            new = part.copy()
            new[:, joint] = np.linspace(0, 1, len(part)) * (part[-1, joint] - part[0, joint]) + part[0, joint]
        if _length(new) < 0.999 * _length(part) and _free(new, space):
            points = np.concatenate([points[: first + 1], new, points[last + 1 :]])
    return _needed(points, space)


def _place(points: FloatArray, ends: FloatArray, at: FloatArray) -> FloatArray:
    """Places on the path at lengths from its begin, (k, n)."""
    return np.stack([np.interp(at, ends, column) for column in points.T], axis=1)


def _length(points: FloatArray) -> float:
    return float(np.sum(np.linalg.norm(np.diff(points, axis=0), axis=1)))


def _free(points: FloatArray, space: FreeSpace) -> bool:
    return all(space.edge(begin, end) for begin, end in zip(points[:-1], points[1:], strict=True))


def _needed(points: FloatArray, space: FreeSpace) -> FloatArray:
    """From each waypoint go on to the furthest one that is reached straight; neighbours are known to be."""
    kept, at = [0], 0
    while at < len(points) - 1:
        ahead = len(points) - 1
        while ahead > at + 1 and not space.edge(points[at], points[ahead]):
            ahead -= 1
        kept.append(ahead)
        at = ahead
    return points[kept]
