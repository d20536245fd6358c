"""One step of a command understood on the board: what to do, or which answer to give instead."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

from executor.doubts import absent, action_words, buried, far_fetched, hand_obstacle, heard, passed_over, refers
from executor.execution.answer import Answer, OnAmbiguous
from executor.execution.board_blocks import blocking, goal_of
from executor.execution.board_names import BoardNames
from executor.execution.understood import Option, Referent, Understood, offer, parts, question, quoted
from executor.execution.unobstructed import Unobstructed
from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import BoardElements
from learning.grammar.clauses import CommandReading
from learning.grammar.phrase_chart import Modifier
from learning.grammar.reading_tree import tree_of
from learning.grammar.scene import bits
from learning.grounding.reading_learner import ReadingLearner, Readings
from learning.interpretation import Interpreter
from learning.interpretation.interpretation import Interpretation
from learning.interpretation.reading_interpreter import moves_of

if TYPE_CHECKING:
    from learning import Knowledge
    from learning.grammar.rcl import RclNode
    from learning.interpretation import Goal
    from learning.percept import Percept
    from learning.perception import Observation

MAKESHIFT = 2.0
"""So much better, in log weight, a reading must be that the scene does not allow before the best that it allows is
given up: of 640 commands of people this gave up one that was right and one that was wrong."""


@dataclass(frozen=True, slots=True)
class BoardView:
    """The board as it was seen once.

    Attributes:
        observation: Tracks.
        percept: The same in learned concepts.
    """

    observation: "Observation"
    percept: "Percept"


class BoardUnderstanding:
    """Understands steps on the board.

    Args:
        knowledge: What was learned; it is not changed.
        on_ambiguous: What to do where several things or places fit.
    """

    def __init__(self, knowledge: "Knowledge", on_ambiguous: OnAmbiguous = OnAmbiguous.ASK) -> None:
        self.knowledge = knowledge
        self.on_ambiguous = on_ambiguous
        self.names = BoardNames(knowledge)
        self._interpreter = Interpreter(knowledge)
        self._freed_reading: tuple[tuple[str, ...], Percept, Readings] | None = None

    def understand(
        self, words: tuple[str, ...], view: BoardView, last: int | None = None, choice: int | None = None
    ) -> Understood:
        """Understand one step in a scene.

        Args:
            words: The words.
            view: The scene.
            last: Track number of what was handled last, which a reference may mean.
            choice: Track number of what was meant where several things fit.
        """
        found = self._understand(words, view, choice)
        if found.clear or found.answer is Answer.UNKNOWN_WORD or last is None:
            return found
        if not any(self._refers(word) for word in words) or last not in view.percept.object_ids:
            return found
        named = self._renamed(words, view, last)
        again = self._understand(named, view, last)
        return again if again.clear or again.blocked or again.answer is Answer.IMPOSSIBLE else found

    def _understand(self, words: tuple[str, ...], view: BoardView, only: int | None) -> Understood:
        reading = self._interpreter.interpret(" ".join(words), view.percept)
        told = heard(reading)
        if reading.unknown:
            reason = offer(reading.unknown)
            return Understood(words, Answer.UNKNOWN_WORD, reason, told, reading.tree, unknown=reading.unknown)
        passed = passed_over(words, reading.tree, self.knowledge) if reading.understood else ()
        if not reading.understood or passed:
            return self._explained(words, view, reading, told, passed)
        best = self._reading(words, view.percept, reading.goals[0])
        if far_fetched(words, reading.tree, self.knowledge):
            return self._explained(words, view, reading, told, ())
        if best is not None and self._is_makeshift(words, view.percept, best, reading.goals[0]):
            return self._explained(words, view, reading, told, ())
        return self._chosen(words, view, reading, best, told, only)

    def _is_makeshift(self, words: tuple[str, ...], percept: "Percept", best: CommandReading, goal: "Goal") -> bool:
        """Whether a sentence would clearly be read otherwise if nothing were in the way.

        What the scene does not allow has no reading in it, so that the best one left may be far from what is meant.
        """
        found = self._read_freed(words, percept).readings
        if not found:
            return False
        move = self.move(percept, goal)
        here = max([self._plausible(best), *(self._plausible(each) for each in found if each.does(*move))])
        return max(self._plausible(each) for each in found) > here + MAKESHIFT

    def _plausible(self, reading: CommandReading) -> float:
        """The weight of a reading, however many moves it leaves open: that depends on what is in the way."""
        language = self.knowledge.language
        if not isinstance(language, ReadingLearner):
            return reading.score
        return reading.score - sum(language.weights.of(each) for each in reading.features if each[0] == "moves")

    # Understood: which of the things that fit.

    def _chosen(
        self,
        words: tuple[str, ...],
        view: BoardView,
        reading: Interpretation,
        best: CommandReading | None,
        told: str,
        only: int | None,
    ) -> Understood:
        percept = view.percept
        goals = reading.goals
        things = reading.object_candidates
        if only is not None and only in things:
            things = (only,)
            goals = (replace(goals[0], object_id=only),)
        grounds = () if best is None else _grounds(best, len(percept.object_ids))
        referents = _referents(words, reading.tree, things, [int(percept.object_ids[i]) for i in grounds])
        found = Understood(words, None, "", told, reading.tree, goals, referents, share=reading.confidence)
        if self.on_ambiguous is OnAmbiguous.BEST:
            return found
        if len(things) > 1:
            return self._asked(found, view, [_index(percept, each) for each in things], "entity")
        rivals = self._rival_grounds(best, percept, goals[0].object_id)
        if len(rivals) < 2 and best is not None:
            one_each = self._one_of_several(words, percept, best)
            rivals = self._rival_grounds(one_each, percept, goals[0].object_id)
        if len(rivals) < 2:
            return found
        for index, mask in rivals.items():
            if only == int(percept.object_ids[index]):
                place = percept.placements[bits(mask)[0]]
                return replace(found, goals=(replace(goals[0], position=place),))
        return self._asked(found, view, list(rivals), "destination")

    def _asked(self, found: Understood, view: BoardView, indices: Sequence[int], role: str) -> Understood:
        names = self.names.apart(view.observation, view.percept, indices)
        options = tuple(
            Option(int(view.percept.object_ids[index]), name) for index, name in zip(indices, names, strict=True)
        )
        node = next(parts(found.tree, role, ({"entity": "destination"}.get(role, "entity"),)), None)
        said = f"“{' '.join(found.words[node.first - 1 : node.last])}”" if node is not None else ""
        return replace(found, answer=Answer.AMBIGUOUS, reason=question(said, options), options=options)

    def _rival_grounds(self, reading: CommandReading | None, percept: "Percept", moved: int) -> dict[int, int]:
        """Indices of the blocks that the destination may be told by, with the places of each, if they differ."""
        goal = None if reading is None else reading.clauses[-1].goal
        if goal is None:
            return {}
        meaning = cast(Modifier, goal.meaning)
        if meaning.nearest or not meaning.ground:
            return {}
        scene = self._scene(percept)
        own = 1 << scene.columns[_index(percept, moved)]
        places: dict[int, int] = {}
        for ground in bits(meaning.ground & ~(1 << _index(percept, moved))):
            if ground >= len(scene.columns) or scene.place(ground) is not None:
                return {}  # a place of the board: any part of it will do
            if meaning.steps:
                mask = scene.shifted(meaning.relation, meaning.steps, 1 << ground)
            else:
                mask = scene.landing(meaning.relation, 1 << ground)
            if mask & scene.usable & ~own:
                top = ground if ground < scene.count else scene.support[scene.columns[ground]]
                places[mask & scene.usable] = top
        return {top: mask for mask, top in places.items()}

    def _one_of_several(
        self, words: tuple[str, ...], percept: "Percept", best: CommandReading
    ) -> CommandReading | None:
        """A reading of a destination as one block of several, that is only liked less for leaving open which of them.

        "The cube" can be said of a tower of cubes, and there may be one tower only.
        """
        scene, moved = self._scene(percept), {thing for thing, _ in best.moves}
        towers = [each for each in _told_by(best) if scene.place(each) is None]
        if not towers or _grounds(best, scene.count):
            return None
        found = (each for each in self._read(words, scene).readings if _grounds(each, scene.count))
        same = (each for each in found if {thing for thing, _ in each.moves} == moved and each.action == best.action)
        return next((each for each in same if self._plausible(each) > self._plausible(best)), None)

    # Not understood, or not as a whole: why.

    def _explained(
        self,
        words: tuple[str, ...],
        view: BoardView,
        reading: Interpretation,
        told: str,
        passed: tuple[str, ...],
    ) -> Understood:
        knowledge, percept = self.knowledge, view.percept
        found = Understood(words, Answer.IMPOSSIBLE, "", told, reading.tree, share=reading.confidence)
        if missing := absent(words, knowledge, percept):
            return replace(found, reason=f"nothing here is {quoted(missing)}, so I do nothing")
        freed = self._freed(words, view, told)
        if freed is not None:
            return freed
        if percept.held is not None and self._reads_well(words, replace(Arrangement.of(percept), held=None)):
            name = self.names.name(view.observation, percept, percept.held)
            return replace(found, reason=f"the gripper holds {name}; tell me where to put that first")
        if below := buried(words, knowledge, percept):
            return replace(found, reason=f"another block stands on what is {quoted(below)}; move that one first")
        if reading.unheeded or passed:
            lost = tuple(dict.fromkeys((*reading.unheeded, *passed)))
            return replace(found, reason=f"nothing here fits {quoted(lost)} as it is said, so I do nothing")
        if why := hand_obstacle(words, knowledge, percept):
            return replace(found, reason=why)
        if action_words(words, knowledge):
            return replace(found, reason="no block and no place here fit what is said, so I do nothing")
        reason = "these words do not make a command that I understand" if reading.understood else reading.explanation
        return replace(found, answer=Answer.REFUSED, reason=reason)

    def _reads_well(self, words: tuple[str, ...], arrangement: Arrangement) -> bool:
        """Whether words are a whole command in some other scene."""
        found = self._read(words, BoardElements(arrangement, self.knowledge.bearing_shapes()))
        if not found.readings:
            return False
        tree = tree_of(found.readings[0], found.kept)
        return not (passed_over(words, tree, self.knowledge) or far_fetched(words, tree, self.knowledge))

    def _freed(self, words: tuple[str, ...], view: BoardView, told: str) -> Understood | None:
        """What would be meant if nothing were in the way, and what is in the way; None if that is no command either."""
        percept = view.percept
        scene = Unobstructed(Arrangement.of(percept))
        found = self._read_freed(words, percept)
        if not found.readings:
            return None
        votes = moves_of(found)
        moved, place = max(votes, key=lambda each: votes[each])
        best = next(each for each in found.readings if each.does(moved, place))
        tree = tree_of(best, found.kept)
        if passed_over(words, tree, self.knowledge) or far_fetched(words, tree, self.knowledge):
            return None
        bearing = self.knowledge.bearing_shapes()
        goal = best.clauses[-1].goal
        meaning = None if goal is None else cast(Modifier, goal.meaning)
        blocked, base = blocking(scene, Arrangement.of(percept), bearing, moved, place, meaning)
        if not blocked:
            if base is None or Arrangement.of(percept).shapes[base] in bearing:
                return None
            reason = f"nothing can stand on {self.names.name(view.observation, percept, base)}, so I do nothing"
            return Understood(words, Answer.IMPOSSIBLE, reason, told, tree)
        graphlet = self.knowledge.spaces.actions[best.action]
        goals = (goal_of(percept, graphlet, moved, place, base),)
        names = [self.names.name(view.observation, percept, index) for index in blocked]
        what = self.names.name(view.observation, percept, moved)
        on_it = any(scene.columns[index] == scene.columns[moved] for index in blocked)
        target = what if on_it else f"the place where {what} should go"
        ids = tuple(int(percept.object_ids[index]) for index in blocked)
        things = tuple(int(percept.object_ids[each]) for each, _ in best.moves)
        grounds = [int(percept.object_ids[index]) for index in _grounds(best, scene.count)]
        verb = "is" if len(names) == 1 else "are"
        reason = f"{' and '.join(names)} {verb} in the way of {target}: move that first, or let me clear it (--clear)"
        understood = Understood(
            words,
            Answer.IMPOSSIBLE,
            reason,
            told,
            tree,
            goals,
            _referents(words, tree, things, grounds),
            blocked=ids,
        )
        if len(things) > 1 and self.on_ambiguous is OnAmbiguous.ASK:
            return self._asked(understood, view, [index for index, _ in best.moves], "entity")
        return understood

    # Words.

    def _refers(self, word: str) -> bool:
        return refers(word, self.knowledge)

    def _renamed(self, words: tuple[str, ...], view: BoardView, last: int) -> tuple[str, ...]:
        """The words, with what a reference means in its place."""
        looks = self.names.looks(view.percept, _index(view.percept, last)).split()
        return tuple(new for word in words for new in (looks if self._refers(word) else [word]))

    def _scene(self, percept: "Percept") -> BoardElements:
        return BoardElements(Arrangement.of(percept), self.knowledge.bearing_shapes())

    def _reading(self, words: tuple[str, ...], percept: "Percept", goal: "Goal") -> CommandReading | None:
        """The best reading that makes a move."""
        move = self.move(percept, goal)
        return next((each for each in self._read(words, self._scene(percept)).readings if each.does(*move)), None)

    def _read(self, words: tuple[str, ...], scene: BoardElements) -> Readings:
        language = self.knowledge.language
        if not isinstance(language, ReadingLearner):
            return Readings((), ())
        return language.read(words, scene, self.knowledge.action_table())

    def _read_freed(self, words: tuple[str, ...], percept: "Percept") -> Readings:
        """How a sentence would be read if nothing were in the way; the last one is remembered."""
        if self._freed_reading is None or self._freed_reading[0] != words or self._freed_reading[1] is not percept:
            found = self._read(words, Unobstructed(Arrangement.of(percept)))
            self._freed_reading = (words, percept, found)
        return self._freed_reading[2]

    def move(self, percept: "Percept", goal: "Goal") -> tuple[int, int | None]:
        """A goal as indices of thing and placement."""
        moved = _index(percept, goal.object_id)
        if goal.position is None:
            return moved, None
        return moved, int(((percept.placements - goal.position) ** 2).sum(axis=1).argmin())


def _told_by(reading: CommandReading) -> list[int]:
    """Indices of the blocks, towers and places that a destination is told by."""
    goal = reading.clauses[-1].goal
    return [] if goal is None else list(bits(cast(Modifier, goal.meaning).ground))


def _grounds(reading: CommandReading, count: int) -> list[int]:
    """Indices of the blocks, of so many, that a destination is told by."""
    return [each for each in _told_by(reading) if each < count]


def _referents(
    words: tuple[str, ...], tree: "RclNode | None", things: Sequence[int], grounds: Sequence[int]
) -> tuple[Referent, ...]:
    found = []
    for role, other, means in (("entity", "destination", things), ("destination", "entity", grounds)):
        for node in parts(tree, role, (other,)):
            said = " ".join(words[node.first - 1 : node.last])
            found.append(Referent(role, said, node.first, node.last, tuple(int(each) for each in means)))
    return tuple(found)


def _index(percept: "Percept", object_id: int) -> int:
    return [int(each) for each in percept.object_ids].index(object_id)
