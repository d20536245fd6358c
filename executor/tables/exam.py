"""New commands at a table carried out and judged by physics."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from executor.actions.witness import WitnessedWorld
from executor.collection import in_processes
from executor.execution.answer import OnAmbiguous
from executor.execution.evaluation.case import Suite
from executor.executor import Executor
from executor.tables.commands import Answered, Heard, TableCommand, counter_command, tabletop_command
from executor.tables.suite_commands import suite_command
from executor.tables.table_doer import TableDoer
from executor.tables.written_commands import written_commands

if TYPE_CHECKING:
    from learning import Knowledge

MAKERS: Mapping[str, Callable[[np.random.Generator, str, Heard], TableCommand]] = {
    "baxter": tabletop_command,
    "mico_segway": counter_command,
}
"""Who makes up commands for each robot."""


@dataclass(frozen=True, slots=True)
class TableTrial:
    """One command to make up and carry out.

    Attributes:
        robot: Which robot does it.
        knowledge: File of what was learned.
        seed: Seed of all commands.
        number: Number of the command.
        language: Language of the sentence.
        known: Sentences that were heard before.
        suite: Of which suite the command is; None for one that can be carried out.
        on_ambiguous: What to do where several things fit.
        clear: Whether to put aside what is in the way.
        written: File of commands that somebody wrote, of which this is the one of that number; None for others.
    """

    robot: str
    knowledge: str
    seed: int
    number: int
    language: str
    known: Heard = frozenset()
    suite: Suite | None = None
    on_ambiguous: OnAmbiguous = OnAmbiguous.ASK
    clear: bool = False
    written: Path | None = None


@lru_cache(maxsize=1)
def _learned(path: str) -> "Knowledge":
    """Knowledge, read once a process."""
    from learning import Knowledge

    return Knowledge.load(path)


def answer(trial: TableTrial) -> Answered:
    """Make up a command, carry it out, and judge what came of it; equal trials go alike."""
    rng = np.random.default_rng([trial.seed, trial.number, *trial.robot.encode()])
    if trial.written is not None:
        command = written_commands(trial.robot, trial.written)[trial.number]
    elif trial.suite is None:
        command = MAKERS[trial.robot](rng, trial.language, trial.known)
    else:
        command = suite_command(trial.robot, trial.suite, trial.number, rng, trial.language, trial.known)
    return carried_out(command, trial, rng)


def carried_out(command: TableCommand, trial: TableTrial, rng: np.random.Generator) -> Answered:
    """Carry out a command in its scene, and judge what came of it."""
    with WitnessedWorld(command.scene) as world:
        before = world.state()
        executor = Executor(world, _learned(trial.knowledge), rng, on_ambiguous=trial.on_ambiguous, clear=trial.clear)
        doer = executor.doer
        assert isinstance(doer, TableDoer)
        doer.on_start = world.watch
        doer.look()  # a robot that waits for a command looks about; it holds until something moves
        begun = perf_counter()
        report = executor.execute(command.sentence)
        wall = perf_counter() - begun
        doer.close()
        moved = world.time > before.time
        fault = None if command.judge is None else command.judge(world, before)
    if command.expected is not None and not fault and report.answer is not command.expected:
        fault = f"answered {report.answer}, not {command.expected}"
    return Answered(trial.number, command.action, command.thing, command.sentence, report, fault, moved, wall)


def answers(
    trials: Sequence[TableTrial], jobs: int = 0, on_answer: Callable[[], None] = lambda: None
) -> list[Answered]:
    """Make up and carry out commands.

    Args:
        trials: Which.
        jobs: Processes; 0 takes one a core.
        on_answer: Called after every command.
    """
    done = sorted(in_processes(answer, trials, jobs, on_answer), key=lambda pair: pair[0])
    return [each for _, each in done]
