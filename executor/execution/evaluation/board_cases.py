"""New tasks on new boards, and sentences that were not in the demos."""

from collections.abc import Collection
from dataclasses import replace
from pathlib import Path

import numpy as np

from executor.errors import InputError
from executor.execution.answer import Answer
from executor.execution.evaluation.case import Case, Cell, Expected
from executor.execution.evaluation.written_lines import read_lines
from learning.grounding.ngrams import words_of
from twin import random_board
from twin.board import nearest_cell
from twin.scenes import resolve_scene

NEW_SEEDS = 1_000_000
"""Added to the seed, so that no scene of a demo comes back."""
MOST_TRIES = 100


def board_cases(count: int, seed: int, variety: float, heard: Collection[tuple[str, ...]] = ()) -> list[Case]:
    """Make tasks on random boards, each with a sentence that tells which block and where without doubt.

    Args:
        count: How many.
        seed: Seed of scenes, tasks and sentences.
        variety: Probability of each word being a synonym of the plain one.
        heard: Words of the sentences that were learned from: none of them is said again.
    """
    from teleop import random_task

    known = set(heard)
    cases: list[Case] = []
    for number in range(MOST_TRIES * count):
        rng = np.random.default_rng([seed + NEW_SEEDS, number])
        asked = random_task(random_board(rng, seed=seed), rng, variety=variety)
        if words_of(asked.sentence) in known:
            continue
        goal = asked.task.goal
        cell = None if goal is None or asked.kind == "take" else nearest_cell(np.asarray(goal))
        expected = Expected(object_id=asked.object_id, cell=cell)
        cases.append(Case(number, asked.scene, asked.sentence, expected, f"{asked.kind}: {asked.template}"))
        if len(cases) == count:
            return cases
    raise InputError(f"only {len(cases)} of {count} sentences are new: the demos hold nearly all that can be said")


def written_cases(path: Path) -> list[Case]:
    """Read commands that someone else wrote: one a line, columns with tabs between them.

    The columns are the seed of a board scene, the sentence, and, where it is known, what should come of it: the answer
    (`ambiguous`, `impossible`, `unknown-word`), or the id of the object and where it ends (`held`, or a cell `x,y,z`).
    Empty lines and lines that begin with `#` are passed over.

    Raises:
        InputError: A line has another form; names it.
    """

    def made(row: int, fields: list[str]) -> Case:
        return Case(row, resolve_scene("board", int(fields[0])), fields[1], _expected(fields[2:]), "written")

    form = (
        "a seed, a sentence and what should come of it, with tabs between them: an answer, or an object and `held` or "
        "a cell x,y,z"
    )
    return read_lines(path, made, form)


def _expected(fields: list[str]) -> Expected | None:
    fields = [field for field in fields if field]
    if not fields:
        return None
    if len(fields) == 1:
        return Expected(answer=Answer(fields[0]))
    if fields[1] == "held":
        return Expected(object_id=int(fields[0]))
    x, y, z = (int(value) for value in fields[1].split(","))
    cell: Cell = (x, y, z)
    return replace(Expected(), object_id=int(fields[0]), cell=cell)
