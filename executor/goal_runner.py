"""One goal carried out: look, plan, move, look again; once more if the grasp slipped."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from executor.errors import RefusalError
from executor.motion import Motion
from executor.motion_plan import MotionPlan
from executor.outcome import HALF_CELL, judge
from executor.planner import plan_motion
from executor.report import Outcome
from executor.sight import Sight
from learning.perception import observe_world
from twin import board

if TYPE_CHECKING:
    from learning.interpretation import Goal
    from learning.perception import Observation
    from twin import World

ATTEMPTS = 2
"""How often an object is reached for: a grasp that slipped is tried once more."""


@dataclass(slots=True)
class Stopwatch:
    """Wall-clock time spent on each part of the work [s]."""

    seconds: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def part(self, name: str) -> Iterator[None]:
        """Add the time that the body takes to a part."""
        begun = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - begun


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

    def look(self) -> "Observation":
        """Observe the world as it stands now."""
        with self.stopwatch.part("perceive"):
            return observe_world(self.world.state(), self.world.spec, self.rng)

    def plan(self, goal: "Goal", sight: Sight) -> MotionPlan:
        """Plan a goal in the scene that was seen.

        Raises:
            RefusalError: The goal cannot be carried out; says why.
        """
        with self.stopwatch.part("plan"):
            check_goal(goal, sight)
            plan = plan_motion(goal.object_id, goal.position, goal.action, sight, board.BLOCK)
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
            with self.stopwatch.part("move"):
                begun = self.world.time
                self.motion.run(plan)
            simulated = self.stopwatch.seconds.get("simulated", 0.0)
            self.stopwatch.seconds["simulated"] = simulated + self.world.time - begun
            now = Sight.of(self.look())
            outcome = judge(goal.object_id, goal.position, before, now)
            if outcome.reached or attempt == ATTEMPTS:
                return Run(plan, outcome, attempt, note)
            try:
                plan = self.plan(goal, now)
            except RefusalError as refusal:
                return Run(plan, outcome, attempt, f"a second try is not possible: {refusal}")
            attempt += 1
            note = "the first grasp slipped, so I tried once more"


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
