"""New commands at a table carried out and judged by physics."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from executor.actions.witness import WitnessedWorld
from executor.collection import in_processes
from executor.executor import Executor
from executor.tables.commands import Answered, Heard, TableCommand, counter_command, tabletop_command
from executor.tables.table_doer import TableDoer

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
    """

    robot: str
    knowledge: str
    seed: int
    number: int
    language: str
    known: Heard = frozenset()


@lru_cache(maxsize=1)
def _learned(path: str) -> "Knowledge":
    """Knowledge, read once a process."""
    from learning import Knowledge

    return Knowledge.load(path)


def answer(trial: TableTrial) -> Answered:
    """Make up a command, carry it out, and judge what came of it; equal trials go alike."""
    rng = np.random.default_rng([trial.seed, trial.number, *trial.robot.encode()])
    command = MAKERS[trial.robot](rng, trial.language, trial.known)
    with WitnessedWorld(command.scene) as world:
        before = world.state()
        executor = Executor(world, _learned(trial.knowledge), rng)
        doer = executor.doer
        assert isinstance(doer, TableDoer)
        doer.on_start = world.watch
        doer.look()  # a robot that waits for a command looks about; it holds until something moves
        report = executor.execute(command.sentence)
        doer.close()
        fault = command.judge(world, before)
    return Answered(trial.number, command.action, command.thing, command.sentence, report, fault)


def answers(
    robot: str,
    knowledge: str,
    commands: int,
    seed: int,
    *,
    language: str = "en",
    known: Heard = frozenset(),
    jobs: int = 0,
    on_answer: Callable[[], None] = lambda: None,
) -> list[Answered]:
    """Make up and carry out so many commands.

    Args:
        robot: One of `MAKERS`.
        knowledge: File of what was learned.
        commands: How many.
        seed: Seed of all of them.
        language: Language of the sentences.
        known: Sentences that were heard before.
        jobs: Processes; 0 takes one a core.
        on_answer: Called after every command.
    """
    trials = [TableTrial(robot, knowledge, seed, number, language, known) for number in range(commands)]
    done = sorted(in_processes(answer, trials, jobs, on_answer), key=lambda pair: pair[0])
    return [each for _, each in done]
