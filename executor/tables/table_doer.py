"""Steps at a table: seen through the robot's camera, understood, played by any arm that can, checked by a new look."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from executor.actions.action_plan import plan_action
from executor.actions.quantities import Quantities, quantities_of
from executor.errors import RefusalError
from executor.execution.answer import Answer, OnAmbiguous
from executor.execution.doer import Doer
from executor.execution.history import KEPT
from executor.execution.stopwatch import Stopwatch
from executor.execution.understood import Understood
from executor.report import ExecutionReport, joined, report_of, told
from executor.tables.clearing import MOST_IN_THE_WAY
from executor.tables.putting_aside import put_aside
from executor.tables.table_plan import TablePlan
from executor.tables.table_runner import TableRunner
from executor.tables.table_understanding import TableUnderstanding, TableUnderstood
from executor.tables.table_view import TableView, lost_colours
from executor.tables.taken import Taken, as_taken
from learning.concept_id import ACTION_SPACE
from learning.grounding.scripts import script_of
from learning.grounding.tongue import Tongue
from learning.interpretation.table_interpreter import TableInterpreter, unknown_words
from learning.perception.observation import Observation
from learning.perception.observe_camera import observe_camera_world
from learning.perception.robot_eye import RobotEye
from robots.pose import FloatArray

if TYPE_CHECKING:
    from learning import Knowledge
    from twin import World

NO_ROOM = ("no room", "no way on")
"""How the reasons begin of what other things may be to blame for."""
JOINS = 0.7
"""A word means nothing by itself when it was passed over in at least this share of its uses."""
REMEMBERED = 2 * KEPT
"""Looks that are remembered: at least those before the commands that can be undone."""
FORGOTTEN = 0.5
"""Share of its uses that a meaning loses that led to what was not said."""


class TableDoer:
    """Understands and carries out steps at a table. Satisfies `Doer`.

    Args:
        world: The world.
        knowledge: What was learned.
        rng: Source of the camera's noise and of the planners' chance.
        on_ambiguous: What to do where several things fit.
        clear: Whether what keeps the hand from a thing is put aside.

    Attributes:
        stopwatch: Times of the present command.
        on_start: Called with the thing's id in the world and the arm's name when an action begins.
        on_progress: Called with what begins, see `Doer`.
    """

    def __init__(
        self,
        world: "World",
        knowledge: "Knowledge",
        rng: np.random.Generator,
        on_ambiguous: OnAmbiguous = OnAmbiguous.ASK,
        clear: bool = False,
    ) -> None:
        self.world = world
        self.knowledge = knowledge
        self.clear = clear
        self.stopwatch = Stopwatch()
        self.on_start: Callable[[int, str], None] = lambda thing, arm: None
        self.on_progress: Callable[[object], None] = lambda step: None
        self._rng = rng
        self._understanding = TableUnderstanding(knowledge, on_ambiguous)
        self._eye: RobotEye | None = None
        self._seen: tuple[float, TableView] | None = None
        self._taken: Taken | None = None
        self._looks: dict[float, tuple[TableView, bool, Taken | None]] = {}
        self._broken_off = False
        self._choices: tuple[int, ...] = ()
        self.runner = TableRunner(world, knowledge, rng, self.look)
        self.runner.on_start = lambda thing, arm: self.on_start(thing, arm)
        self.runner.on_progress = lambda step: self.on_progress(step)

    def look(self) -> TableView:
        """Look at the table; where nothing has moved since the last look, that holds."""
        with self.stopwatch.part("perceive"):
            if self._seen is not None and self._seen[0] == self.world.time:
                return self._seen[1]
            if self._eye is None:
                self._eye = RobotEye(self.world.spec, self.world.robot)
            before = None if self._seen is None else self._seen[1]
            view = self._viewed(self._observed(self._eye), before)
            if before is not None and len(colours := lost_colours(view)):
                # What lies in a thing looks like a part of it, unless it is known to be another.
                again = self._viewed(self._observed(self._eye, colours), before)
                known = {*before.numbers, *(each.number for each in before.lost)}
                view = max(view, again, key=lambda each: len(known & set(each.numbers)))
            self._seen = self.world.time, view
            self._looks.pop(self.world.time, None)
            self._looks[self.world.time] = view, self._broken_off, self._taken
            if len(self._looks) > REMEMBERED:
                del self._looks[next(iter(self._looks))]
            return view

    def _viewed(self, observation: Observation, before: TableView | None) -> TableView:
        """A look as a view, in which what the hand has taken looks as it did before."""
        held = None if self._taken is None else as_taken(observation, self._taken)
        if held is None or self._taken is None:
            return TableView.of(observation, before)
        return TableView.of(held[0], before).numbered(held[1], self._taken.number)

    def _observed(self, eye: RobotEye, apart: FloatArray | None = None) -> Observation:
        """What the camera sees; `apart`: colours of things that are no parts of those that they lie in, (k, 3)."""
        state, spec, robot = self.world.state(), self.world.spec, self.world.robot
        return observe_camera_world(state, spec, self._rng, eye=eye, robot=robot, apart=apart)

    def understand(
        self, words: tuple[str, ...], view: TableView, last: int | None, choice: int | None = None
    ) -> TableUnderstood:
        """Understand one step; see `Doer`."""
        with self.stopwatch.part("interpret"):
            self._choices = () if choice is None else tuple(dict.fromkeys((*self._choices, choice)))
            reading = self._understanding.read(words, view, last, self._choices)
            found = self._understanding.found(view, reading, self._broken_off)
        if found.answer is not None or reading.action is None:
            return found
        with self.stopwatch.part("plan"):
            return self._understanding.placed(found, view, reading)

    def imagine(self, view: TableView, understood: Understood) -> TableView:
        """The table after a step, as if all went well."""
        for goal in understood.goals:
            index = view.index_of(goal.object_id)
            if index is not None:
                view = view.with_moved(index, goal.position, goal.action.states[-1].holds)
        return view

    def plan(self, understood: Understood, view: TableView, sentence: str) -> ExecutionReport:
        """Say what would be done, and where a thing would go; nothing moves."""
        report = report_of(understood, sentence)
        goal = understood.goals[0]
        try:
            steps = plan_action(goal.action, self._quantities(understood))
        except RefusalError as refusal:
            return told(report, Answer.IMPOSSIBLE, str(refusal))
        in_hand = steps.starts_held and view.held is not None and view.held == view.index_of(goal.object_id)
        report = replace(report, plan=TablePlan((() if in_hand else steps.before) + steps.steps))
        where = "it is done where the thing is" if goal.position is None else f"it goes to {_metres(goal.position)}"
        return told(report, Answer.PLANNED, where)

    def carry_out(self, understood: Understood, view: TableView, sentence: str) -> ExecutionReport:
        """Carry out a step; see `Doer`."""
        cleared: list[int] = []
        while True:
            assert isinstance(understood, TableUnderstood) and understood.reading is not None
            report, blocking = report_of(understood, sentence), understood.blocked
            if not blocking:
                report = self._carried_out(understood, view, sentence)
                blocking = self._around(report, understood, view)
                if not blocking:
                    return _after(cleared, report)
                names = self._understanding.named(blocking, understood.reading, view)
                report = told(report_of(understood, sentence), report.answer, f"{report.reason}: {names}")
            if not self.clear:
                return _after(cleared, report)
            if len(cleared) == MOST_IN_THE_WAY:
                return _after(
                    cleared, told(report, Answer.IMPOSSIBLE, "more is in the way than is cleared for one goal")
                )
            spot = understood.spots[0] if understood.spots else None
            with self.stopwatch.part("move"), self._timed():
                put = put_aside(blocking, understood.goals[0], spot, view, self.runner, self.knowledge)
            if put.number is None:
                report = replace(report_of(understood, sentence), outcome=put.outcome)
                return _after(cleared, told(report, put.answer, f"clearing what is in the way: {put.reason}"))
            cleared.append(put.number)
            now = self.look()
            understood, view = self._understanding.again(understood, view, now), now
            if understood.answer is not None and not understood.blocked:
                return _after(cleared, report_of(understood, sentence))

    def _carried_out(self, understood: TableUnderstood, view: TableView, sentence: str) -> ExecutionReport:
        """Carry out a step that nothing is known to be in the way of."""
        report = report_of(understood, sentence)
        assert understood.reading is not None and understood.reading.action is not None
        goal, begun = understood.goals[0], self.world.time
        thing = view.index_of(goal.object_id)
        if thing is not None and not (view.held == thing and self._taken is not None):
            self._taken = Taken.of(view, thing)
        sound, self._broken_off = not self._broken_off, True  # so it stays where something raises on the way: a stop
        with self.stopwatch.part("move"), self._timed():
            action, reading = understood.reading.action, understood.reading
            meant = self._understanding.sound(reading) if understood.spots and reading.goal is not None else None
            run = self.runner.carry_out(goal, action, understood.spots, view, meant=meant, sound=sound)
        self._broken_off = not sound and self.world.time == begun
        self.stopwatch.add("simulated", self.world.time - begun)
        report = replace(report, attempts=run.attempts, outcome=run.outcome)
        if run.outcome is None:
            return told(report, Answer.IMPOSSIBLE if self.world.time == begun else Answer.FAILED, run.note)
        return told(report, run.answer, joined(run.outcome.explanation, run.note))

    def _around(self, report: ExecutionReport, understood: TableUnderstood, view: TableView) -> tuple[int, ...]:
        """Numbers of the things that keep the hand from what a step is about, where it could not begin for them."""
        thing = view.index_of(understood.goals[0].object_id)
        if report.answer.good or not report.reason.startswith(NO_ROOM) or thing is None:
            return ()
        return self.runner.around(thing, view)

    def where(self, view: TableView, number: int) -> tuple[FloatArray, float] | None:
        """Centre and half of the width of a thing; see `Doer`."""
        index = view.index_of(number)
        if index is None:
            return None
        return view.things.location[index], float(np.max(view.things.extent[index]) / 2)

    def acts(self, word: str) -> bool:
        """Whether a word may name an action."""
        tongue = self._tongue(word)
        return tongue is not None and any(each.space == ACTION_SPACE for each in tongue.meanings(word))

    def joins(self, word: str) -> bool:
        """Whether a word was learned to mean nothing by itself."""
        tongue = self._tongue(word)
        if tongue is None:
            return False
        total = tongue.grounding.total(word)
        return total > 0.0 and tongue.grounding.counts[word].get(None, 0.0) >= JOINS * total

    def knows(self, word: str) -> bool:
        """Whether a word was ever heard."""
        tongue = self._tongue(word)
        return tongue is not None and not unknown_words(tongue, (word,))

    def forget(self, knowledge: "Knowledge", understood: Understood, view: TableView) -> bool:
        """Let knowledge learn that a step was not what its words say: what they were read as counts less."""
        tongue = knowledge.table_language.tongues.get(script_of(understood.words))
        if tongue is None or understood.tree is None:
            return False
        pieces, origin = tongue.joined.split(understood.words)
        for node in understood.tree.nodes():
            if node.concept is None:
                continue
            said = [piece for piece, word in zip(pieces, origin, strict=True) if node.first - 1 <= word < node.last]
            for ngram in {" ".join(said), *said}:
                count = tongue.grounding.counts[ngram][node.concept] if ngram in tongue.grounding.counts else 0.0
                tongue.grounding.add(ngram, node.concept, -min(count, max(1.0, FORGOTTEN * count)))
        again = TableInterpreter(knowledge).interpret(understood.words, view.observation, held=view.held)
        assert isinstance(understood, TableUnderstood)
        return (again.action, again.things, again.goal) != (
            (understood.reading.action, understood.reading.things, understood.reading.goal)
            if understood.reading
            else (None, (), None)
        )

    def resume(self) -> None:
        """Take over the world as it is: what was seen at the moment to which it was put back holds, numbers and all."""
        then = self._looks.get(self.world.time)
        if then is not None:
            view, self._broken_off, self._taken = then
            self._seen = self.world.time, view
        elif self._seen is not None:
            self._seen = np.nan, self._seen[1]  # looked at anew, with the numbers that things had

    def go_on_from(self, before: Doer[Any]) -> None:
        """Take over what another one has seen, numbers and all; see `Doer`."""
        assert isinstance(before, TableDoer)
        self.close()
        self._eye, before._eye = before._eye, None
        self._seen, self._looks = before._seen, before._looks
        self._taken, self._broken_off = before._taken, before._broken_off

    def _quantities(self, understood: Understood) -> Quantities:
        """How much of each change was seen with the action."""
        assert isinstance(understood, TableUnderstood) and understood.reading is not None
        number = understood.reading.action
        assert number is not None
        return quantities_of(understood.goals[0].action, self.knowledge.spaces.actions.statistics(number))

    def close(self) -> None:
        """Free the renderer; a later look makes another."""
        if self._eye is not None:
            self._eye.close()
            self._eye = None

    @contextmanager
    def _timed(self) -> Iterator[None]:
        """Tell when the first step is made."""
        before = self.world.on_step

        def first() -> None:
            self.stopwatch.mark_once("to_motion")
            self.world.on_step = before
            if before is not None:
                before()

        self.world.on_step = first
        try:
            yield
        finally:
            self.world.on_step = before

    def _tongue(self, word: str) -> Tongue | None:
        return self.knowledge.table_language.tongues.get(script_of((word,)))


def _after(cleared: list[int], report: ExecutionReport) -> ExecutionReport:
    """A report with what was put aside before: then something was done, whatever came after."""
    report = replace(report, cleared=tuple(cleared))
    return replace(report, answer=Answer.FAILED) if cleared and report.answer is Answer.IMPOSSIBLE else report


def _metres(position: FloatArray) -> str:
    return "(" + ", ".join(f"{value:.2f}" for value in position) + ") m"
