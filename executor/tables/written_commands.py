"""Commands at a table that somebody else wrote, in scenes made from seeds."""

from collections.abc import Mapping
from pathlib import Path
from typing import get_args

import numpy as np

from executor.actions.success import RULES, fault_of
from executor.actions.things import pose_of
from executor.actions.witness import WitnessedWorld
from executor.collections.performance import PlannedDemo
from executor.collections.table_goals import Goal, put_rule
from executor.execution.answer import Answer
from executor.execution.evaluation.written_lines import read_lines
from executor.follow import wait
from executor.tables.commands import LOOKS, SETTLE, Judge, TableCommand, by_rule
from executor.tables.suite_commands import answered_unmoved
from teleop.annotators import Column, Destination, Relation, Row, TableAction
from twin import SceneSpec, WorldState
from twin.scenes import resolve_scene

SCENES: Mapping[str, str] = {"baxter": "tabletop", "mico_segway": "ordering"}
"""Which random scene a seed makes for each robot."""
UNMOVED = (Answer.AMBIGUOUS, Answer.IMPOSSIBLE, Answer.UNKNOWN_WORD, Answer.REFUSED)
FORM = (
    "a seed, a sentence and what should come of it, with tabs between them: an answer, or an object's id and `held`, "
    "a part of the table such as `top left`, a relation and an id such as `in 2`, or an action such as `press`"
)


def written_commands(robot: str, path: Path) -> list[TableCommand]:
    """Read commands: one a line, columns with tabs between them.

    The columns are the seed of a scene, the sentence, and, where it is known, what should come of it: the answer, or
    the id of a thing and where it ends. Empty lines and lines that begin with `#` are passed over.

    Args:
        robot: `baxter` or `mico_segway`; scenes are made for it.
        path: File with the commands.

    Raises:
        InputError: The file cannot be read or a line has another form; names it.
    """

    def made(_: int, fields: list[str]) -> TableCommand:
        scene = resolve_scene(SCENES[robot], int(fields[0]))
        return _command(scene, fields[1], [field for field in fields[2:] if field])

    return read_lines(path, made, FORM)


def _command(scene: SceneSpec, sentence: str, fields: list[str]) -> TableCommand:
    """A command, with its judge where somebody says what should come of it."""
    if not fields:
        return TableCommand(scene, sentence, "written", -1, "", None)
    if len(fields) == 1:
        expected = Answer(fields[0])
        if expected not in UNMOVED:
            raise ValueError(f"{expected} is no answer without a motion")
        return TableCommand(scene, sentence, f"written: {expected}", -1, "", answered_unmoved, expected)
    target = next(each for each in scene.objects if each.id == int(fields[0]))
    words = fields[1].split()
    if words[0] in RULES and words[0] != "move":
        judge = _by_action(words[0])
    elif words == ["held"]:
        judge = _by_place(target.id, None)
    else:
        judge = _by_place(target.id, _destination(words, scene))
    return TableCommand(scene, sentence, f"written: {words[0]}", target.id, str(target.model), judge)


def _destination(words: list[str], scene: SceneSpec) -> Destination:
    """A part of the table, or a relation to another thing."""
    first, second = words
    if first in get_args(Row) and second in get_args(Column):
        row: Row = next(each for each in get_args(Row) if each == first)
        column: Column = next(each for each in get_args(Column) if each == second)
        return Destination(place=(row, column))
    relation: Relation = next(each for each in get_args(Relation) if each == first)
    ground = next(each for each in scene.objects if each.id == int(second))
    return Destination(relation=relation, reference=ground.id)


def _by_place(target: int, destination: Destination | None) -> Judge:
    """A judge of where a thing ends; None: in the hand."""

    def judge(world: WitnessedWorld, before: WorldState) -> str:
        here = np.asarray(pose_of(before, target).position)
        goal = None if destination is None else Goal(destination, here)
        action: TableAction = "pick up" if goal is None else "move"
        return by_rule(put_rule(world, action, target, goal), PlannedDemo("", target, ()))(world, before)

    return judge


def _by_action(action: str) -> Judge:
    """A judge of one of the counter's actions."""

    def judge(world: WitnessedWorld, before: WorldState) -> str:
        wait(world, SETTLE * LOOKS, world.commanded_openings)
        evidence = world.evidence()
        return "not begun: nothing was touched" if evidence is None else fault_of(action, evidence, None)

    return judge
