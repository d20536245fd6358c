"""When an action has succeeded: one written rule an action, judged by physics alone.

Rules are for scoring, as the truth of a demo is: nothing that plans or plays an action reads them.
"""

from collections.abc import Callable
from types import MappingProxyType

import numpy as np

from executor.actions.things import pose_of
from executor.actions.witness import Evidence
from robots.kinematics import rotation_matrix
from robots.pose import FloatArray

LIFTED = 0.05
"""A lifted object is so far off what bore it [m]."""
TAKEN = 0.02
"""One that is picked up is so far off it [m]."""
RESTING = 0.006
"""Free height [m] below what rests: grasped things may be tilted a little."""
NEAR = 0.025
"""How far from its destination an object may come to rest [m]: half a cell of the board."""
SLIGHT = 0.010
"""What moved less counts as still [m]."""
DISTURBED = 0.025
"""No other object may have moved further [m]."""
PUSHED = 0.03
"""A pushed object has moved so far [m]."""
HELD_FOR = 2.0
"""Time for which an object is held still [s],"""
HELD_STILL = 0.005
"""moving less than this [m]."""
PRESSED = 3.0
"""Force at the wrist when something is pressed [N]."""
FALLEN = 0.02
"""What is dropped falls at least so far [m]."""
TOPPLED = 0.5
"""A tilt [rad] beyond which what is set down or pushed along has fallen over."""

Rule = Callable[[Evidence, FloatArray | None], str]
"""What is wrong with an action, given its evidence and destination (3,) [m]; empty when it succeeded."""


def fault_of(action: str, evidence: Evidence, goal: FloatArray | None) -> str:
    """What is wrong with an action that was played; empty when it succeeded. The first words name the kind of fault.

    Args:
        action: Its true name, one of `RULES`.
        evidence: What physics says.
        goal: Where the object's centre should have come to rest, (3,) [m], for actions that bring it somewhere.

    Raises:
        KeyError: There is no rule for the action.
    """
    return RULES[action](evidence, goal) or _others_moved(evidence)


def _pick_up(evidence: Evidence, goal: FloatArray | None) -> str:
    if not evidence.held_after:
        return "not held: the object is not between closed fingers at the end"
    return "" if evidence.clear_after > TAKEN else f"not clear: {_mm(evidence.clear_after)} above what bears it"


def _put_down(evidence: Evidence, goal: FloatArray | None) -> str:
    if evidence.held_after or bool(evidence.closed[-1]):
        return "not let go: the hand is still closed"
    return _rests(evidence, goal, upright=True)


def _lift(evidence: Evidence, goal: FloatArray | None) -> str:
    if not evidence.held_after:
        return "not held: the object is not between closed fingers at the end"
    return "" if evidence.clear_after >= LIFTED else f"not lifted: {_mm(evidence.clear_after)} off the table"


def _lower(evidence: Evidence, goal: FloatArray | None) -> str:
    if not evidence.held_after:
        return "not held: the object is not between closed fingers at the end"
    if evidence.clear[0] < TAKEN:
        return "not raised: the object was on the table before it was lowered"
    return _rests(evidence, goal, upright=False)


def _drop(evidence: Evidence, goal: FloatArray | None) -> str:
    opened = np.flatnonzero(~evidence.closed)
    if not len(opened):
        return "not let go: the hand never opened"
    if evidence.clear[opened[0]] < FALLEN:
        return f"not in the air: let go {_mm(evidence.clear[opened[0]])} above the table"
    fell = float(evidence.centre[opened[0], 2] - pose_of(evidence.after, evidence.object_id).position[2])
    return "" if fell >= FALLEN else f"did not fall: {_mm(fell)}"


def _press(evidence: Evidence, goal: FloatArray | None) -> str:
    downward = float((evidence.wrist_force[:, 2] - evidence.wrist_force[0, 2]).max())
    if downward < PRESSED:
        return f"not pressed: at most {downward:.1f} N downwards"
    return "" if _moved(evidence) < SLIGHT else f"moved: the pressed object by {_mm(_moved(evidence))}"


def _push(evidence: Evidence, goal: FloatArray | None) -> str:
    if evidence.clear.max() > SLIGHT:
        return f"lifted: the pushed object was {_mm(evidence.clear.max())} off the table"
    if _tilted(evidence) > TOPPLED:
        return "toppled: the pushed object fell over"
    along = float(np.linalg.norm(_shift(evidence)[:2]))
    return "" if along >= PUSHED else f"not pushed: moved by {_mm(along)}"


def _hold(evidence: Evidence, goal: FloatArray | None) -> str:
    if not evidence.held_after or evidence.clear.min() < TAKEN:
        return "not held: the object is not held in the air"
    until = evidence.times - evidence.times[0] <= HELD_FOR
    strayed = float(np.linalg.norm(evidence.centre[until] - evidence.centre[0], axis=1).max())
    if evidence.times[-1] - evidence.times[0] < HELD_FOR:
        return f"too short: held for {evidence.times[-1] - evidence.times[0]:.1f} s"
    return "" if strayed < HELD_STILL else f"not still: the held object moved by {_mm(strayed)}"


def _grasp(evidence: Evidence, goal: FloatArray | None) -> str:
    if not evidence.held_after:
        return "not held: the object is not between closed fingers at the end"
    return "" if evidence.clear_after < SLIGHT else f"lifted: {_mm(evidence.clear_after)} off the table"


RULES: MappingProxyType[str, Rule] = MappingProxyType(
    {
        "pick up": _pick_up,
        "put down": _put_down,
        "move": _put_down,
        "grasp": _grasp,
        "lift": _lift,
        "lower": _lower,
        "drop": _drop,
        "press": _press,
        "push": _push,
        "hold": _hold,
    }
)
"""Rule of each action by its true name."""


def _rests(evidence: Evidence, goal: FloatArray | None, upright: bool) -> str:
    """What is wrong with how and where the object rests."""
    if evidence.clear_after > (RESTING if upright else SLIGHT):
        return f"not down: {_mm(evidence.clear_after)} above what bears it"
    if upright and _tilted(evidence) > TOPPLED:
        return "toppled: the object fell over"
    if goal is None:
        return ""
    off = pose_of(evidence.after, evidence.object_id).position - goal
    if float(np.linalg.norm(off)) > NEAR:
        return f"misplaced: {_mm(float(np.linalg.norm(off)))} from its destination"
    return ""


def _shift(evidence: Evidence) -> FloatArray:
    """How far the object's centre has moved, (3,) [m]."""
    after = pose_of(evidence.after, evidence.object_id).position
    return np.asarray(after - pose_of(evidence.before, evidence.object_id).position)


def _moved(evidence: Evidence) -> float:
    return float(np.linalg.norm(_shift(evidence)))


def _tilted(evidence: Evidence) -> float:
    """Angle [rad] between the object's vertical axis before and after."""
    one, other = (
        rotation_matrix(pose_of(state, evidence.object_id).orientation_xyzw)[:, 2]
        for state in (evidence.before, evidence.after)
    )
    return float(np.arccos(np.clip(one @ other, -1.0, 1.0)))


def _others_moved(evidence: Evidence) -> str:
    """What other objects were moved."""
    shifts = {
        each.id: float(np.linalg.norm(pose_of(evidence.after, each.id).position - each.pose_object_in_world.position))
        for each in evidence.before.objects
        if each.id != evidence.object_id
    }
    worst = max(shifts.values(), default=0.0)
    return f"disturbed: another object was moved by {_mm(worst)}" if worst > DISTURBED else ""


def _mm(metres: float) -> str:
    return f"{1000 * metres:.0f} mm"
