"""Steps at a table: seen through the robot's camera, understood, played by any arm that can, checked by a new look."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np

from executor.actions.player import ActionPlayer, Played
from executor.actions.quantities import quantities_of
from executor.actions.things import corners_of, pose_of
from executor.errors import RefusalError
from executor.execution.answer import Answer, OnAmbiguous
from executor.execution.stopwatch import Stopwatch
from executor.execution.understood import Option, Referent, Understood, offer, parts, question
from executor.follow import wait
from executor.report import ExecutionReport, Outcome, answer_of, report_of, told
from executor.tables.places import Spot, spots_for
from executor.tables.table_names import TableNames
from executor.tables.table_view import TableView, alike
from learning.concept_id import ACTION_SPACE, Concept
from learning.grounding.scripts import script_of
from learning.grounding.table_scene import SIDE_PLACES
from learning.grounding.tongue import Tongue
from learning.interpretation.interpretation import Goal
from learning.interpretation.table_interpreter import TableGoal, TableInterpreter, TableReading, unknown_words
from learning.perception.observe_camera import observe_camera_world
from learning.perception.robot_eye import RobotEye
from robots.pose import FloatArray

if TYPE_CHECKING:
    from learning import Knowledge
    from twin import World

SPOTS = 4
"""Places that are tried for one goal."""
FIRST_SPOTS = 40
"""The best of all places, from which those are taken"""
APART = 0.05
"""so far apart [m]."""
SAME = 0.06
"""What is seen so near to where a thing should be is that thing [m]."""
REST = 0.7
"""Time [s] in which all comes to rest before the second look."""
DISTURBED = 0.03
"""Other things that moved further were disturbed [m]."""
NEAR_BY = 0.2
"""A thing that was moved along is so near to where it was [m]."""
JOINS = 0.7
"""A word means nothing by itself when it was passed over in at least this share of its uses."""
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

    Attributes:
        stopwatch: Times of the present command.
        on_start: Called with the thing's id in the world and the arm's name when an action begins.
    """

    def __init__(
        self,
        world: "World",
        knowledge: "Knowledge",
        rng: np.random.Generator,
        on_ambiguous: OnAmbiguous = OnAmbiguous.ASK,
    ) -> None:
        self.world = world
        self.knowledge = knowledge
        self.on_ambiguous = on_ambiguous
        self.stopwatch = Stopwatch()
        self.on_start: Callable[[int, str], None] = lambda thing, arm: None
        self._rng = rng
        self._interpreter = TableInterpreter(knowledge)
        self._names = TableNames(knowledge)
        self._eye: RobotEye | None = None
        self._seen: tuple[float, TableView] | None = None

    def look(self) -> TableView:
        """Look at the table; where nothing has moved since the last look, that holds."""
        with self.stopwatch.part("perceive"):
            if self._seen is not None and self._seen[0] == self.world.time:
                return self._seen[1]
            if self._eye is None:
                self._eye = RobotEye(self.world.spec, self.world.robot)
            state = self.world.state()
            observation = observe_camera_world(state, self.world.spec, self._rng, eye=self._eye, robot=self.world.robot)
            before = None if self._seen is None else self._seen[1]
            view = TableView.of(observation, before)
            self._seen = self.world.time, view
            return view

    def understand(
        self, words: tuple[str, ...], view: TableView, last: int | None, choice: int | None = None
    ) -> TableUnderstood:
        """Understand one step; see `Doer`."""
        with self.stopwatch.part("interpret"):
            reading = self._interpreter.interpret(
                words, view.observation, held=view.held, last=view.index_of(last), choice=view.index_of(choice)
            )
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
        """Say where a thing would go; nothing moves."""
        report = report_of(understood, sentence)
        goal = understood.goals[0]
        where = "it is done where the thing is" if goal.position is None else f"it goes to {_metres(goal.position)}"
        return told(report, Answer.PLANNED, where)

    def carry_out(self, understood: Understood, view: TableView, sentence: str) -> ExecutionReport:
        """Carry out a step; see `Doer`."""
        report = report_of(understood, sentence)
        assert isinstance(understood, TableUnderstood) and understood.reading is not None
        assert understood.reading.action is not None
        goal = understood.goals[0]
        thing = view.index_of(goal.object_id)
        real = None if thing is None else self._real(view, thing)
        if thing is None or real is None:
            return told(report, Answer.IMPOSSIBLE, "the thing that is meant was lost from sight")
        begun = self.world.time
        with self.stopwatch.part("move"), self._timed():
            played, spot = self._play(understood.reading.action, goal, real, understood.spots)
            if self.world.time > begun:
                wait(self.world, REST, self.world.commanded_openings)
        self.stopwatch.add("simulated", self.world.time - begun)
        report = replace(report, attempts=1)
        if self.world.time == begun:
            return told(report, Answer.IMPOSSIBLE, played.reason)
        now = self.look()
        if not played.success:
            outcome = Outcome(False, None, self._disturbed(thing, view, now), played.reason)
            return told(replace(report, outcome=outcome), Answer.FAILED, played.reason)
        outcome = self._judge(goal, thing, view, now, spot)
        return told(replace(report, outcome=outcome), answer_of(outcome), outcome.explanation)

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
        """Take over the world as it is."""
        self._seen = None

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
            names = self._names.apart(script_of(words), view.observation, reading.things)
            options = tuple(
                Option(view.numbers[index], name) for index, name in zip(reading.things, names, strict=True)
            )
            node = next(parts(reading.tree, "entity"), None)
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
            reading.unknown,
            reading=reading,
            share=1.0 if reading.understood else 0.0,
        )

    def _placed(self, found: TableUnderstood, view: TableView, reading: TableReading) -> TableUnderstood:
        """The same with places for the thing, where the action brings it somewhere."""
        (goal,) = found.goals
        if reading.goal is None or all(state.holds for state in goal.action.states[1:]):
            return found
        thing = reading.things[0]
        language = self.knowledge.table_language
        wanted = spots_for(self._sound(reading), thing, view.things, self.knowledge.spaces, language.resting)
        kept: list[Spot] = []
        for spot in wanted[:FIRST_SPOTS]:
            if all(np.linalg.norm(spot.position - other.position) > APART for other in kept):
                kept.append(spot)
        if not kept:
            return replace(found, answer=Answer.IMPOSSIBLE, reason="there is no room where it shall go")
        return replace(found, goals=(replace(goal, position=kept[0].position),), spots=tuple(kept[:SPOTS]))

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
        if reading.tree is None or reading.action is None:
            return Answer.REFUSED, "no word says what to do" if reading.tree is not None else reading.explanation
        if not reading.things:
            return Answer.IMPOSSIBLE, "nothing here is what the words say"
        if reading.nowhere:
            return Answer.IMPOSSIBLE, "what it shall go to is not here"
        if len(reading.things) > 1 and self.on_ambiguous is OnAmbiguous.ASK:
            return Answer.AMBIGUOUS, ""
        states = self.knowledge.spaces.actions[reading.action].states
        if view.held is not None and view.held not in reading.things:
            return Answer.IMPOSSIBLE, "the hand holds another thing; say where to put that one first"
        set_down = any(state.holds and not state.raised for state in states[1:]) and not states[-1].holds
        if set_down and view.held is None and reading.goal is None and self._tells_where(reading.words):
            return Answer.REFUSED, "where it shall go was not understood"
        return None

    def _tells_where(self, words: tuple[str, ...]) -> bool:
        """Whether people who speak this language say where things go."""
        tongue = self.knowledge.table_language.tongues[script_of(words)]
        return "destination" in tongue.grammar.rules

    def _real(self, view: TableView, thing: int) -> int | None:
        """Id of the thing in the world: grasps are chosen by the models of things, which the twin knows."""
        where = view.things.location[thing]
        state = self.world.state()
        away = {each.id: float(np.linalg.norm(each.pose_object_in_world.position - where)) for each in state.objects}
        held = {arm.held for arm in state.arms if arm.gripper_closed and arm.held is not None}
        if thing == view.held and held:
            return min(held, key=lambda each: away[each])
        nearest = min(away, key=lambda each: away[each])
        return nearest if away[nearest] < SAME else None

    def _play(self, number: int, goal: Goal, real: int, spots: tuple[Spot, ...]) -> tuple[Played, Spot | None]:
        """Play the action with the first place that can be reached."""
        quantities = quantities_of(goal.action, self.knowledge.spaces.actions.statistics(number))
        player = ActionPlayer(self.world, self._rng)
        failed: tuple[Played, Spot | None] | None = None
        for spot in spots or (None,):
            there = None if spot is None else self._at_rest(real, spot)
            try:
                played = player.play(goal.action, real, there, quantities, lambda arm: self.on_start(real, arm))
            except RefusalError as refusal:
                return Played(False, str(refusal)), spot
            if played.success or played.started:
                return played, spot
            failed = failed or (played, spot)
        assert failed is not None
        return failed

    def _at_rest(self, real: int, spot: Spot) -> FloatArray:
        """Where the centre comes to rest at a place, as high above its underside as it is now."""
        if spot.onto is not None:
            return spot.position  # half of its height as it was seen above the top of what bears it
        centre = pose_of(self.world.state(), real).position
        below = float(centre[2] - corners_of(self.world, real)[:, 2].min())
        return np.array([spot.position[0], spot.position[1], below])

    def _judge(self, goal: Goal, thing: int, before: TableView, now: TableView, spot: Spot | None) -> Outcome:
        """Compare two looks."""
        words: list[str] = []
        error: float | None = None
        doubt = ""
        track = self._again(thing, before, now, spot)
        if goal.action.states[-1].holds:
            reached = now.feels
            if reached:
                words.append("the hand feels it between the fingers")
            elif track is None:
                reached, doubt = True, "the hand does not feel it, and it is not seen where it was"
                words.append(doubt)
            else:
                words.append("the hand holds nothing")
        elif now.held is not None and goal.action.states[0].holds:
            reached = False
            words.append("it is still in the hand")
        elif spot is None:
            reached = True
            words.append("it was done")
        elif track is None:
            reached, doubt = True, "it cannot be seen any more"
            words.append(doubt)
        else:
            error = float(np.linalg.norm(now.things.location[track, :2] - spot.position[:2]))
            reached = error < SAME
            words.append(f"it rests {1000 * error:.0f} mm from the middle of its place")
        disturbed = self._disturbed(thing, before, now)
        if disturbed:
            words.append(f"{len(disturbed)} other thing{'s' if len(disturbed) > 1 else ''} moved as well")
        return Outcome(reached, error, disturbed, "; ".join(words), doubt)

    def _again(self, thing: int, before: TableView, now: TableView, spot: Spot | None) -> int | None:
        """Which of the things that are seen now is the one that was handled: like it, and where it should be."""
        where = before.things.location[thing] if spot is None else spot.position
        off = [
            float(np.linalg.norm(now.things.location[index, :2] - where[:2]))
            if alike(before, thing, now, index)
            else np.inf
            for index in range(len(now.things.location))
        ]
        best = int(np.argmin(off)) if off else 0
        return best if off and off[best] < NEAR_BY else None

    def _disturbed(self, thing: int, before: TableView, now: TableView) -> tuple[int, ...]:
        """Things that are not where they were, but somewhere near; what the arm hides now was not disturbed."""
        if not len(now.things.location):
            return ()
        places = before.things.location
        away = np.linalg.norm(now.things.location[:, None] - places[None], axis=2)
        new = np.flatnonzero(away.min(axis=1) > DISTURBED)
        return tuple(
            before.numbers[index]
            for index in range(len(places))
            if index != thing
            and away[:, index].min() > DISTURBED
            and any(away[other, index] < NEAR_BY and alike(before, index, now, int(other)) for other in new)
        )


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
