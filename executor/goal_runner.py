"""One goal carried out: look, plan, move, look again; once more if the grasp slipped."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from executor.errors import ExecutorError, RefusalError
from executor.execution.stopwatch import Stopwatch
from executor.free_places import free_place
from executor.motion import Motion
from executor.motion_plan import MotionPlan, MoveGripper
from executor.outcome import HALF_CELL, agreed, judge
from executor.planner import WAYS, Way, plan_motion
from executor.report import Outcome
from executor.sight import Sight
from learning.graphs import ActionGraphlet, GraphletState
from learning.perception import observe_world
from twin import board

if TYPE_CHECKING:
    from learning.interpretation import Goal
    from learning.perception import Observation
    from twin import World

NOTHING = -1
"""Track number of no object."""
PUT_DOWN = ActionGraphlet((GraphletState(True, True, 0), GraphletState(False, True, 1), GraphletState(False, False, 1)))
"""How the hand is freed when something went wrong: innate, as nobody shows that."""
ATTEMPTS = 2
"""How often an object is reached for: a grasp that slipped is tried once more."""


@dataclass(frozen=True, slots=True)
class Run:
    """How a goal was carried out.

    Attributes:
        plan: The last plan.
        outcome: What the last look showed; None when nothing was moved.
        attempts: How often the object was reached for.
        note: What happened on the way, in plain words, or nothing.
    """

    plan: MotionPlan
    outcome: Outcome | None
    attempts: int
    note: str


class GoalRunner:
    """Carries out goals in one world, seeing it through noise only.

    Args:
        world: The world.
        rng: Source of the noise of looking.
    """

    def __init__(self, world: "World", rng: np.random.Generator) -> None:
        self.world = world
        self.rng = rng
        self.motion = Motion(world)
        self.stopwatch = Stopwatch()
        self.motion.on_start = lambda: self.stopwatch.mark_once("to_motion")

    def look(self) -> "Observation":
        """Observe the world as it stands now."""
        with self.stopwatch.part("perceive"):
            return observe_world(self.world.state(), self.world.spec, self.rng)

    def plan(self, goal: "Goal", sight: Sight, way: Way = WAYS[0]) -> MotionPlan:
        """Plan a goal in the scene that was seen, in one way of gripping and carrying.

        Raises:
            RefusalError: The goal cannot be carried out; says why.
        """
        with self.stopwatch.part("plan"):
            check_goal(goal, sight)
            plan = plan_motion(goal.object_id, goal.position, goal.action, sight, board.BLOCK, way)
            self.motion.check_reach(plan)
        return plan

    def carry_out(self, goal: "Goal", sight: Sight) -> Run:
        """Plan and move until a look shows that the goal is reached, at most `ATTEMPTS` times.

        Args:
            goal: What to reach.
            sight: What was seen of the scene as it stands.

        Raises:
            RefusalError: The goal cannot be carried out from the start.
        """
        before, note = sight, ""
        plan = self.plan(goal, sight)
        attempt = 1
        while True:
            self._move(plan)
            now, outcome = self._checked(goal, before)
            if outcome.reached or attempt == ATTEMPTS:
                break
            try:
                plan = self.plan(goal, now, WAYS[attempt % len(WAYS)])
            except RefusalError as refusal:
                note = f"a second try is not possible: {refusal}"
                break
            attempt += 1
            note = "the first grasp slipped, so I tried once more, another way"
        if not outcome.right:
            note = "; ".join(part for part in (note, self.come_to_rest(goal, now)) if part)
        return Run(plan, outcome, attempt, note)

    def come_to_rest(self, goal: "Goal | None", now: Sight) -> str:
        """After something went wrong: put down what is in the gripper where there is room, or open it.

        Args:
            goal: What was tried; what should be in the gripper stays there. None lets go of anything.
            now: The scene as it is seen.

        Returns:
            What was done, in plain words, or nothing.
        """
        if not now.gripper_closed or (goal is not None and goal.position is None and now.held == goal.object_id):
            return ""
        if now.held is None:
            self._move(MotionPlan((MoveGripper(False, 0),), NOTHING, None))
            return "the gripper was closed on nothing and is open again"
        place = free_place(now, now.where(now.held), ())
        if place is None:
            return "there is no free place to put down what is in the gripper"
        try:
            plan = plan_motion(now.held, place, PUT_DOWN, now, board.BLOCK, WAYS[1])
            self.motion.check_reach(plan)
        except ExecutorError as error:
            return f"what is in the gripper stays there: {error}"
        self._move(plan)
        return "what was in the gripper was put down at a free place"

    def _move(self, plan: MotionPlan) -> None:
        begun = self.world.time
        with self.stopwatch.part("move"):
            self.motion.run(plan)
        self.stopwatch.add("simulated", self.world.time - begun)

    def _checked(self, goal: "Goal", before: Sight) -> tuple[Sight, Outcome]:
        """Look twice, and compare both looks with the goal; returns the second look too."""
        first, second = (Sight.of(self.look()) for _ in range(2))
        outcomes = [judge(goal.object_id, goal.position, before, now) for now in (first, second)]
        return second, agreed(*outcomes)


def check_goal(goal: "Goal", sight: Sight) -> None:
    """See that the object is there and free, and that its destination is free.

    Raises:
        RefusalError: It is not; says why.
    """
    if goal.object_id not in sight.object_ids:
        raise RefusalError("the block that is meant cannot be seen any more")
    here = sight.where(goal.object_id)
    others = sight.location[sight.object_ids != goal.object_id]
    if sight.held != goal.object_id and len(_above(here, others)):
        raise RefusalError("another block stands on the one to move; move that one first")
    if goal.position is None:
        return
    there = np.asarray(goal.position)
    aside = np.linalg.norm(others[:, :2] - there[:2], axis=1)
    if np.any((aside < HALF_CELL) & (np.abs(others[:, 2] - there[2]) < board.BLOCK / 2)):
        raise RefusalError("the destination is not free: another block is there")
    if len(_above(there, others)):
        raise RefusalError("the destination cannot be reached: another block stands above it")


def _above(place: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Those of `others` (N, 3) [m] that are above `place` (3,) [m] in its column."""
    aside = np.linalg.norm(others[:, :2] - place[:2], axis=1)
    found: np.ndarray = others[(aside < HALF_CELL) & (others[:, 2] > place[2] + board.BLOCK / 2)]
    return found
