"""What is made of the words of a step at a table: things, places, and why it is not acted on."""

from dataclasses import dataclass, replace
from itertools import islice
from typing import TYPE_CHECKING

from executor.actions.quantities import least_travel
from executor.execution.answer import Answer, OnAmbiguous
from executor.execution.understood import Option, Referent, Understood, offer, offer_again, parts, question, quoted
from executor.lexicon import entry_of
from executor.tables.clearing import covering, in_the_way
from executor.tables.places import Spot, best_apart, spots_for
from executor.tables.table_names import TableNames
from executor.tables.table_view import TableView
from learning.concept_id import Concept
from learning.grounding.scripts import script_of
from learning.grounding.table_scene import SIDE_PLACES
from learning.interpretation.interpretation import Goal
from learning.interpretation.table_interpreter import TableGoal, TableInterpreter, TableReading

if TYPE_CHECKING:
    from learning import Knowledge

OFTEN, FAR_FETCHED = 10.0, 0.05
"""A word that meant something so often is not taken for what it meant in a smaller share of these readings."""


@dataclass(frozen=True, slots=True)
class TableUnderstood(Understood):
    """How one step at a table was understood.

    Attributes:
        reading: What the words say here.
        spots: Places for the thing, the best first; empty where it goes nowhere.
    """

    reading: TableReading | None = None
    spots: tuple[Spot, ...] = ()


class TableUnderstanding:
    """Understands steps by what was learned."""

    def __init__(self, knowledge: "Knowledge", on_ambiguous: OnAmbiguous = OnAmbiguous.ASK) -> None:
        """Use this knowledge.

        Args:
            knowledge: What was learned.
            on_ambiguous: What to do where several things fit.
        """
        self.knowledge = knowledge
        self.on_ambiguous = on_ambiguous
        self._interpreter = TableInterpreter(knowledge)
        self._names = TableNames(knowledge)

    def read(self, words: tuple[str, ...], view: TableView, last: int | None, choices: tuple[int, ...]) -> TableReading:
        """Read a step.

        Args:
            words: What was said.
            view: The table.
            last: Number of the thing that was spoken of before, if one was.
            choices: Numbers of the things that were chosen where several fitted.
        """
        reading = self._interpreter.interpret(words, view.observation, held=view.held, last=view.index_of(last))
        return self._chosen(reading, view, choices)

    def found(self, view: TableView, reading: TableReading, broken_off: bool) -> TableUnderstood:
        """What words say, with its answer where it is not acted on.

        Args:
            view: The table.
            reading: How they are read.
            broken_off: Whether the last action was left off half done, so that the hand may hold anything.
        """
        words = reading.words
        answer, reason = self._doubt(reading, view, broken_off) or (None, "")
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

    def placed(self, found: TableUnderstood, view: TableView, reading: TableReading) -> TableUnderstood:
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
        language, meant = self.knowledge.table_language, self.sound(reading)
        least = (
            0.0 if reading.action is None else least_travel(self.knowledge.spaces.actions.statistics(reading.action))
        )
        wanted = spots_for(meant, thing, view.things, self.knowledge.spaces, language.resting, least)
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
            reason=f"{why}: {self.named(numbers, reading, view)}",
            goals=(replace(goal, position=spots[0].position if spots else None),),
            spots=spots,
            blocked=numbers,
        )

    def sound(self, reading: TableReading) -> TableGoal:
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

    def _doubt(self, reading: TableReading, view: TableView, broken_off: bool) -> tuple[Answer, str] | None:
        """Why a step is not acted on; None when it can be."""
        if reading.unknown:
            return Answer.UNKNOWN_WORD, offer(reading.unknown)
        if reading.unlearned:
            word = reading.unlearned[0]
            return Answer.UNKNOWN_WORD, offer_again(word, entry_of(self.knowledge, word).heard)
        if strained := self._strained(reading):
            return Answer.IMPOSSIBLE, f"nothing here is {quoted(strained)}"
        if reading.tree is None or reading.action is None:
            return Answer.REFUSED, "no word says what to do" if reading.tree is not None else reading.explanation
        if not reading.things:
            return Answer.IMPOSSIBLE, _nothing_is(reading, "nothing here is what the words say")
        if reading.nowhere:
            return Answer.IMPOSSIBLE, _nothing_is(reading, "what it shall go to is not here")
        if (len(reading.things) > 1 or len(_grounds(reading)) > 1) and self.on_ambiguous is OnAmbiguous.ASK:
            return Answer.AMBIGUOUS, ""
        states = self.knowledge.spaces.actions[reading.action].states
        if view.held is not None and view.held not in reading.things and not broken_off:
            return Answer.IMPOSSIBLE, "the hand holds another thing; say where to put that one first"
        set_down = any(state.holds and not state.raised for state in states[1:]) and not states[-1].holds
        if set_down and view.held is None and reading.goal is None and self._tells_where(reading.words):
            if reading.absent:
                return Answer.IMPOSSIBLE, _nothing_is(reading, "")
            passed = f": I could make nothing of {quoted(reading.unheeded)}" if reading.unheeded else ""
            return Answer.REFUSED, f"where it shall go was not understood{passed}"
        return None

    def _strained(self, reading: TableReading) -> tuple[str, ...]:
        """Words that are read as what they hardly ever meant: what they mostly mean is not here."""
        tongue = self.knowledge.table_language.tongues.get(script_of(reading.words))
        if reading.tree is None or tongue is None:
            return ()
        found = []
        for node in reading.tree.nodes():
            said = " ".join(reading.words[node.first - 1 : node.last])
            if node.concept is None or said not in tongue.grounding.counts:
                continue
            row = tongue.grounding.counts[said]
            meant = sum(count for concept, count in row.items() if concept is not None)
            if row.get(None, 0.0) < meant >= OFTEN and row.get(node.concept, 0.0) < FAR_FETCHED * meant:
                found.append(said)  # a word that mostly means nothing may say anything now and then
        return tuple(found)

    def _chosen(self, reading: TableReading, view: TableView, choices: tuple[int, ...]) -> TableReading:
        """A reading with what was chosen where several things fitted, as what is done or as where it goes."""
        for index in map(view.index_of, choices):
            if len(reading.things) > 1 and index in reading.things:
                reading = replace(reading, things=(index,))
            elif reading.goal is not None and index in _grounds(reading):
                reading = replace(reading, goal=replace(reading.goal, grounds=(index,)))
        return reading

    def _tells_where(self, words: tuple[str, ...]) -> bool:
        """Whether people who speak this language say where things go."""
        tongue = self.knowledge.table_language.tongues[script_of(words)]
        return "destination" in tongue.grammar.rules

    def again(self, understood: TableUnderstood, before: TableView, now: TableView) -> TableUnderstood:
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
        return self.placed(replace(plain, reading=reading), now, reading)

    def named(self, numbers: tuple[int, ...], reading: TableReading, view: TableView) -> str:
        """That some things are in the way, by name."""
        indices = [index for index in map(view.index_of, numbers) if index is not None]
        names = self._names.apart(script_of(reading.words), view.observation, indices)
        return f"{' and '.join(names)} {'is' if len(names) == 1 else 'are'} in the way"


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
