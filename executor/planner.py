"""From goal to motion plan: the states of the learned action graphlet, one by one (thesis 3.3.4, 6.4).

Each state of an action graphlet says whether the gripper is closed, whether it touches the object, and which of the
object's places (0, 1, ...) it is in. What changes from one state to the next is what the tool has to do:

==========================================  =============================================
apart, before any touch                     open the gripper, go above the object
apart -> touching                           descend onto the object
open -> closed while touching               close the gripper
place changes while closed and touching     lift, carry above everything on the way, lower
closed -> open while touching               open the gripper
touching -> apart                           retreat upwards
==========================================  =============================================

So another graphlet gives another plan: nothing here knows an action by name.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from executor.errors import RefusalError
from executor.motion_plan import MotionPlan, MoveGripper, MoveTool, Purpose, Step
from executor.sight import Sight
from robots.pose import FloatArray

if TYPE_CHECKING:
    from learning.graphs import ActionGraphlet, GraphletState

CLEARANCE = 0.025
"""Free height between the lower side of what is carried (or the finger tips) and what stands below [m]."""
APPROACH = 0.060
"""Height of the tool above the grasp where an approach ends and a retreat ends [m]."""
CORRIDOR = 0.060
"""Objects nearer than this to the line of travel, seen from above, are on the way [m]: more than a cell."""
RELEASE_GAP = 0.001
"""Height above its place at which an object is let go [m]; pressing it down would push the stack."""


@dataclass(frozen=True, slots=True)
class Way:
    """How an object is gripped and carried, where there is a choice.

    Attributes:
        grip_above: Height of the tool above the object's centre when it closes [m].
        clearance: Free height between what is carried and what stands below it [m].
    """

    grip_above: float = 0.0
    clearance: float = CLEARANCE


WAYS = (Way(), Way(grip_above=-0.005, clearance=1.8 * CLEARANCE))
"""The usual way, and another for when that failed: the fingers reach deeper, and all is carried higher."""


class _Planner:
    """Walks along the states of one graphlet and collects the steps."""

    def __init__(self, object_id: int, goal: FloatArray | None, sight: Sight, block: float, way: Way) -> None:
        self.way = way
        self.sight = sight
        self.object_id = object_id
        self.goal = goal
        self.block = block
        self.tool: FloatArray = sight.tool
        self.object: FloatArray = sight.where(object_id)
        self.closed = sight.gripper_closed
        self.touching = sight.held == object_id
        self.places: dict[int, FloatArray] = {0: self.object}
        self.steps: list[Step] = []
        self.index = 0

    def follow(self, state: "GraphletState", index: int, last_location: int) -> None:
        """Add what leads from where the plan stands to `state`."""
        self.index = index
        if self.touching and not state.touching:
            self._let_go(state)
        elif not self.touching and not state.touching:
            self._grip(state.gripper_closed)
            self._approach()
        elif not self.touching:
            self._reach(state)
        moved = state.object_location not in self.places or not np.array_equal(
            self.places[state.object_location], self.object
        )
        if moved:
            self._displace(state, last_location)
        self._grip(state.gripper_closed)

    def _grip(self, closed: bool) -> None:
        if closed != self.closed:
            self.steps.append(MoveGripper(closed, self.index))
            self.closed = closed

    def _move(self, position: FloatArray, purpose: Purpose) -> None:
        if float(np.linalg.norm(position - self.tool)) > 1e-6:
            self.steps.append(MoveTool(position, purpose, self.index))
            self.tool = np.asarray(position, dtype=np.float64)

    def _approach(self) -> None:
        """Go above the object over everything that stands on the way."""
        above = self.object + [0.0, 0.0, APPROACH]
        self._travel(above, "approach", "approach", "approach")

    def _reach(self, state: "GraphletState") -> None:
        if self.closed or state.gripper_closed:
            raise RefusalError("the learned action touches a block with a closed gripper, which moves nothing surely")
        self._move(self.object + [0.0, 0.0, self.way.grip_above], "descend")
        self.touching = True

    def _let_go(self, state: "GraphletState") -> None:
        if self.closed and state.gripper_closed:
            raise RefusalError("the learned action leaves a block with a closed gripper, which cannot be done")
        self._grip(False)
        self._move(self.tool + [0.0, 0.0, APPROACH], "retreat")
        self.touching = False

    def _displace(self, state: "GraphletState", last_location: int) -> None:
        """Bring the held object to the place of `state`: the goal, an earlier place, or up into the air."""
        if not (self.closed and self.touching and state.touching):
            raise RefusalError("the learned action moves a block without holding it, which the arm cannot do")
        grip = self.tool - self.object  # how the object sits in the gripper does not change on the way
        if state.object_location in self.places:
            target = self.places[state.object_location]
        elif state.object_location == last_location and self.goal is not None:
            target = self.goal
        else:
            target = np.append(self.object[:2], self._height(self.object, self.object))
        if np.allclose(target[:2], self.object[:2]) and target[2] > self.object[2]:
            self._move(target + grip, "lift")
        else:
            self._travel(target + grip + [0.0, 0.0, RELEASE_GAP], "lift", "carry", "lower")
        self.object = target
        self.places[state.object_location] = target

    def _travel(self, target: FloatArray, rise: Purpose, across: Purpose, sink: Purpose) -> None:
        """Rise, cross at a height above everything on the way, sink."""
        height = max(self._height(self.tool, target), float(self.tool[2]), float(target[2]))
        self._move(np.append(self.tool[:2], height), rise)
        self._move(np.append(target[:2], height), across)
        self._move(target, sink)

    def _height(self, start: FloatArray, end: FloatArray) -> float:
        """Height of the tool at which it and a block in it pass over all that stands along the way [m]."""
        others = self.sight.location[self.sight.object_ids != self.object_id]
        top = 0.0 if self.touching else float(self.object[2]) + self.block / 2
        if len(others):
            way = end[:2] - start[:2]
            along = np.clip((others[:, :2] - start[:2]) @ way / max(float(way @ way), 1e-9), 0.0, 1.0)
            aside = np.linalg.norm(others[:, :2] - start[:2] - along[:, None] * way, axis=1)
            near = others[aside < CORRIDOR, 2]
            top = max(top, float(near.max()) + self.block / 2) if len(near) else top
        if self.touching:
            top = max(top, float(self.object[2]) - self.block / 2)
        return top + self.block / 2 + self.way.clearance


def plan_motion(
    object_id: int,
    goal: FloatArray | None,
    action: "ActionGraphlet",
    sight: Sight,
    block: float,
    way: Way = WAYS[0],
) -> MotionPlan:
    """Turn a goal into tool waypoints and gripper moves.

    Where the object is in the gripper already, the plan starts at the first state that holds it.

    Args:
        object_id: Which object to move.
        goal: Where its centre should end, in the world, (3,) [m]; None to keep it in the gripper.
        action: The learned action graphlet to follow.
        sight: What was seen of the scene.
        block: Height of an object [m].
        way: How it is gripped and carried.

    Raises:
        RefusalError: The graphlet does not start from this scene, or asks for what the arm cannot do.
    """
    states = action.states
    if sight.held is not None and sight.held != object_id:
        raise RefusalError("the gripper holds another block; tell me where to put that one first")
    holds = sight.held == object_id
    first = next((i for i, s in enumerate(states) if s.touching == holds and (s.gripper_closed or not holds)), None)
    if first is None or (not holds and first != 0):
        raise RefusalError("the robot holds nothing, and this action starts with a block in the gripper")
    last_location = states[-1].object_location
    if goal is None and last_location != 0 and not states[-1].touching:
        raise RefusalError("the action puts a block down, and no place for it was understood")
    planner = _Planner(object_id, goal, sight, block, way)
    for index in range(first, len(states)):
        planner.follow(states[index], index, last_location)
    if not planner.steps:
        raise RefusalError("nothing has to be done: the scene is already as the sentence says")
    return MotionPlan(tuple(planner.steps), object_id, goal)
