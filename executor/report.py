"""What an execution reports: what was understood, what was done, and whether it came out right."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from executor.motion_plan import MotionPlan

if TYPE_CHECKING:
    from learning.interpretation import Goal


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a second look at the scene showed.

    Attributes:
        reached: Whether the object is where it should be.
        error: Distance of the object from its goal, seen from above [m]; None where it should be held.
        disturbed: Track numbers of other objects that moved half a cell or more.
        explanation: The same in plain words.
    """

    reached: bool
    error: float | None
    disturbed: tuple[int, ...]
    explanation: str

    @property
    def right(self) -> bool:
        """Whether the goal is reached and nothing else was moved."""
        return self.reached and not self.disturbed


@dataclass(frozen=True, slots=True)
class ExecutionReport:
    """What happened to one sentence.

    Attributes:
        sentence: What was said.
        success: Whether the scene now is as the sentence says, as far as a look can tell. With `plan_only`, whether
            there is a plan.
        refused: Whether nothing was moved, because the sentence or the scene does not allow it.
        explanation: What was understood, which words were not, how it went or why it was refused.
        goal: The last goal that was tried, or None.
        goals: All goals of the sentence, in order.
        plan: The last motion plan, or None.
        outcome: What the last look showed, or None.
        attempts: How often the object was reached for (a grasp that slipped is tried once more).
        durations: Part (`perceive`, `interpret`, `plan`, `move`) to wall-clock time, and `simulated` motion [s].
    """

    sentence: str
    success: bool
    refused: bool
    explanation: str
    goal: "Goal | None" = None
    goals: "tuple[Goal, ...]" = ()
    plan: MotionPlan | None = None
    outcome: Outcome | None = None
    attempts: int = 0
    durations: dict[str, float] = field(default_factory=dict)

    def to_dict(self) -> dict[str, object]:
        """Return the report as plain values for JSON; lengths in metres, times in seconds."""
        goal = None
        if self.goal is not None:
            position = None if self.goal.position is None else [round(float(v), 4) for v in self.goal.position]
            goal = {"object_id": int(self.goal.object_id), "position": position}
        return {
            "sentence": self.sentence,
            "success": self.success,
            "refused": self.refused,
            "explanation": self.explanation,
            "goal": goal,
            "plan": list(self.plan.lines()) if self.plan else None,
            "attempts": self.attempts,
            "disturbed": list(self.outcome.disturbed) if self.outcome else [],
            "durations": {part: round(seconds, 4) for part, seconds in self.durations.items()},
        }
