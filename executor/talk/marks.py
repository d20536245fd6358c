"""What is marked in the picture for a command: the things that its words speak of, and where they would go."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from executor.execution.answer import Answer

if TYPE_CHECKING:
    from executor.execution.doer import Doer
    from executor.report import ExecutionReport

MarkRole = Literal["entity", "destination", "option", "goal", "blocked"]
GOAL_SIZE = 0.02
"""Half of the width of a mark where nothing is yet [m]."""


@dataclass(frozen=True, slots=True)
class Mark:
    """One mark.

    Attributes:
        role: Why it is there.
        label: What stands beside it.
        position: Centre in the world [m].
        radius: Half of the width of what it is around [m].
    """

    role: MarkRole
    label: str
    position: tuple[float, float, float]
    radius: float


def marks_of(report: "ExecutionReport", doer: "Doer[Any]", view: object) -> list[Mark]:
    """Marks for a report.

    Args:
        report: What was understood.
        doer: Who saw the scene.
        view: How it looked.
    """
    found: dict[tuple[float, float, float], Mark] = {}
    for mark in _all(report, doer, view):
        found.setdefault(mark.position, mark)  # what is spoken of twice is marked once
    return list(found.values())


def _all(report: "ExecutionReport", doer: "Doer[Any]", view: object) -> Iterator[Mark]:
    if report.answer is Answer.AMBIGUOUS:
        for number, option in enumerate(report.options, start=1):
            yield from _around(doer, view, option.thing, "option", str(number))
        return
    for step in report.steps or (report,):
        for referent in step.referents:
            role: MarkRole = "entity" if referent.role == "entity" else "destination"
            for thing in referent.things:
                yield from _around(doer, view, thing, role, referent.words)
        for goal in step.goals:
            if goal.position is not None:
                x, y, z = (round(float(value), 4) for value in goal.position)
                yield Mark("goal", "here", (x, y, z), GOAL_SIZE)


def _around(doer: "Doer[Any]", view: object, thing: int, role: MarkRole, label: str) -> Iterator[Mark]:
    where = doer.where(view, thing)
    if where is not None:
        x, y, z = (round(float(value), 4) for value in where[0])
        yield Mark(role, label, (x, y, z), round(where[1], 4))
