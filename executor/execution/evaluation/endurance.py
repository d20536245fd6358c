"""Commands without a pause in one world: does it stay sound, and does memory stay flat?"""

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from executor.execution.evaluation.case import Expected
from executor.execution.evaluation.verdict import fault_of
from executor.execution.history import KEPT
from executor.executor import Executor
from learning import Knowledge
from teleop import TaskError, random_task
from twin import World, WorldState, board, random_board
from twin.board import nearest_cell
from twin.scene_spec import SceneSpec

UNDONE = 0.1
"""Share of commands that are undone."""
WARM = KEPT + 5
"""Commands after which memory is measured first: libraries are loaded, and all that can be undone is kept, by then."""


@dataclass(frozen=True, slots=True)
class Endurance:
    """How a long session went.

    Attributes:
        commands: Commands given.
        right: How many came out right, by the truth.
        done: How many were reported done.
        false: How many of these were not right.
        undone: How many were undone, all to the state before.
        simulated: Simulated time [s].
        drift: Largest distance of a block from the middle of the cell it should be in, at the end [m].
        memory: Resident memory after the first commands, in the middle and at the end [MB].
        errors: What went wrong in the program itself.
        faults: Sentences that did not come out right, each with the answer and what is wrong.
    """

    commands: int
    right: int
    done: int
    false: int
    undone: int
    simulated: float
    drift: float
    memory: tuple[float, float, float]
    errors: tuple[str, ...]
    faults: tuple[str, ...] = ()

    def figures(self) -> dict[str, float | int]:
        """Flat figures."""
        first, middle, last = self.memory
        return {
            "commands": self.commands,
            "success_rate": self.right / max(1, self.commands),
            "false_success": self.false,
            "undone": self.undone,
            "simulated_minutes": self.simulated / 60.0,
            "drift_mm": 1000 * self.drift,
            "memory_mb_first": first,
            "memory_mb_middle": middle,
            "memory_mb_last": last,
            "crashes": len(self.errors),
        }


def endure(knowledge: Path, minutes: float, seed: int, variety: float, on_minute: Callable[[], None]) -> Endurance:
    """Give commands for so many simulated minutes: each about the world as the last one left it.

    Args:
        knowledge: Knowledge file.
        minutes: Simulated time [min].
        seed: Seed of scene, tasks and noise.
        variety: Probability of each word being a synonym of the plain one.
        on_minute: Called after every simulated minute.
    """
    rng = np.random.default_rng([seed, 11])
    commands = right = done = false = undone = minutes_told = 0
    errors: list[str] = []
    faults: list[str] = []
    memory: list[float] = []
    passed = 0.0
    with World.from_scene(random_board(rng, seed=seed)) as world:
        executor = Executor(world, Knowledge.load(knowledge), rng)
        while passed < 60.0 * minutes:
            asked = _next_task(world, rng, variety)
            if asked is None:
                break
            sentence, expected = asked
            before = world.state()
            try:
                report = executor.execute(sentence)
            except Exception as error:  # a crash is what is looked for
                errors.append(f"{sentence}: {type(error).__name__}: {error}")
                continue
            after = world.state()
            passed += after.time - before.time
            commands += 1
            fault = fault_of(expected, report, before, after)
            right += not fault
            if fault:
                faults.append(f"{sentence}: {report.answer}, {fault}; told: {report.reason}")
            done += report.success
            false += report.success and bool(fault)
            if report.answer.moved and rng.random() < UNDONE:
                executor.undo()
                undone += 1
                if _apart(before, world.state()) > 1e-9:
                    errors.append(f"{sentence}: undone, and the world is not as before")
            if commands >= WARM:
                memory.append(resident())
            while minutes_told < passed / 60.0:
                minutes_told += 1
                on_minute()
        drift = _drift(world.state())
    memory = memory or [resident()]
    marks = (memory[0], memory[len(memory) // 2], memory[-1])
    return Endurance(commands, right, done, false, undone, passed, drift, marks, tuple(errors), tuple(faults))


def resident() -> float:
    """Resident memory of this process [MB]."""
    try:
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE") / 1e6
    except OSError:  # not on Linux: the most that it ever was
        import resource

        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


def _next_task(world: World, rng: np.random.Generator, variety: float) -> tuple[str, Expected] | None:
    """A sentence about the world as it is, and what should come of it."""
    state = world.state()
    if state.held is not None:
        where = next(each for each in state.objects if each.id == state.held).pose_object_in_world.position
        spec = next(each for each in world.spec.objects if each.id == state.held)
        # What hangs beside the board counts to the nearest of its columns, as it does for the learner.
        x, y = (int(each) for each in np.clip(nearest_cell(where)[:2], 0, board.CELLS - 1))
        height = sum(
            nearest_cell(each.pose_object_in_world.position)[:2] == (x, y)
            for each in state.objects
            if each.id != state.held
        )
        return f"drop the {spec.colour} {spec.shape}", Expected(object_id=state.held, cell=(x, y, height))
    try:
        asked = random_task(_as_it_is(world.spec, state), rng, kinds=("move", "take"), variety=variety)
    except TaskError:
        return None
    goal = asked.task.goal
    cell = None if goal is None or asked.kind == "take" else nearest_cell(np.asarray(goal))
    return asked.sentence, Expected(object_id=asked.object_id, cell=cell)


def _as_it_is(spec: SceneSpec, state: WorldState) -> SceneSpec:
    """The scene's specification with every block in the cell where it is now."""
    places = {each.id: nearest_cell(each.pose_object_in_world.position) for each in state.objects}
    objects = tuple(
        each.model_copy(update={"position": tuple(float(v) for v in board.cell_centre(*places[each.id]))})
        for each in spec.objects
    )
    return spec.model_copy(update={"objects": objects, "held": None, "gripper_closed": False})


def _drift(state: WorldState) -> float:
    offsets = [
        each.pose_object_in_world.position - board.cell_centre(*nearest_cell(each.pose_object_in_world.position))
        for each in state.objects
        if each.id != state.held
    ]
    return max((float(np.linalg.norm(offset)) for offset in offsets), default=0.0)


def _apart(one: WorldState, other: WorldState) -> float:
    pairs = zip(one.objects, other.objects, strict=True)
    return max(float(np.abs(a.pose_object_in_world.position - b.pose_object_in_world.position).max()) for a, b in pairs)
