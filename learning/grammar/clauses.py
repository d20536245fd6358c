"""Readings of a whole sentence: clauses of an action, an entity and a destination, and what they would do.

The sentence is walked once from left to right. A clause takes its action, its entity and its destination in any order,
each at most once; what lies between them is passed over. Two clauses make a sequence: take something, then put it.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import cast

from learning.grammar.actions import ActionTable
from learning.grammar.innate import ONE
from learning.grammar.phrase import Feature, Phrase
from learning.grammar.phrase_chart import Denotation, Modifier, PhraseChart
from learning.grammar.scene import bits

BEAM = 25
"""Partial readings kept after every word."""
GAP = 9.0
NO_REFERENT: Feature = ("reference", "to nothing")
LINKED: Feature = ("clause", "linked")
"""Of a second clause with a word before it that is passed over."""
PARTS = ("action", "entity", "modifier", "shift")

Moves = tuple[tuple[int, int], ...]
"""Moved things in rising order, each with the placements it may end at (0: it stays in the gripper)."""


@dataclass(slots=True, eq=False)
class _Partial:
    """A reading of the words so far."""

    score: float
    order: str
    action: Phrase | None
    entity: Phrase | None
    goal: Phrase | None
    features: tuple[Feature, ...]
    opening: "_Partial | None"
    linked: bool = False

    def key(self) -> tuple[object, ...]:
        """What matters for how it can go on."""
        return (
            self.order,
            None if self.action is None else self.action.concept,
            None if self.entity is None else self.entity.meaning,
            None if self.goal is None else self.goal.meaning,
            None if self.opening is None else self.opening.key(),
            self.linked and self.opening is None and self.entity is not None,
        )


@dataclass(frozen=True, slots=True)
class Clause:
    """Parts of one clause, each None where it is not said."""

    action: Phrase
    entity: Phrase | None
    goal: Phrase | None

    @property
    def parts(self) -> tuple[Phrase, ...]:
        """Its parts in the order of the words."""
        said = [part for part in (self.action, self.entity, self.goal) if part is not None]
        return tuple(sorted(said, key=lambda part: part.first))


@dataclass(frozen=True, slots=True)
class CommandReading:
    """A reading of a whole sentence.

    Attributes:
        clauses: One clause, or a taking and a putting.
        starts_held: Whether the thing is in the gripper at the start.
        ends_held: Whether it stays there.
        action: Concept of the action as a whole.
        moves: What it would do.
        score: Sum of weights.
        features: Features that are not of its phrases.
    """

    clauses: tuple[Clause, ...]
    starts_held: bool
    ends_held: bool
    action: int
    moves: Moves
    score: float
    features: tuple[Feature, ...]

    @property
    def choices(self) -> int:
        """How many different moves it allows."""
        return sum(max(1, places.bit_count()) for _, places in self.moves)

    def does(self, moved: int, placement: int | None) -> bool:
        """Whether one of its moves is this one."""
        for thing, places in self.moves:
            if thing == moved:
                return placement is None if self.ends_held else placement is not None and bool(places >> placement & 1)
        return False

    def phrases(self) -> Iterator[Phrase]:
        """Walk the parts of its clauses."""
        for clause in self.clauses:
            yield from clause.parts

    def all_features(self) -> Iterator[Feature]:
        """Walk all features, with the words that were passed over left out."""
        yield from self.features
        for phrase in self.phrases():
            yield from phrase.all_features()


def read_clauses(
    chart: PhraseChart, actions: ActionTable, weight: Callable[[Feature], float], beam: int = BEAM
) -> list[CommandReading]:
    """Give the readings of a sentence that the scene allows, best first, one for each set of moves."""
    return _Reader(chart, actions, weight, beam).readings()


class _Reader:
    def __init__(self, chart: PhraseChart, actions: ActionTable, weight: Callable[[Feature], float], beam: int) -> None:
        self.chart = chart
        self.scene = chart.scene
        self.actions = actions
        self.weight = weight
        self.beam = beam
        self._goals: dict[tuple[Modifier, int], int] = {}

    def readings(self) -> list[CommandReading]:
        length = self.chart.length
        states: list[dict[tuple[object, ...], _Partial]] = [{} for _ in range(length + 1)]
        start = _Partial(0.0, "", None, None, None, (), None)
        states[0][start.key()] = start
        cells = self.chart.cells
        passed = self.chart.passed
        for position in range(length):
            partials = sorted(states[position].values(), key=lambda p: p.score, reverse=True)[: self.beam]
            if not partials:
                continue
            lowest = partials[0].score - GAP
            partials = [partial for partial in partials if partial.score >= lowest]
            gap = passed[position + 1] - passed[position]
            for partial in partials:
                self._add(
                    states[position + 1],
                    _Partial(
                        partial.score + gap,
                        partial.order,
                        partial.action,
                        partial.entity,
                        partial.goal,
                        partial.features,
                        partial.opening,
                        True,
                    ),
                )
            for after in range(position + 1, length + 1):
                cell = cells[position][after]
                if cell is None:
                    continue
                for label in PARTS:
                    for phrase in cell.get(label, ()):
                        for partial in partials:
                            more = self._extended(partial, label, phrase)
                            if more is not None:
                                self._add(states[after], more)
        best: dict[tuple[object, ...], CommandReading] = {}
        for partial in states[length].values():
            reading = self._reading(partial)
            if reading is not None:
                key = (reading.action, reading.moves)
                known = best.get(key)
                if known is None or known.score < reading.score:
                    best[key] = reading
        return sorted(best.values(), key=lambda reading: -reading.score)

    def _add(self, state: dict[tuple[object, ...], _Partial], partial: _Partial) -> None:
        key = partial.key()
        known = state.get(key)
        if known is None or known.score < partial.score:
            state[key] = partial

    def _extended(self, partial: _Partial, label: str, phrase: Phrase) -> _Partial | None:
        score = partial.score + phrase.score
        order, features = partial.order, partial.features
        action, entity, goal, opening = partial.action, partial.entity, partial.goal, partial.opening
        if label == "action":
            if action is not None:
                # A second action opens a second clause.
                if opening is not None or entity is None or goal is not None:
                    return None
                clause: Feature = ("clause", "first", order)
                opening = _Partial(0.0, order, action, entity, None, (), None)
                action, entity, goal, order = phrase, None, None, ""
                features = (*features, clause)
                score += self.weight(clause)
                if partial.linked:
                    features = (*features, LINKED)
                    score += self.weight(LINKED)
            else:
                action = phrase
            order += "a"
        elif label == "entity":
            if entity is not None:
                return None
            refers = cast(Denotation, phrase.meaning)[2]
            if refers != (opening is not None):
                return None
            if opening is None and goal is None and _refers_back(phrase):
                features = (*features, NO_REFERENT)
                score += self.weight(NO_REFERENT)
            entity = phrase
            order += "e"
        else:
            if goal is not None:
                return None
            goal = phrase
            order += "g"
        return _Partial(score, order, action, entity, goal, features, opening, _trails(phrase))

    def _reading(self, partial: _Partial) -> CommandReading | None:
        if partial.action is None or partial.action.concept is None:
            return None
        if partial.entity is None and partial.opening is None:
            return None
        clause: Feature = ("clause", "second" if partial.opening else "only", partial.order)
        features: list[Feature] = [*partial.features, clause]
        number = partial.action.concept.number
        second = Clause(partial.action, partial.entity, partial.goal)
        clauses: tuple[Clause, ...] = (second,)
        if partial.opening is None:
            entity = partial.entity
            starts_held, ends_held = self.actions.starts_held[number], self.actions.ends_held[number]
        else:
            taking = partial.opening
            if taking.action is None or taking.action.concept is None:
                return None
            composed = self.actions.composed.get((taking.action.concept.number, number))
            if composed is None:
                return None
            clauses = (Clause(taking.action, taking.entity, None), second)
            entity = taking.entity
            number = composed
            starts_held = ends_held = False
        if entity is None:
            return None
        moves = self._moves(entity, partial.goal, starts_held, ends_held)
        if not moves:
            return None
        choices = sum(max(1, places.bit_count()) for _, places in moves)
        features.append(("moves", _bucket(choices)))
        score = partial.score + self.weight(clause) + self.weight(features[-1])
        return CommandReading(clauses, starts_held, ends_held, number, moves, score, tuple(features))

    def _moves(self, entity: Phrase, goal: Phrase | None, starts_held: bool, ends_held: bool) -> Moves:
        scene = self.scene
        elements, nearest, _ = cast(Denotation, entity.meaning)
        moved = elements & scene.blocks
        moved &= scene.held if starts_held else scene.clear & ~scene.held
        if not moved:
            return ()
        if nearest:
            moved = scene.nearest_to_robot(moved)
        if ends_held:
            return () if goal is not None or starts_held else tuple((thing, 0) for thing in bits(moved))
        if goal is None:
            if not starts_held:
                return ()
            # What is let go without a word about where falls straight down.
            return tuple((thing, 1 << scene.columns[thing]) for thing in bits(moved))
        found = []
        meaning = cast(Modifier, goal.meaning)
        for thing in bits(moved):
            places = self._places(meaning, thing)
            own = 1 << scene.columns[thing]
            if starts_held:
                places = places & own or places
            else:
                places &= ~own
            if places:
                found.append((thing, places))
        return tuple(found)

    def _places(self, goal: Modifier, thing: int) -> int:
        # Nothing is put on itself: what may be meant depends on the thing where it is among what is spoken of.
        key = (goal, thing if goal.nearest or not goal.ground or goal.ground >> thing & 1 else -1)
        known = self._goals.get(key)
        if known is None:
            known = self._goals[key] = self._find_places(goal, thing) & self.scene.usable
        return known

    def _find_places(self, goal: Modifier, thing: int) -> int:
        scene = self.scene
        ground = goal.ground & ~(1 << thing)
        if goal.steps:
            if goal.ground:
                ground = scene.nearest(ground, 1 << thing) if goal.nearest and ground else ground
            else:
                ground = 1 << thing
            return scene.shifted(goal.relation, goal.steps, ground)
        if goal.nearest and ground:
            open_ones = sum(
                1 << each for each in bits(ground) if scene.landing(goal.relation, 1 << each) & scene.usable
            )
            ground = scene.nearest(open_ones or ground, 1 << thing)
        return scene.landing(goal.relation, ground)


def _trails(phrase: Phrase) -> bool:
    """Whether the last word of a phrase is one that is passed over."""
    while phrase.children:
        phrase = phrase.children[-1]
    return phrase.used[-1] + 1 < phrase.after


def _refers_back(entity: Phrase) -> bool:
    """Whether an entity is called another of the sort that was spoken of before."""
    while entity.children and entity.children[0].label == entity.label:
        entity = entity.children[0]
    return any(child.concept == ONE for child in entity.children)


def _bucket(choices: int) -> str:
    return str(choices) if choices < 4 else str(2 ** int(math.log2(choices)))
