"""Steps on the board: seen through noise, understood, and carried out by the arm of three joints."""

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from executor.actions.carrying import carrying_action
from executor.errors import RefusalError
from executor.execution.answer import Answer, OnAmbiguous
from executor.execution.board_understanding import BoardUnderstanding, BoardView
from executor.execution.clearing import put_aside
from executor.execution.doer import Doer
from executor.execution.marking import Deed, unlearn
from executor.execution.understood import Understood
from executor.goal_runner import GoalRunner
from executor.report import ExecutionReport, answer_of, joined, report_of, told
from executor.sight import Sight
from learning.concept_id import ACTION_SPACE
from learning.grammar.arrangement import Arrangement
from learning.perception import percept_of
from robots.pose import FloatArray
from twin import board

if TYPE_CHECKING:
    from learning import Knowledge
    from learning.perception import Observation
    from twin import World

ACTS = 0.3
"""A word may name an action when Φ gives all actions together at least this."""
JOINS = 0.7
"""A word means nothing by itself when it was passed over in at least this share of its uses."""
IN_THE_HAND = 8.0
"""Height at which a held block is imagined, in blocks: above all that stands."""


class BoardDoer:
    """Understands and carries out steps on the board.

    Args:
        world: The world.
        knowledge: What was learned.
        rng: Source of the noise of looking.
        on_ambiguous: What to do where several things fit.
    """

    def __init__(
        self,
        world: "World",
        knowledge: "Knowledge",
        rng: np.random.Generator,
        on_ambiguous: OnAmbiguous = OnAmbiguous.ASK,
    ) -> None:
        self.knowledge = knowledge
        self.runner = GoalRunner(world, rng)
        self.stopwatch = self.runner.stopwatch
        self.understanding = BoardUnderstanding(knowledge, on_ambiguous)
        self.on_progress: Callable[[object], None] = lambda step: None
        self.runner.motion.on_step = lambda step: self.on_progress(step)

    def look(self) -> BoardView:
        """Look at the board."""
        observation = self.runner.look()
        with self.stopwatch.part("perceive"):
            return BoardView(observation, percept_of(observation, self.knowledge.spaces))

    def understand(
        self, words: tuple[str, ...], view: BoardView, last: int | None, choice: int | None = None
    ) -> Understood:
        """Understand one step; see `Doer`."""
        with self.stopwatch.part("interpret"):
            return self.understanding.understand(words, view, last, choice)

    def imagine(self, view: BoardView, understood: Understood) -> BoardView:
        """The board after a step, as if all went well."""
        observation = view.observation
        for goal in understood.goals:
            observation = _moved(observation, goal.object_id, goal.position)
        return BoardView(observation, percept_of(observation, self.knowledge.spaces))

    def plan(self, understood: Understood, view: BoardView, sentence: str) -> ExecutionReport:
        """Plan the first goal of a step."""
        report = report_of(understood, sentence)
        if understood.blocked:
            return report
        try:
            plan = self.runner.plan(understood.goals[0], Sight.of(view.observation))
        except RefusalError as refusal:
            return told(report, Answer.IMPOSSIBLE, str(refusal))
        return told(replace(report, plan=plan), Answer.PLANNED, "this is the plan")

    def carry_out(self, understood: Understood, view: BoardView, sentence: str) -> ExecutionReport:
        """Carry out a step; see `Doer`."""
        report = report_of(understood, sentence)
        sight = Sight.of(view.observation)
        moved = False
        if understood.blocked:
            report, cleared = self._clear(report, understood, sight)
            if not cleared:
                return report
            sight, moved = Sight.of(self.runner.look()), True
        for number, goal in enumerate(understood.goals):
            if number:
                sight = Sight.of(self.runner.look())
            try:
                run = self.runner.carry_out(goal, sight)
            except RefusalError as refusal:
                return told(report, Answer.FAILED if moved else Answer.IMPOSSIBLE, str(refusal))
            moved = True
            report = replace(
                report, goal=goal, plan=run.plan, outcome=run.outcome, attempts=report.attempts + run.attempts
            )
            said = "; ".join(part for part in (run.note, run.outcome.explanation if run.outcome else "") if part)
            report = told(report, answer_of(run.outcome), said)
            if not report.success:
                return report
        return report

    def where(self, view: BoardView, number: int) -> tuple[FloatArray, float] | None:
        """Centre and half of the width of a block; see `Doer`."""
        sight = Sight.of(view.observation)
        return (sight.where(number), board.BLOCK / 2) if number in sight.object_ids else None

    def acts(self, word: str) -> bool:
        """Whether a word may name an action."""
        meanings = self.knowledge.language.grounding.meanings(word)
        return sum(p for concept, p in meanings.items() if concept.space == ACTION_SPACE) >= ACTS

    def joins(self, word: str) -> bool:
        """Whether a word was learned to mean nothing by itself."""
        grounding = self.knowledge.language.grounding
        total = grounding.total(word)
        return total > 0.0 and grounding.counts[word].get(None, 0.0) >= JOINS * total

    def knows(self, word: str) -> bool:
        """Whether a word was ever heard."""
        language = self.knowledge.language
        known = getattr(language, "knows", None)
        return bool(known(word)) if known is not None else language.grounding.total(word) > 0.0

    def forget(self, knowledge: "Knowledge", understood: Understood, view: BoardView) -> bool:
        """Let knowledge learn that a step was not what its words say."""
        moved, place = self.understanding.move(view.percept, understood.goals[0])
        return unlearn(knowledge, Deed(understood.words, Arrangement.of(view.percept), moved, place))

    def resume(self) -> None:
        """Take over the world as it is."""
        self.runner.motion.resume()

    def go_on_from(self, before: Doer[Any]) -> None:
        """See `Doer`: every look at the board is a new one."""

    def close(self) -> None:
        """See `Doer`: there is nothing to free."""

    def _clear(self, report: ExecutionReport, understood: Understood, sight: Sight) -> tuple[ExecutionReport, bool]:
        """Put aside what is in the way, one block after the other."""
        try:
            _, action = carrying_action(self.knowledge)
        except RefusalError as refusal:
            return told(report, Answer.IMPOSSIBLE, str(refusal)), False
        done: list[int] = []
        for number in understood.blocked:
            try:
                goal = put_aside(number, understood, sight, action)
                run = self.runner.carry_out(goal, sight)
            except RefusalError as refusal:
                answer = Answer.FAILED if done else Answer.IMPOSSIBLE
                return told(report, answer, f"what is in the way cannot be cleared: {refusal}"), False
            report = replace(report, plan=run.plan, outcome=run.outcome, attempts=report.attempts + run.attempts)
            if run.outcome is None or not run.outcome.right:
                said = run.outcome.explanation if run.outcome else ""
                return told(report, answer_of(run.outcome), f"clearing what is in the way: {said}"), False
            done.append(number)
            report = replace(report, cleared=tuple(done))
            sight = Sight.of(self.runner.look())
        many = f"{len(done)} block{'s' if len(done) > 1 else ''}"
        return replace(report, explanation=joined(report.explanation, f"put {many} out of the way")), True


def _moved(observation: "Observation", object_id: int, position: FloatArray | None) -> "Observation":
    """An observation in which a block is somewhere else, or in the gripper."""
    index = int(np.flatnonzero(observation.object_ids == object_id)[0])
    location = np.array(observation.location)
    hand = np.array(observation.gripper_location)
    end = location[0, index] if position is None else np.asarray(position)
    if position is None:
        end = np.append(end[:2], IN_THE_HAND * board.BLOCK)
    location[:, index] = end
    hand[:] = end if position is None else end + [0.0, 0.0, IN_THE_HAND * board.BLOCK]
    closed = np.full(len(observation.gripper_closed), position is None)
    return replace(observation, location=location, gripper_location=hand, gripper_closed=closed)
