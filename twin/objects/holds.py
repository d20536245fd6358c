"""Where things of common form can be held by two fingers. Heights are above what the thing stands on."""

from collections.abc import Iterable, Sequence

import numpy as np

from .model import Grasp
from .parts import SEGMENTS

DOWN = (0.0, 0.0, -1.0)


def pinch(centre: Sequence[float], closing: Sequence[float], width: float, approach: Sequence[float] = DOWN) -> Grasp:
    """Hold at one place; `closing` and `approach` need not be unit vectors."""
    close, come = np.array(closing, dtype=float), np.array(approach, dtype=float)
    return Grasp(
        np.array(centre, dtype=float), close / np.linalg.norm(close), come / np.linalg.norm(come), float(width)
    )


def from_above(diameter: float, height: float) -> list[Grasp]:
    """Hold something round, standing on the z axis, from above: every 22.5 degrees."""
    return [pinch((0, 0, height), _at(turn), diameter) for turn in range(SEGMENTS // 2)]


def from_the_side(diameter: float, height: float) -> list[Grasp]:
    """Hold something round, standing on the z axis, from the side: every 22.5 degrees."""
    return [
        pinch((0, 0, height), _at(turn + SEGMENTS // 4), diameter, tuple(-a for a in _at(turn)))
        for turn in range(SEGMENTS)
    ]


def rim(outer: float, inner: float, height: float, *, leave_out: Iterable[int] = ()) -> list[Grasp]:
    """Hold a round wall from above, one finger inside and one outside, every 22.5 degrees.

    Args:
        outer: Outer radius [m].
        inner: Inner radius [m].
        height: Height of the pads [m].
        leave_out: Sixteenths of a turn, from +x anticlockwise, where something is in the way.
    """
    taken = set(leave_out)
    middle = (outer + inner) / 2
    return [
        pinch((*(middle * a for a in _at(turn)[:2]), height), _at(turn), outer - inner)
        for turn in range(SEGMENTS)
        if turn not in taken
    ]


def _at(turn: int) -> tuple[float, float, float]:
    """Horizontal unit vector at so many sixteenths of a turn from +x."""
    angle = 2 * np.pi * turn / SEGMENTS
    return float(np.cos(angle)), float(np.sin(angle)), 0.0
