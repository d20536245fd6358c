"""What an execution reports: what was understood, what was done, and whether it came out right."""

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from executor.execution.answer import Answer
from executor.execution.spelling import Spelling, Suggestion, suggestions
from executor.execution.understood import Option, Referent, Understood, offer
from learning.grammar.rcl import RclNode

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Protocol

    from learning.interpretation import Goal

    class Plan(Protocol):
        """Any motion plan, of the board's arm or of another."""

        @property
        def steps(self) -> Sequence[object]:
            """What is done, in order."""

        def lines(self) -> Sequence[str]:
            """One line a step, for people."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a second look at the scene showed.

    Attributes:
        reached: Whether the object is where it should be.
        error: Distance of the object from its goal, seen from above [m]; None where it should be held.
        disturbed: Track numbers of other objects that moved half a cell or more.
        explanation: The same in plain words.
        doubt: Why the look cannot be trusted; empty when it can.
    """

    reached: bool
    error: float | None
    disturbed: tuple[int, ...]
    explanation: str
    doubt: str = ""

    @property
    def right(self) -> bool:
        """Whether the goal is reached and nothing else was moved, as far as can be told."""
        return self.reached and not self.disturbed and not self.doubt


@dataclass(frozen=True, slots=True)
class ExecutionReport:
    """What happened to one command.

    Attributes:
        sentence: What was said.
        answer: Which kind of answer this is.
        explanation: What was understood, which words were not, how it went or why it was refused.
        reason: Only the last of that: how it went or why not.
        words: The words as they were taken; positions of tree and referents count them from 1.
        tree: The RCL tree, None where nothing was understood.
        referents: What the words speak of, with track numbers.
        options: What to choose between, where the answer is a question.
        unknown: Words that were never heard, or not understood yet.
        spelling: Words that were never heard and look like heard ones, with what they were taken as or may be.
        goal: The last goal that was tried, or None.
        goals: All goals of the sentence, in order.
        plan: The last motion plan, or None.
        outcome: What the last look showed, or None.
        attempts: How often an object was reached for (a grasp that slipped is tried once more).
        cleared: Track numbers of what was moved out of the way first.
        durations: Part (`perceive`, `interpret`, `plan`, `move`) to wall-clock time, `to_motion` from the call to the
            first step of the arm, and `simulated` motion [s].
        steps: Reports of the steps, where there are several.
    """

    sentence: str
    answer: Answer
    explanation: str
    reason: str = ""
    words: tuple[str, ...] = ()
    tree: RclNode | None = None
    referents: tuple[Referent, ...] = ()
    options: tuple[Option, ...] = ()
    unknown: tuple[str, ...] = ()
    spelling: tuple[Spelling, ...] = ()
    goal: "Goal | None" = None
    goals: "tuple[Goal, ...]" = ()
    plan: "Plan | None" = None
    outcome: Outcome | None = None
    attempts: int = 0
    cleared: tuple[int, ...] = ()
    durations: dict[str, float] = field(default_factory=dict)
    steps: "tuple[ExecutionReport, ...]" = ()

    @property
    def success(self) -> bool:
        """Whether the scene is as the sentence says, as far as looks tell; or there is a plan, if that was asked."""
        return self.answer.good

    @property
    def refused(self) -> bool:
        """Whether nothing was moved, because the sentence or the scene does not allow it."""
        return not self.answer.moved and not self.answer.good

    @property
    def suggested(self) -> tuple[Suggestion, ...]:
        """What may have been meant, where a word was never heard and looks like several that were."""
        return suggestions(self.sentence, self.spelling) if self.answer is Answer.UNKNOWN_WORD else ()

    def text(self) -> str:
        """The whole report for people: tree, referents, plan, and how it went."""
        if self.steps:
            return "\n".join([each.text() for each in self.steps] + [f"{self.answer}: {self.reason}"])
        lines = [f"“{self.sentence}”"]
        if self.tree is not None:
            lines.append(self.tree.draw(self.words, 1))
        for each in self.referents:
            nothing = "a place" if each.role == "destination" else "nothing here"
            meant = f"object {' or '.join(map(str, each.things))}" if each.things else nothing
            lines.append(f"  {each.role} “{each.words}”: {meant}")
        if self.plan is not None:
            lines += [f"  {number}. {line}" for number, line in enumerate(self.plan.lines(), start=1)]
        return "\n".join([*lines, f"{self.answer}: {self.reason}"])

    def to_dict(self) -> dict[str, object]:
        """Return the report as plain values for JSON; lengths in metres, times in seconds."""
        goal = None
        if self.goal is not None:
            position = None if self.goal.position is None else [round(float(v), 4) for v in self.goal.position]
            goal = {"object_id": int(self.goal.object_id), "position": position}
        return {
            "sentence": self.sentence,
            "answer": str(self.answer),
            "success": self.success,
            "refused": self.refused,
            "explanation": self.explanation,
            "reason": self.reason,
            "tree": None if self.tree is None else _node(self.tree, self.words),
            "referents": [
                {"role": e.role, "words": e.words, "first": e.first, "last": e.last, "things": list(e.things)}
                for e in self.referents
            ],
            "options": [{"thing": each.thing, "name": each.name} for each in self.options],
            "unknown": list(self.unknown),
            "spelling": [each.to_dict() for each in self.spelling],
            "goal": goal,
            "plan": list(self.plan.lines()) if self.plan else None,
            "attempts": self.attempts,
            "cleared": list(self.cleared),
            "disturbed": list(self.outcome.disturbed) if self.outcome else [],
            "durations": {part: round(seconds, 4) for part, seconds in self.durations.items()},
            "steps": [each.to_dict() for each in self.steps],
        }


def report_of(understood: Understood, sentence: str) -> ExecutionReport:
    """The report of a step before anything is done: with its answer where it is not acted on."""
    return ExecutionReport(
        sentence,
        understood.answer or Answer.REFUSED,
        joined(understood.heard, understood.reason),
        understood.reason,
        words=understood.words,
        tree=understood.tree,
        referents=understood.referents,
        options=understood.options,
        unknown=understood.unknown,
        goal=understood.goals[0] if understood.goals else None,
        goals=understood.goals,
    )


def answer_of(outcome: Outcome | None) -> Answer:
    """How a command is answered that came out so."""
    if outcome is None or outcome.doubt:
        return Answer.UNCERTAIN
    return Answer.DONE if outcome.right else Answer.FAILED


def told(report: ExecutionReport, answer: Answer, reason: str) -> ExecutionReport:
    """A report with how it ended, and why."""
    return replace(report, answer=answer, reason=reason, explanation=joined(report.explanation, reason))


def spelt(report: ExecutionReport, spelling: "tuple[Spelling, ...]") -> ExecutionReport:
    """A report that says how words that were never heard were taken, or asks what they may be."""
    if not spelling:
        return report
    taken = joined(*(each.told() for each in spelling if each.taken is not None))
    report = replace(report, spelling=spelling)
    reason = report.reason
    if report.answer is Answer.UNKNOWN_WORD:
        asked = [each for each in spelling if each.taken is None]
        strange = tuple(word for word in report.unknown if word not in {each.word for each in asked})
        otherwise = offer(strange) if strange else "if not, show me: record a demo and say it"
        reason = joined(*(each.told() for each in asked), otherwise) if asked else reason
    return replace(report, reason=joined(taken, reason), explanation=joined(taken, report.explanation))


def joined(*parts: str) -> str:
    """Join explanations with semicolons, without their full stops; what was said once is not said again."""
    return "; ".join(dict.fromkeys(part.strip().rstrip(".") for part in parts if part.strip()))


def _node(node: RclNode, words: tuple[str, ...]) -> dict[str, object]:
    """A tree as plain values."""
    found: dict[str, object] = {"label": node.label, "first": node.first, "last": node.last}
    if node.concept is not None:
        found |= {"concept": str(node.concept), "words": " ".join(words[node.first - 1 : node.last])}
    if node.children:
        found["children"] = [_node(child, words) for child in node.children]
    return found
