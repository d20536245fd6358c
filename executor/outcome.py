"""Did it work? A new look at the scene, compared with the goal and with the look before."""

from dataclasses import replace

import numpy as np

from executor.report import Outcome
from executor.sight import Sight
from robots.pose import FloatArray
from twin import board

HALF_CELL = board.CELL / 2
"""An object is at its place when its centre is within half a cell of it [m]."""
BORDERLINE = 0.003
"""So near to half a cell a look does not tell on which side of it an object is [m]: three deviations of a look."""
NOTICEABLE = 0.010
"""A shift of another object is worth a word from here on [m]: more than noise, less than a displacement."""


def judge(object_id: int, goal: FloatArray | None, before: Sight, after: Sight) -> Outcome:
    """Compare two looks.

    Args:
        object_id: Which object should have moved.
        goal: Where its centre should be now, in the world, (3,) [m]; None where it should be in the gripper.
        before: The look before the motion.
        after: The look after it.
    """
    if object_id not in after.object_ids:
        return Outcome(False, None, (), "the block is not seen any more", doubt="the block is not seen any more")
    words = []
    doubt = ""
    error: float | None = None
    if goal is None:
        reached = after.held == object_id
        words.append("the block is in the gripper" if reached else "the block is not in the gripper")
    else:
        offset = after.where(object_id) - goal
        error = float(np.linalg.norm(offset[:2]))
        reached = error < HALF_CELL and abs(float(offset[2])) < board.BLOCK / 2
        if after.held == object_id:
            reached = False
            words.append("the block is still in the gripper")
        elif abs(error - HALF_CELL) < BORDERLINE:
            doubt = "the block is so near to the edge of its place that I cannot tell whether it is in it"
            words.append(doubt)
        elif reached:
            words.append(f"the block stands {1000 * error:.0f} mm from the middle of its place")
        else:
            words.append(f"the block is {1000 * float(np.linalg.norm(offset)):.0f} mm from where it should be")
    disturbed, shifted = [], 0.0
    for other in before.object_ids:
        if int(other) == object_id:
            continue
        if other not in after.object_ids:
            doubt = "another block is not seen any more"
            words.append(doubt)
            continue
        shift = float(np.linalg.norm(after.where(int(other)) - before.where(int(other))))
        if shift >= HALF_CELL:
            disturbed.append(int(other))
        shifted = max(shifted, shift)
    if disturbed:
        words.append(f"{len(disturbed)} other block{'s' if len(disturbed) > 1 else ''} moved as well")
    elif shifted >= NOTICEABLE:
        words.append(f"another block was pushed by {1000 * shifted:.0f} mm")
    return Outcome(reached, error, tuple(disturbed), "; ".join(words), doubt)


def agreed(one: Outcome, other: Outcome) -> Outcome:
    """What two looks say together: an outcome that only one of them saw is in doubt."""
    if one.doubt or other.doubt:
        return one if one.doubt else other
    if one.right == other.right:
        return one
    return replace(one, doubt="two looks disagree about how it came out")
