"""A plan in words for people who see the robot for the first time."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from executor.motion_plan import MoveTool

if TYPE_CHECKING:
    from executor.report import ExecutionReport

_PURPOSES = {
    "approach": "go above it",
    "descend": "go down to it",
    "lift": "lift it",
    "carry": "carry it above its place",
    "lower": "lower it to its place",
    "retreat": "draw the hand back",
}


@dataclass(frozen=True, slots=True)
class PlanLine:
    """One line of a plan.

    Attributes:
        text: What is done, in plain words.
        heading: Whether it only says which learned action follows, with what and where to.
    """

    text: str
    heading: bool = False


def line_of(step: object) -> PlanLine:
    """A step of a plan in words."""
    return PlanLine(_PURPOSES[step.purpose] if isinstance(step, MoveTool) else str(step))


def plan_lines(report: "ExecutionReport") -> tuple[PlanLine, ...]:
    """The plans of all steps of a command: the learned action with its things, and what the hand does."""
    lines: list[PlanLine] = []
    for step in report.steps or (report,):
        if step.plan is not None:
            lines.append(_heading(step))
            for line in map(line_of, step.plan.steps):
                if line != lines[-1]:  # a way in two pieces is one thing to do
                    lines.append(line)
    return tuple(lines)


def _heading(step: "ExecutionReport") -> PlanLine:
    nodes = () if step.tree is None else tuple(step.tree.nodes())
    actions = [str(node.concept) for node in nodes if node.label == "action" and node.concept is not None]
    said = [f"“{referent.words}”" for referent in step.referents if referent.role == "entity"]
    to = [f"“{referent.words}”" for referent in step.referents if referent.role == "destination"]
    parts = [
        actions[0] if actions else "action",
        *(["with " + said[0]] if said else []),
        *(["to " + to[0]] if to else []),
    ]
    return PlanLine(" ".join(parts), heading=True)
