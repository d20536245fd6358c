"""Steps at a table: seen through the robot's camera, understood, played by any arm that can, checked by a new look."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import islice
from typing import TYPE_CHECKING, Any

import numpy as np

from executor.actions.action_plan import plan_action
from executor.actions.quantities import Quantities, quantities_of
from executor.errors import RefusalError
from executor.execution.answer import Answer, OnAmbiguous
from executor.execution.doer import Doer
from executor.execution.history import KEPT
from executor.execution.stopwatch import Stopwatch
from executor.execution.understood import Option, Referent, Understood, offer, offer_again, parts, question, quoted
from executor.lexicon import entry_of
from executor.report import ExecutionReport, joined, report_of, told
from executor.tables.clearing import MOST_IN_THE_WAY, covering, in_the_way
from executor.tables.places import Spot, best_apart, spots_for
from executor.tables.putting_aside import put_aside
from executor.tables.table_names import TableNames
from executor.tables.table_plan import TablePlan
from executor.tables.table_runner import TableRunner
from executor.tables.table_view import TableView, lost_colours
from executor.tables.taken import Taken, as_taken
from learning.concept_id import ACTION_SPACE, Concept
from learning.grounding.scripts import script_of
from learning.grounding.table_scene import SIDE_PLACES
from learning.grounding.tongue import Tongue
from learning.interpretation.interpretation import Goal
from learning.interpretation.table_interpreter import TableGoal, TableInterpreter, TableReading, unknown_words
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


@dataclass(frozen=True, slots=True)
class TableUnderstood(Understood):
    """How one step at a table was understood.

    Attributes:
        reading: What the words say here.
        spots: Places for the thing, the best first; empty where it goes nowhere.
    """

    reading: TableReading | None = None
    spots: tuple[Spot, ...] = ()


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
        self.on_ambiguous = on_ambiguous
        self.clear = clear
        self.stopwatch = Stopwatch()
        self.on_start: Callable[[int, str], None] = lambda thing, arm: None
        self.on_progress: Callable[[object], None] = lambda step: None
        self._rng = rng
        self._interpreter = TableInterpreter(knowledge)
        self._names = TableNames(knowledge)
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
            reading = self._interpreter.interpret(words, view.observation, held=view.held, last=view.index_of(last))
            self._choices = () if choice is None else tuple(dict.fromkeys((*self._choices, choice)))
            reading = self._chosen(reading, view)
            found = self._found(words, view, reading)
        if found.answer is not None or reading.action is None:
            return found
        with self.stopwatch.part("plan"):
            return self._placed(found, view, reading)

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
                names = self._named(blocking, understood.reading, view)
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
            understood, view = self._again(understood, view, now), now
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
            meant = self._sound(reading) if understood.spots and reading.goal is not None else None
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

    def _named(self, numbers: tuple[int, ...], reading: TableReading, view: TableView) -> str:
        """That some things are in the way, by name."""
        indices = [index for index in map(view.index_of, numbers) if index is not None]
        names = self._names.apart(script_of(reading.words), view.observation, indices)
        return f"{' and '.join(names)} {'is' if len(names) == 1 else 'are'} in the way"

    def _again(self, understood: TableUnderstood, before: TableView, now: TableView) -> TableUnderstood:
        """The same step after something was put aside: the things that were meant are still meant."""
        reading = understood.reading
        assert reading is not None

        def here(indices: tuple[int, ...]) -> tuple[int, ...]:
            found = (now.index_of(before.numbers[index]) for index in indices)
            return tuple(index for index in found if index is not None)

        things, goal = here(reading.things), reading.goal
        grounds = () if goal is None else here(goal.grounds)
        plain = replace(understood, answer=None, reason="", blocked=(), spots=())
        if not things or (goal is not None and goal.grounds and not grounds):
            return replace(plain, answer=Answer.FAILED, reason="after clearing, what is meant was lost from sight")
        goal = None if goal is None else replace(goal, grounds=grounds)
        reading = replace(reading, things=things, goal=goal)
        return self._placed(replace(plain, reading=reading), now, reading)

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

    def _found(self, words: tuple[str, ...], view: TableView, reading: TableReading) -> TableUnderstood:
        """What the words say, with its answer where it is not acted on."""
        answer, reason = self._doubt(reading, view) or (None, "")
        goals: tuple[Goal, ...] = ()
        if reading.action is not None and reading.things:
            graphlet = self.knowledge.spaces.actions[reading.action]
            goals = (Goal(view.numbers[reading.things[0]], None, graphlet),)
        options: tuple[Option, ...] = ()
        if answer is Answer.AMBIGUOUS:
            role, fitting = (
                ("entity", reading.things) if len(reading.things) > 1 else ("destination", _grounds(reading))
            )
            names = self._names.apart(script_of(words), view.observation, fitting)
            options = tuple(Option(view.numbers[index], name) for index, name in zip(fitting, names, strict=True))
            node = next(parts(reading.tree, role), None)
            said = "" if node is None else f"“{' '.join(words[node.first - 1 : node.last])}”"
            reason = question(said, options)
        return TableUnderstood(
            words,
            answer,
            reason,
            reading.explanation,
            reading.tree,
            goals,
            _referents(reading, view),
            options,
            (*reading.unknown, *reading.unlearned),
            reading=reading,
            share=1.0 if reading.understood else 0.0,
        )

    def _placed(self, found: TableUnderstood, view: TableView, reading: TableReading) -> TableUnderstood:
        """The same with places for the thing, where the action brings it somewhere."""
        (goal,) = found.goals
        thing = reading.things[0]
        on_it: tuple[int, ...] = ()
        if any(state.holds for state in goal.action.states) and view.held != thing:
            on_it = covering(thing, view.things, self.knowledge, view.held)
        covered = tuple(view.numbers[index] for index in on_it)
        if reading.goal is None or all(state.holds for state in goal.action.states[1:]):
            if not covered:
                return found
            return self._blocked(found, covered, "it cannot be taken", (), view, reading)
        language, meant = self.knowledge.table_language, self._sound(reading)
        wanted = spots_for(meant, thing, view.things, self.knowledge.spaces, language.resting)
        if wanted:
            spots = best_apart(wanted)
            if covered:
                return self._blocked(found, covered, "it cannot be taken", spots, view, reading)
            return replace(found, goals=(replace(goal, position=spots[0].position),), spots=spots)
        blocking = in_the_way(meant, thing, view.things, self.knowledge)
        if blocking is None:
            return replace(found, answer=Answer.IMPOSSIBLE, reason="there is no room where it shall go")
        numbers = tuple(dict.fromkeys((*covered, *(view.numbers[index] for index in blocking[0]))))
        why = "there is no room where it shall go"
        return self._blocked(found, numbers, why, best_apart(blocking[1]), view, reading)

    def _blocked(
        self,
        found: TableUnderstood,
        numbers: tuple[int, ...],
        why: str,
        spots: tuple[Spot, ...],
        view: TableView,
        reading: TableReading,
    ) -> TableUnderstood:
        """The same with what is in the way, the first to be put aside first, and where the thing goes without that."""
        (goal,) = found.goals
        return replace(
            found,
            answer=Answer.IMPOSSIBLE,
            reason=f"{why}: {self._named(numbers, reading, view)}",
            goals=(replace(goal, position=spots[0].position if spots else None),),
            spots=spots,
            blocked=numbers,
        )

    def _sound(self, reading: TableReading) -> TableGoal:
        """Where a thing goes; of two opposite sides, the one that is said more surely."""
        assert reading.goal is not None
        concepts = set(reading.goal.concepts)
        for one, other in (SIDE_PLACES[:2], SIDE_PLACES[2:]):
            if {one, other} <= concepts:
                concepts.discard(min(one, other, key=lambda each: self._said_surely(reading, each)))
        return replace(reading.goal, concepts=frozenset(concepts))

    def _said_surely(self, reading: TableReading, concept: Concept) -> float:
        """How sure it is that the words mean a concept, 0..1."""
        tongue = self.knowledge.table_language.tongues[script_of(reading.words)]
        nodes = () if reading.tree is None else reading.tree.nodes()
        said = [" ".join(reading.words[node.first - 1 : node.last]) for node in nodes if node.concept == concept]
        return max((tongue.meanings(ngram).get(concept, 0.0) for ngram in said), default=0.0)

    def _doubt(self, reading: TableReading, view: TableView) -> tuple[Answer, str] | None:
        """Why a step is not acted on; None when it can be."""
        if reading.unknown:
            return Answer.UNKNOWN_WORD, offer(reading.unknown)
        if reading.unlearned:
            word = reading.unlearned[0]
            return Answer.UNKNOWN_WORD, offer_again(word, entry_of(self.knowledge, word).heard)
        if reading.tree is None or reading.action is None:
            return Answer.REFUSED, "no word says what to do" if reading.tree is not None else reading.explanation
        if not reading.things:
            return Answer.IMPOSSIBLE, _nothing_is(reading, "nothing here is what the words say")
        if reading.nowhere:
            return Answer.IMPOSSIBLE, _nothing_is(reading, "what it shall go to is not here")
        if (len(reading.things) > 1 or len(_grounds(reading)) > 1) and self.on_ambiguous is OnAmbiguous.ASK:
            return Answer.AMBIGUOUS, ""
        states = self.knowledge.spaces.actions[reading.action].states
        if view.held is not None and view.held not in reading.things and not self._broken_off:
            return Answer.IMPOSSIBLE, "the hand holds another thing; say where to put that one first"
        set_down = any(state.holds and not state.raised for state in states[1:]) and not states[-1].holds
        if set_down and view.held is None and reading.goal is None and self._tells_where(reading.words):
            if reading.absent:
                return Answer.IMPOSSIBLE, _nothing_is(reading, "")
            passed = f": I could make nothing of {quoted(reading.unheeded)}" if reading.unheeded else ""
            return Answer.REFUSED, f"where it shall go was not understood{passed}"
        return None

    def _chosen(self, reading: TableReading, view: TableView) -> TableReading:
        """A reading with what was chosen where several things fitted, as what is done or as where it goes."""
        for index in map(view.index_of, self._choices):
            if len(reading.things) > 1 and index in reading.things:
                reading = replace(reading, things=(index,))
            elif reading.goal is not None and index in _grounds(reading):
                reading = replace(reading, goal=replace(reading.goal, grounds=(index,)))
        return reading

    def _tells_where(self, words: tuple[str, ...]) -> bool:
        """Whether people who speak this language say where things go."""
        tongue = self.knowledge.table_language.tongues[script_of(words)]
        return "destination" in tongue.grammar.rules


def _after(cleared: list[int], report: ExecutionReport) -> ExecutionReport:
    """A report with what was put aside before: then something was done, whatever came after."""
    report = replace(report, cleared=tuple(cleared))
    return replace(report, answer=Answer.FAILED) if cleared and report.answer is Answer.IMPOSSIBLE else report


def _grounds(reading: TableReading) -> tuple[int, ...]:
    """Things to which it may go, but for itself."""
    return () if reading.goal is None else tuple(each for each in reading.goal.grounds if each not in reading.things)


def _nothing_is(reading: TableReading, otherwise: str) -> str:
    """That nothing is what some of the words say, by name where it is known which."""
    return f"nothing here is {quoted(reading.absent)}" if reading.absent else otherwise


def _referents(reading: TableReading, view: TableView) -> tuple[Referent, ...]:
    """What the words speak of."""
    found = []
    for role, things in (("entity", reading.things), ("destination", reading.goal.grounds if reading.goal else ())):
        for node in islice(parts(reading.tree, role), 1):
            said = " ".join(reading.words[node.first - 1 : node.last])
            found.append(Referent(role, said, node.first, node.last, tuple(view.numbers[each] for each in things)))
    return tuple(found)


def _metres(position: FloatArray) -> str:
    return "(" + ", ".join(f"{value:.2f}" for value in position) + ") m"
