"""New commands at a table, for evaluation: random scenes, what is to be done there, and how somebody says it.

What is true of a scene is used to make the task and to judge it by physics; the executor sees the scene through the
camera and hears the sentence.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from executor.actions.success import fault_of
from executor.actions.witness import WitnessedWorld
from executor.collections import leeds, ordering
from executor.collections.ordering_plans import ACTIONS as COUNTER_ACTIONS
from executor.collections.performance import PlannedDemo, Shown
from executor.collections.rules import Facts, Rule
from executor.collections.table_goals import put_rule
from executor.collections.table_plans import planned
from executor.execution.answer import Answer
from executor.execution.evaluation.verdict import Verdict
from executor.follow import wait
from executor.report import ExecutionReport
from learning.grounding.ngrams import words_of
from teleop.annotators import OrderingFacts, TableAction, Told, tell_ordering, tell_table
from twin import SceneSpec, WorldState

Heard = frozenset[tuple[str, ...]]
"""Words of sentences."""
ACTIONS: tuple[TableAction, ...] = ("pick up", "move")
SPEAKERS = 5
"""People who are asked to say it, until one says it rightly and anew."""
SETTLE = 0.2
"""Time between two looks of the judge [s]."""
LOOKS = 3

Judge = Callable[[WitnessedWorld, WorldState], str]
"""What is wrong with a world after a command, given its state before; empty when it is as the sentence says."""


@dataclass(frozen=True, slots=True)
class TableCommand:
    """A command in a scene.

    Attributes:
        scene: The scene.
        sentence: What is said.
        action: True name of the action, for the report.
        target: Id of the thing it is about.
        thing: Name of its model.
        judge: Says what is wrong afterwards; None where nobody knows what should come of it.
        expected: Which answer, where nothing should move; None where something should.
    """

    scene: SceneSpec
    sentence: str
    action: str
    target: int
    thing: str
    judge: Judge | None
    expected: Answer | None = None


def tabletop_command(rng: np.random.Generator, language: str, known: Heard) -> TableCommand:
    """A command for Baxter: pick up a thing, or move it to another part of the table, beside, onto or into a thing.

    Only what an operator could do by hand is asked for, in a sentence that was not heard before.

    Args:
        rng: Where chance comes from.
        language: Language of the sentence.
        known: Words of sentences that were heard before.
    """
    while True:
        thing = str(rng.choice(leeds.OBJECTS))
        scene = leeds.scene_with(rng, thing, int(rng.integers(2**31)))
        target = next(each.id for each in scene.objects if each.model == thing)
        action = ACTIONS[int(rng.integers(len(ACTIONS)))]
        with WitnessedWorld(scene) as world:
            plan = planned(world, action, target, rng)
            if plan is None:
                continue
            facts = leeds.facts_of(scene, action, target, plan.goal)
            told = _new(tell_table(facts, SPEAKERS, language, rng), known)
            only_beside = told is not None and told.only_beside
            rule = put_rule(world, action, target, plan.goal, only_beside=only_beside)
        if told is not None:
            return TableCommand(scene, told.text, action, target, thing, by_rule(rule, plan.demo))


def counter_command(rng: np.random.Generator, language: str, known: Heard) -> TableCommand:
    """A command for the Mico: any of its seven actions with the thing on the counter. Arguments as above.

    What is heard there is short, and hardly ever new; the scene is.
    """
    thing = str(rng.choice(ordering.OBJECTS))
    action = COUNTER_ACTIONS[int(rng.integers(len(COUNTER_ACTIONS)))]
    scene = ordering.scene_with(rng, thing, int(rng.integers(2**31)))
    facts = OrderingFacts.of_model(action, thing)
    told = [tell_ordering(facts, language, rng) for _ in range(SPEAKERS)]
    sentence = (_new(told, known) or next((each for each in told if not each.mistakes), told[0])).text
    target = scene.objects[0].id

    def judge(world: WitnessedWorld, before: WorldState) -> str:
        wait(world, SETTLE * LOOKS, world.commanded_openings)
        evidence = world.evidence()
        return "not begun: nothing was touched" if evidence is None else fault_of(action, evidence, None)

    return TableCommand(scene, sentence, action, target, thing, judge)


def _new(told: list[Told], known: Heard) -> Told | None:
    """The first sentence without mistakes that was not heard before."""
    return next((each for each in told if not each.mistakes and words_of(each.text) not in known), None)


def by_rule(rule: Rule, plan: PlannedDemo) -> Judge:
    """A judge who looks at the world as it was and as it is when all has come to rest."""

    def judge(world: WitnessedWorld, before: WorldState) -> str:
        states = [before]
        for _ in range(LOOKS):
            wait(world, SETTLE, world.commanded_openings)
            states.append(world.state())
        held = [n for state in (states[-1], before) for n, arm in enumerate(state.arms) if arm.held == plan.target]
        hand = held[0] if held else 0
        facts = Facts(Shown(plan, hand, tuple(states), 0.0), world.model_of(plan.target))
        return rule(facts) or facts.trouble()

    return judge


@dataclass(frozen=True, slots=True)
class Answered:
    """How a command went.

    Attributes:
        number: Number of the command.
        action: True name of the action.
        thing: With which thing.
        sentence: What was said.
        report: What the executor says of it.
        fault: What is wrong in truth; empty when it was done, None where nobody knows what should have come of it.
        moved: Whether the robot moved, in truth.
        wall: Time that the command took, without building the world [s].
    """

    number: int
    action: str
    thing: str
    sentence: str
    report: ExecutionReport
    fault: str | None
    moved: bool = False
    wall: float = 0.0

    @property
    def right(self) -> bool | None:
        """Whether the world is as the sentence says, or the answer as it should be; None where nobody knows."""
        return None if self.fault is None else not self.fault

    def verdict(self) -> Verdict:
        """The same as a verdict."""
        report = self.report
        return Verdict(
            self.number,
            self.sentence,
            self.action,
            report.answer,
            self.right,
            self.fault or "",
            self._cause(self.fault) if self.fault else "",
            self.moved,
            report.explanation,
            report.durations,
            self.wall,
        )

    def _cause(self, fault: str) -> str:
        """A fault in a word or two."""
        if not self.report.answer.moved:
            return f"answered {self.report.answer}"
        return f"{fault.split(':')[0]} ({self.report.answer})"
