"""Trying what was learned: a new scene, a new sentence, and the truth as the judge."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from executor.executor import Executor
from executor.outcome import HALF_CELL
from learning import Knowledge
from twin import World, board, random_board

if TYPE_CHECKING:
    from executor.picture import Picture
    from executor.report import ExecutionReport
    from teleop import DescribedTask
    from twin import JointCommand, WorldState

FRAME = 0.2
"""Simulated time between two views of a film [s]."""


@dataclass(frozen=True, slots=True)
class Trial:
    """One new command.

    Attributes:
        seed: Seed of the trials.
        number: Number of this one; scene and sentence follow from both.
        knowledge: Knowledge file to use.
        robot: Robot to use instead of the board arm.
        variety: Probability of each word being a synonym of the plain one.
        view_size: Width and height of views before and after; None takes none.
        filmed: Whether to take views all the way.
    """

    seed: int
    number: int
    knowledge: Path
    robot: str | None
    variety: float
    view_size: tuple[int, int] | None = None
    filmed: bool = False


@dataclass(frozen=True, slots=True)
class Verdict:
    """How a trial went.

    Attributes:
        number: Which trial.
        sentence: What was said.
        kind: What kind of task was meant.
        right: Whether the right object truly is within half a cell of the right place (or held), and nothing else
            was displaced by half a cell.
        fault: What is wrong with the true state; empty when right.
        report: What the executor reported.
        views: Views before, on the way if filmed, and after.
    """

    number: int
    sentence: str
    kind: str
    right: bool
    fault: str
    report: "ExecutionReport"
    views: tuple["Picture", ...]


class FilmedWorld(World):
    """A world that keeps a view of itself from time to time, once `size` is set."""

    size: tuple[int, int] | None = None
    views: tuple["Picture", ...] = ()

    def step(self, command: "JointCommand") -> None:
        """Simulate one step; look at the world every `FRAME`."""
        super().step(command)
        if self.size and round(self.time / self.DT) % round(FRAME / self.DT) == 0:
            self.views = (*self.views, self.render(*self.size))


def new_task(seed: int, number: int, variety: float) -> "DescribedTask":
    """Make a task with a sentence on a board of its own; equal for equal seed and number."""
    from teleop import random_task

    rng = np.random.default_rng([seed, number])
    return random_task(random_board(rng, seed=seed), rng, variety=variety)


def run_trial(trial: Trial) -> Verdict:
    """Say a new sentence in a new scene, and judge what comes of it by the true state of the world."""
    asked = new_task(trial.seed, trial.number, trial.variety)
    knowledge = Knowledge.load(trial.knowledge)
    with FilmedWorld.from_scene(asked.scene, robot=trial.robot) as world:
        views: list[Picture] = [world.render(*trial.view_size)] if trial.view_size else []
        before = world.state()
        if trial.filmed:
            world.size = trial.view_size
        executor = Executor(world, knowledge, np.random.default_rng([trial.seed, trial.number, 1]))
        report = executor.execute(asked.sentence)
        fault = fault_of(asked, before, world.state())
        views += world.views
        if trial.view_size:
            views.append(world.render(*trial.view_size))
    return Verdict(trial.number, asked.sentence, asked.kind, not fault, fault, report, tuple(views))


def fault_of(asked: "DescribedTask", before: "WorldState", after: "WorldState") -> str:
    """What is wrong with the true state after a task, or nothing."""
    start = {each.id: each.pose_object_in_world.position for each in before.objects}
    end = {each.id: each.pose_object_in_world.position for each in after.objects}
    faults = []
    if asked.kind == "take":
        if after.held != asked.object_id:
            faults.append("the block is not in the gripper")
    else:
        goal = np.asarray(asked.task.goal)
        offset = end[asked.object_id] - goal
        if np.linalg.norm(offset[:2]) > HALF_CELL or abs(offset[2]) > board.BLOCK / 2:
            faults.append(f"the block is {1000 * float(np.linalg.norm(offset)):.0f} mm from its place")
        if after.held is not None:
            faults.append("a block is still in the gripper")
    displaced = sum(
        float(np.linalg.norm(end[number] - start[number])) > HALF_CELL for number in start if number != asked.object_id
    )
    if displaced:
        faults.append(f"{displaced} other blocks were displaced")
    return "; ".join(faults)
