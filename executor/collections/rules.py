"""When a demo shows what it shall: one rule for each action, judged by physics.

Heights are those of an object's underside above the table.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from executor.collections.performance import Judge, Shown
from robots.kinematics import rotation_matrix
from robots.pose import FloatArray, Pose
from twin.objects import ObjectModel
from twin.state import WorldState

LIFTED = 0.05
"""A lifted object is so far off the table [m]."""
ON_TABLE = 0.006
"""One that is on it, at most [m]."""
STILL = 0.006
"""One that is held still moves less than this [m],"""
HELD_FOR = 2.0
"""for so long [s]."""
UNMOVED = 0.010
"""One that was only touched moves less than this [m]."""
PUSHED = 0.03
"""One that was pushed moves at least so far [m],"""
PUSHED_UP = 0.012
"""and is never so high above the table [m]."""
DROPPED_FROM = 0.012
"""One that is dropped is at least so high when it is let go [m]."""
PRESSED_WITH = 2.0
"""One that is pressed pushes back with this force at least [N]."""
LAST_MOMENTS = 3
"""States before the fingers open in which a thing is held that does not slip out of them."""
FARTHER = 0.06
"""What was moved is so far from where it was, at least [m]."""
OTHERS_MOVED = 0.015
"""Other objects may move by so much [m]."""
UPRIGHT = 0.35
"""An object that was put down may be tilted by so much against how it stood [rad]."""
AT_REST = 0.02
"""Speed of an object at rest, at most [m/s]."""
ON_THE_TABLE_X, ON_THE_TABLE_Y = (0.38, 1.04), (-0.58, 0.58)
"""An object whose centre leaves this has fallen off, or nearly [m]."""


class Facts:
    """What a demo's states say of the object that is handled.

    Attributes:
        shown: The demo.
        places: Its poses, T of them.
        positions: Its centres, (T, 3) [m].
        heights: Of its underside above the table, (T,) [m].
        held: Whether the hand had it, (T,).
        closed: Whether the fingers were told to close, (T,).
    """

    def __init__(self, shown: Shown, model: ObjectModel) -> None:
        """Look at all states once."""
        hands = [state.arms[shown.hand] for state in shown.states]
        target = shown.plan.target
        self.shown = shown
        self.places = [place_of(state, target) for state in shown.states]
        self.positions: FloatArray = np.array([pose.position for pose in self.places])
        self.heights: FloatArray = np.array([underside(model, pose) for pose in self.places])
        self.held = np.array([hand.held == target for hand in hands])
        self.closed = np.array([hand.gripper_closed for hand in hands])

    @property
    def moved(self) -> float:
        """How far it has come along the table [m]."""
        return float(np.linalg.norm((self.positions[-1] - self.positions[0])[:2]))

    @property
    def strayed(self) -> float:
        """How far it was from its start at most [m]."""
        return float(np.linalg.norm(self.positions - self.positions[0], axis=1).max())

    @property
    def slipped(self) -> bool:
        """Whether what was held had left the hand when the fingers were told to open."""
        return slipped_out(self.held, self.closed)

    def trouble(self) -> str:
        """What no action allows: other objects moved along, an object off the table or not at rest at the end."""
        first, last = self.shown.states[0], self.shown.states[-1]
        for before, after in zip(first.objects, last.objects, strict=True):
            off = after.pose_object_in_world.position - before.pose_object_in_world.position
            if before.id != self.shown.plan.target and np.linalg.norm(off) > OTHERS_MOVED:
                return f"another object was pushed {1000 * np.linalg.norm(off):.0f} mm"
        x, y, z = self.positions[-1].tolist()
        inside = ON_THE_TABLE_X[0] < x < ON_THE_TABLE_X[1] and ON_THE_TABLE_Y[0] < y < ON_THE_TABLE_Y[1]
        if not inside or z < 0.0:
            return "the object left the table"
        if np.linalg.norm(self.positions[-1] - self.positions[-3]) * 15.0 > AT_REST:
            return "the object still moves at the end"
        return ""

    def tilted(self) -> bool:
        """Whether it stands otherwise than at the start."""
        first, last = (rotation_matrix(each.orientation_xyzw)[:, 2] for each in (self.places[0], self.places[-1]))
        return bool(np.arccos(np.clip(first @ last, -1.0, 1.0)) > UPRIGHT)


def slipped_out(held: NDArray[np.bool_], closed: NDArray[np.bool_]) -> bool:
    """Whether what was held, (T,), had left the fingers when they were last closed, (T,).

    Contacts flicker: that it was felt in one of the last moments is enough.
    """
    before = np.flatnonzero(closed)[-LAST_MOMENTS:]
    return bool(held.any() and not held[before].any())


Rule = Callable[[Facts], str]


def judge_of(rule: Rule, model: ObjectModel) -> Judge:
    """A judge of demos by a rule."""

    def judge(shown: Shown) -> str:
        facts = Facts(shown, model)
        return rule(facts) or facts.trouble()

    return judge


def grasped(facts: Facts) -> str:
    """Held at the end, and not lifted."""
    if facts.held[0]:
        return "held at the start already"
    if not (facts.held[-1] and facts.closed[-1]):
        return "not held at the end"
    return "lifted" if facts.heights.max() > 2 * ON_TABLE or facts.moved > PUSHED else ""


def lifted(facts: Facts) -> str:
    """Held all the time; on the table at the start, well above it at the end."""
    if not facts.held[[0, -1]].all():
        return "not held from start to end"
    if facts.heights[0] > 2 * ON_TABLE:
        return "lifted at the start already"
    return "" if facts.heights[-1] > LIFTED else f"lifted by {1000 * facts.heights[-1]:.0f} mm only"


def held_still(facts: Facts) -> str:
    """Held above the table, still, long enough."""
    if not facts.held.all() or facts.heights.min() < 0.6 * LIFTED:
        return "not held above the table all the time"
    if facts.strayed > STILL:
        return f"moved {1000 * facts.strayed:.0f} mm"
    seconds = facts.shown.states[-1].time - facts.shown.states[0].time
    return "" if seconds >= HELD_FOR else f"held for {seconds:.1f} s only"


def lowered(facts: Facts) -> str:
    """Held all the time; above the table at the start, on it at the end."""
    if not facts.held[[0, -1]].all() or not facts.closed.all():
        return "not held from start to end"
    if facts.heights[0] < 0.6 * LIFTED:
        return "not above the table at the start"
    return "" if facts.heights[-1] < ON_TABLE else f"{1000 * facts.heights[-1]:.0f} mm above the table at the end"


def dropped(facts: Facts) -> str:
    """Held above the table at the start, let go there, on the table at the end."""
    if not facts.held[0] or facts.held[-1]:
        return "not let go"
    told = facts.heights[facts.closed]
    if not len(told) or told[-1] < DROPPED_FROM:
        return "let go at the table"
    return "" if facts.heights[-1] < 2 * ON_TABLE else "not on the table at the end"


def pressed(facts: Facts) -> str:
    """Pressed with closed fingers, not moved, left again."""
    if not facts.closed.all():
        return "fingers not closed"
    if facts.shown.felt < PRESSED_WITH:
        return f"pressed with {facts.shown.felt:.1f} N only"
    return f"moved {1000 * facts.strayed:.0f} mm" if facts.strayed > UNMOVED else ""


def pushed(facts: Facts) -> str:
    """Moved along the table by closed fingers, not lifted, not toppled."""
    if not facts.closed.all():
        return "fingers not closed"
    if facts.heights.max() > PUSHED_UP or facts.tilted():
        return "toppled or lifted"
    return "" if facts.moved >= PUSHED else f"moved {1000 * facts.moved:.0f} mm only"


def set_down(facts: Facts, *, brought: bool, may_roll: bool) -> str:
    """Held at the start or taken first, carried, and let go so that it stands.

    Args:
        facts: What was shown.
        brought: Whether it was free at the start, and has to come a way along the table.
        may_roll: Whether it may lie otherwise than before.
    """
    if facts.held[-1]:
        return "still held at the end"
    if facts.held[0] == brought:
        return "held otherwise at the start than the action says"
    if facts.slipped:
        return "slipped out of the hand"
    if brought and facts.moved < FARTHER:
        return f"moved {1000 * facts.moved:.0f} mm only"
    return "toppled" if not may_roll and facts.tilted() else ""


def picked_up(facts: Facts) -> str:
    """On the table and free at the start, held well above it at the end."""
    if facts.held[0] or not facts.held[-1]:
        return "not held at the end"
    return "" if facts.heights[-1] > LIFTED else f"lifted by {1000 * facts.heights[-1]:.0f} mm only"


def place_of(state: WorldState, target: int) -> Pose:
    """Where an object is."""
    return next(each.pose_object_in_world for each in state.objects if each.id == target)


def underside(model: ObjectModel, pose: Pose) -> float:
    """Height of an object's lowest point above the table [m]."""
    up = rotation_matrix(pose.orientation_xyzw)[2]
    return float(pose.position[2]) + min(float((part.vertices @ up).min()) for part in model.parts)
