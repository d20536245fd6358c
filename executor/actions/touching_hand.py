"""A closed hand that touches one object from outside: leans on it, pushes it along, and draws back."""

import numpy as np

from executor.actions.closed_hand import Approach, come_near
from executor.actions.force import Feeling, ForceTouch
from executor.actions.pressing import press_approach
from executor.actions.primitives import Touch
from executor.actions.pushing import push_approach
from executor.arm_motions import ArmMotions, moved
from executor.grasp_choice import GENTLE
from executor.handled import Handled
from learning.graphs.graphlet_state import Side
from robots.pose import FloatArray

FELT_WITHIN = 0.03
"""A touch must be felt within this way [m] after where it was expected."""
FELT = 0.3
"""Least force [N] at the wrist that tells that a push has begun."""
BACK = (0.06, 0.04, 0.02)
"""How far [m] a hand draws back from what it touched, the farthest that it can."""


class TouchingHand:
    """Touches an object from outside.

    Args:
        motions: The arm, its hand closed.
        object_id: The object.
    """

    def __init__(self, motions: ArmMotions, object_id: int) -> None:
        self._motions = motions
        self._object = object_id
        self._foreseen: Approach | None = None
        self._approach: Approach | None = None
        self._leaning: ForceTouch | None = None

    @property
    def came(self) -> bool:
        """Whether the hand has come to the object to touch it."""
        return self._approach is not None

    def foresee(self, touch: Touch, rng: np.random.Generator) -> Handled:
        """Whether there is a way to touch the object with closed fingers; nothing moves, and what was found is kept.

        Raises:
            TwinError: There is no such object.
        """
        fingers = self._motions.fingers
        before = fingers.opening
        fingers.tell(0.0)
        found = self._found(touch, rng)
        fingers.tell(before)
        if isinstance(found, str):
            return Handled(False, found)
        self._foreseen = found
        return Handled(True)

    def touch(self, touch: Touch, rng: np.random.Generator) -> Handled:
        """Come to the object and lean on it; one that will be pushed on is only come near to.

        Raises:
            TwinError: There is no such object.
        """
        motions = self._motions
        found = self._foreseen or self._found(touch, rng)
        self._foreseen = None
        if isinstance(found, str):
            return Handled(False, found)
        came = come_near(motions, found, self._object)
        if not came.success:
            return came
        self._approach = found
        if touch.onwards:
            return Handled(True)  # it is felt, and pushed on, in one go
        feeling = Feeling(motions, found.direction)
        # The way down ends before the touch; that along the table goes on through it.
        motions.play(found.way, None if touch.side is Side.ABOVE else lambda: feeling.force > FELT)
        self._leaning = ForceTouch(motions, found.direction, touch.force)
        if not self._leaning.come(FELT_WITHIN):
            return Handled(False, f"not felt: the wrist felt {self._leaning.felt:.1f} N where the object should be")
        return Handled(True)

    def _found(self, touch: Touch, rng: np.random.Generator) -> Approach | str:
        """A way to touch the object; or why there is none."""
        if touch.side is Side.ABOVE:
            return press_approach(self._motions, self._object)
        return push_approach(self._motions, self._object, touch.onwards, rng)

    def push(self, way: float) -> Handled:
        """Push the object on by a way [m], measured from where the wrist first feels it."""
        approach = self._approach
        if approach is None:
            return Handled(False, "nothing touched: a push needs a touch before")
        feeling = Feeling(self._motions, approach.direction)
        felt: list[FloatArray] = []

        def far_enough() -> bool:
            here = self._motions.world.state().arms[self._motions.number].pose_tool_in_world.position
            if not felt and feeling.force > FELT:
                felt.append(here.copy())
            return bool(felt) and float((here - felt[0]) @ approach.direction) >= way

        self._motions.play(approach.way, far_enough)
        return Handled(True) if felt else Handled(False, "not felt: the hand met nothing on its way")

    def keep(self, seconds: float) -> bool:
        """Keep leaning for a time [s]; whether the hand leans on anything."""
        if self._leaning is None:
            return False
        self._leaning.keep(seconds)
        return True

    def draw_back(self) -> Handled:
        """Leave the object the way the hand came."""
        if self._leaning is not None:
            self._leaning.end()
            self._leaning = None
        if self._approach is None:
            return Handled(False, "nothing touched: there is nothing to draw back from")
        back, direction = Handled(True), self._approach.direction
        for way in BACK:
            back = self._motions.go_straight(moved(self._motions.tool, -way * direction), GENTLE)
            if back.success:
                break
        return back
