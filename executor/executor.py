"""`Executor`: from a sentence to a changed world, checked by looking."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from executor.doubts import doubt, heard
from executor.errors import InputError, RefusalError
from executor.goal_runner import GoalRunner
from executor.report import ExecutionReport
from executor.sight import Sight
from learning.interpretation import Interpreter
from learning.perception import percept_of

if TYPE_CHECKING:
    from learning import Knowledge
    from learning.interpretation import Goal
    from twin import World


class Executor:
    """Does on the twin what a sentence says, as far as it was learned.

    Args:
        world: Where to do it.
        knowledge: What was learned.
        rng: Source of the noise of looking; the scene's seed decides when it is left out.
    """

    def __init__(self, world: "World", knowledge: "Knowledge", rng: np.random.Generator | None = None) -> None:
        """Take a world and what was learned.

        Raises:
            InputError: The world is none that sentences are carried out in yet; says which are.
        """
        robot, scene = world.robot, world.spec
        if scene.kind != "board" or len(robot.joint_names) != 3:
            raise InputError(
                f"sentences are carried out by an arm of three joints on the board so far, not by {robot.name} in "
                f"scene {scene.name!r}: use a board scene with the robot three_dof"
            )
        self.world = world
        self.knowledge = knowledge
        self.rng = np.random.default_rng(world.spec.seed) if rng is None else rng
        self._interpreter = Interpreter(knowledge)

    def execute(self, sentence: str, *, plan_only: bool = False) -> ExecutionReport:
        """Understand a sentence in the scene as it is seen, and do what it says.

        What cannot be understood or done is refused with an explanation; only a fault in the arguments raises.

        Args:
            sentence: What to do.
            plan_only: Stop after the plan of the first goal; nothing moves.

        Raises:
            InputError: The sentence holds no word.
        """
        if not any(letter.isalnum() for letter in sentence):
            raise InputError(f"the sentence {sentence!r} holds no word; say what to do")
        runner = GoalRunner(self.world, self.rng)
        observation = runner.look()
        with runner.stopwatch.part("perceive"):
            percept = percept_of(observation, self.knowledge.spaces)
        with runner.stopwatch.part("interpret"):
            reading = self._interpreter.interpret(sentence, percept)
        trouble = doubt(reading, self.knowledge, percept)
        report = ExecutionReport(
            sentence,
            False,
            True,
            _sentences(heard(reading), trouble),
            goal=reading.goals[0] if reading.goals else None,
            goals=reading.goals,
            durations=runner.stopwatch.seconds,
        )
        if trouble or not reading.understood or not reading.goals:
            return report
        sight = Sight.of(observation)
        for number, goal in enumerate(reading.goals):
            if number:
                sight = Sight.of(runner.look())
            report = _after(report, runner, goal, sight, plan_only)
            if not report.success or plan_only:
                break
        return report


def _after(report: ExecutionReport, runner: GoalRunner, goal: "Goal", sight: Sight, plan_only: bool) -> ExecutionReport:
    """The report, continued by what became of one more goal."""
    report = replace(report, goal=goal)
    try:
        if plan_only:
            return replace(report, plan=runner.plan(goal, sight), success=True, refused=False)
        run = runner.carry_out(goal, sight)
    except RefusalError as refusal:
        return replace(report, success=False, explanation=_sentences(report.explanation, str(refusal)))
    said = [part for part in (run.note, run.outcome.explanation if run.outcome else "") if part]
    return replace(
        report,
        success=run.outcome is not None and run.outcome.right,
        refused=False,
        explanation=_sentences(report.explanation, *said),
        plan=run.plan,
        outcome=run.outcome,
        attempts=report.attempts + run.attempts,
    )


def _sentences(*parts: str) -> str:
    """Join explanations with semicolons, without their full stops."""
    return "; ".join(part.strip().rstrip(".") for part in parts if part.strip())
