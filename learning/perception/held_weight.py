"""What a held thing weighs, felt at the wrist."""

import numpy as np
from numpy.typing import NDArray

from learning.perception.proprioception import Proprioception
from robots.pose import FloatArray

GRAVITY = 9.81
"""[m/s²]"""
STILL = 0.01
"""A hand slower than this is still [m/s]; a moving one feels inertia too."""
IN_HAND_BEFORE = 3
"""What is held within so many first frames was held before."""
MOVING_FRAMES = 8
"""Where the hand never held it still, the median over at least so many frames in which speeding up and slowing down
cancel."""
RAISED = 0.010
"""A thing lifted by this carries nothing on the table any more [m]."""


def empty_hand(own: Proprioception, touching: NDArray[np.bool_]) -> float | None:
    """Vertical force of the still, open hand that touches nothing [N]; None where it never was.

    Args:
        own: What the robot felt.
        touching: Frames in which the hand may touch something, (F,).
    """
    if own.force is None:
        return None
    free = still(own) & ~own.closed & ~touching & np.isfinite(own.force[:, 2])
    return float(np.median(own.force[free, 2])) if free.any() else None


def held_weight(
    own: Proprioception, empty: float | None, held: NDArray[np.bool_], height: FloatArray, foot: FloatArray
) -> float:
    """Weight of a thing [kg]; NaN where the hand never held it in the air.

    Args:
        own: What the robot felt.
        empty: What the empty hand feels [N].
        held: Frames in which the thing is believed to be in the hand, (F,).
        height: Height of its middle over time, (F,) [m].
        foot: Height of its lower end, (F,) [m].
    """
    if own.force is None or empty is None or not held.any():
        return float("nan")
    first = int(np.argmax(held))
    # What is in the hand from the beginning was never seen at rest: its foot tells whether it is in the air.
    raised = height > height[first - 1] + RAISED if first > IN_HAND_BEFORE else foot > RAISED
    lifted = held & own.closed & raised & np.isfinite(own.force[:, 2])
    if (lifted & still(own)).any():
        lifted &= still(own)
    elif lifted.sum() < MOVING_FRAMES:
        return float("nan")
    # A hand at rest is pulled down: its force points down.
    return max((empty - float(np.median(own.force[lifted, 2]))) / GRAVITY, 0.0)


def still(own: Proprioception) -> NDArray[np.bool_]:
    """Frames in which the hand does not move, (F,)."""
    if len(own.times) < 2:
        return np.ones(len(own.times), dtype=bool)
    speed = np.linalg.norm(np.diff(own.tool[:, :3], axis=0), axis=1) / np.maximum(np.diff(own.times), 1e-6)
    fast = speed > STILL
    return np.asarray(~(np.append(fast, False) | np.append(False, fast)))
