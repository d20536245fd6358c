"""A command carried out, and judged by the true state of the world."""

from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from time import perf_counter

import numpy as np

from executor.execution.answer import Answer
from executor.execution.evaluation.case import Case, Expected
from executor.executor import Executor
from executor.report import ExecutionReport
from learning import Knowledge
from twin import World, WorldState, board

HALF_CELL = board.CELL / 2


@dataclass(frozen=True, slots=True)
class Job:
    """A case for a process.

    Attributes:
        case: The command.
        knowledge: Knowledge file to use.
        seed: Seed of the noise of looking.
        on_ambiguous: What to do where several things fit.
        clear: Whether to put aside what is in the way.
    """

    case: Case
    knowledge: Path
    seed: int
    on_ambiguous: str = "ask"
    clear: bool = False


@dataclass(frozen=True, slots=True)
class Verdict:
    """How a case went.

    Attributes:
        number: Which case.
        sentence: What was said.
        kind: What kind of command it is.
        answer: How it was answered.
        right: Whether that is right, by the truth; None where nobody knows what should have come of it.
        fault: What is wrong; empty when right.
        cause: The fault in a word or two, for counting.
        moved: Whether the arm moved.
        explanation: What was reported.
        durations: See `ExecutionReport`.
        wall: Time that it took, without building the world [s].
    """

    number: int
    sentence: str
    kind: str
    answer: Answer
    right: bool | None
    fault: str
    cause: str
    moved: bool
    explanation: str
    durations: dict[str, float] = field(default_factory=dict)
    wall: float = 0.0

    def to_dict(self) -> dict[str, object]:
        """Plain values."""
        return {
            "number": self.number,
            "sentence": self.sentence,
            "kind": self.kind,
            "answer": str(self.answer),
            "cause": self.cause,
            "fault": self.fault,
            "explanation": self.explanation,
        }


def run_case(job: Job) -> Verdict:
    """Carry out a command in its scene, and judge what comes of it by the true state of the world."""
    case = job.case
    knowledge = _knowledge(job.knowledge)
    with World.from_scene(case.scene) as world:
        before = world.state()
        rng = np.random.default_rng([job.seed, case.number, 1])
        executor = Executor(world, knowledge, rng, on_ambiguous=job.on_ambiguous, clear=job.clear)
        begun = perf_counter()
        report = executor.execute(case.sentence)
        wall = perf_counter() - begun
        after = world.state()
    fault = "" if case.expected is None else fault_of(case.expected, report, before, after)
    return Verdict(
        case.number,
        case.sentence,
        case.kind,
        report.answer,
        None if case.expected is None else not fault,
        fault,
        _cause(case.expected, report, fault) if fault else "",
        after.time > before.time,
        report.explanation,
        report.durations,
        wall,
    )


def fault_of(expected: Expected, report: ExecutionReport, before: WorldState, after: WorldState) -> str:
    """What is wrong with the answer or the true state after a command, or nothing."""
    if expected.answer is not None:
        if after.time > before.time:
            return f"the arm moved, and should have answered {expected.answer}"
        return "" if report.answer is expected.answer else f"answered {report.answer}, not {expected.answer}"
    start, end = _places(before), _places(after)
    faults = []
    if expected.cell is None:
        if after.held != expected.object_id:
            faults.append("the block is not in the gripper")
    elif after.held is not None:
        faults.append("a block is still in the gripper")
    for number, place in end.items():
        mine = number == expected.object_id
        if mine and expected.cell is None:
            continue
        should = board.cell_centre(*expected.cell) if mine and expected.cell is not None else start[number]
        offset = place - should
        aside = np.abs(offset[:2]).max() if expected.strict else np.linalg.norm(offset[:2])
        if aside > HALF_CELL or abs(offset[2]) > board.BLOCK / 2:
            who = "the block" if mine else f"block {number}"
            faults.append(f"{who} is {1000 * float(np.linalg.norm(offset)):.0f} mm from its place")
    return "; ".join(faults)


def _places(state: WorldState) -> dict[int, np.ndarray]:
    return {each.id: each.pose_object_in_world.position for each in state.objects}


def _cause(expected: Expected | None, report: ExecutionReport, fault: str) -> str:
    """A fault in a word or two."""
    if expected is None or expected.answer is not None:
        return f"answered {report.answer}"
    if not report.answer.moved:
        return f"answered {report.answer}"
    goal = report.goal
    if goal is None or goal.object_id != expected.object_id:
        return "another block was meant"
    if (goal.position is None) != (expected.cell is None):
        return "another action was meant"
    if goal.position is not None and expected.cell is not None:
        offset = np.abs(np.asarray(goal.position) - board.cell_centre(*expected.cell))
        if offset[:2].max() > HALF_CELL or offset[2] > board.BLOCK / 2:
            return "another place was meant"
    return f"motion ({report.answer})"


@lru_cache(maxsize=2)
def _knowledge(path: Path) -> Knowledge:
    return Knowledge.load(path)
