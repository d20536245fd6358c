"""What may be said of a move on the board: the ways to tell what is moved, by which actions, and where to."""

from collections.abc import Iterator

from learning.concept_id import ACTION_SPACE, Concept
from learning.grammar.actions import ActionTable
from learning.grammar.board_elements import BoardElements
from learning.grammar.innate import (
    ABOVE,
    BESIDE,
    COUNTS,
    IT,
    LARGEST_COUNT,
    NEAREST,
    SIDE_STEPS,
    SIDES,
    UNIT,
    WHOLE,
    WITHIN,
)
from learning.grammar.rcl import RclNode
from learning.saying.board_references import MOST_GROUNDS, BoardReferences, leaf
from learning.saying.ordering import meaning
from learning.saying.reference import Destination, Reference
from twin.board import CELLS


class BoardEvents:
    """Meanings of moves in one scene."""

    def __init__(self, scene: BoardElements, actions: ActionTable, references: BoardReferences) -> None:
        """Look at a scene."""
        self.scene = scene
        self.actions = actions
        self.references = references

    def movable(self, thing: int, action: int) -> list[Reference]:
        """Ways to tell the block that an action is done to from all others that it can be done to."""
        scene = self.scene
        reach = scene.held if self.actions.starts_held[action] else scene.clear & ~scene.held
        return [each for each in self.references.of_thing(thing) if each.mask & scene.blocks & reach == 1 << thing]

    def destinations(self, moved: int, placement: int, action: int) -> list[Destination]:
        """Ways to tell where a block goes, each of which leaves one place; short ones first."""
        scene = self.scene
        own = 0 if self.actions.starts_held[action] else 1 << scene.columns[moved]
        found = []
        for each in (*self._by_landmark(moved, placement), *self._by_steps(moved, placement)):
            if each.mask & scene.usable & ~own == 1 << placement:
                found.append(each)
        return sorted(found, key=lambda each: each.size)

    def _by_landmark(self, moved: int, placement: int) -> Iterator[Destination]:
        scene, references = self.scene, self.references
        support = scene.support[placement]
        if support >= 0:
            for ground in (*references.of_thing(support), *references.collectives_with(support)):
                yield from self._related(ABOVE, ground, moved)
        for bit, ground in references.places():
            place = scene.place(bit)
            if place is not None and (place.cells >> placement & 1 or place.kind == WHOLE):
                for relation in (WITHIN, ABOVE, NEAREST):
                    yield from self._related(relation, ground, moved)
        for side, block in references.neighbours(placement):
            if block != moved:
                for ground in references.of_thing(block):
                    yield from self._related(side, ground, moved)
                    yield from self._related(BESIDE, ground, moved)

    def _related(self, relation: Concept, ground: Reference, moved: int) -> Iterator[Destination]:
        if relation in self.references.named:
            tree = meaning("spatial-relation", leaf(relation), ground.tree)
            yield Destination(tree, self.scene.landing(relation, ground.mask & ~(1 << moved)), 1 + ground.size)

    def _by_steps(self, moved: int, placement: int) -> Iterator[Destination]:
        """So many steps to one side of where the block is, or of another block."""
        scene, references = self.scene, self.references
        x, y = divmod(placement, CELLS)
        for side, (dx, dy) in zip(SIDES, SIDE_STEPS, strict=True):
            for steps in range(1, LARGEST_COUNT + 1):
                a, b = x - steps * dx, y - steps * dy
                count = COUNTS[steps - 1]
                if not (0 <= a < CELLS and 0 <= b < CELLS) or not {count, UNIT, side} <= references.named:
                    continue
                measure = meaning("measure", leaf(count), leaf(UNIT))
                if scene.columns[moved] == a * CELLS + b:
                    tree = meaning("spatial-relation", measure, leaf(side))
                    yield Destination(tree, scene.shifted(side, steps, 1 << moved), 3)
                block = scene.support[a * CELLS + b]
                if block >= 0 and block != moved:
                    for ground in references.of_thing(block)[:MOST_GROUNDS]:
                        tree = meaning("spatial-relation", measure, leaf(side), ground.tree)
                        mask = scene.shifted(side, steps, ground.mask & ~(1 << moved))
                        yield Destination(tree, mask, 3 + ground.size)

    def commands(self, action: int, thing: Reference, goal: Destination | None) -> Iterator[RclNode]:
        """Whole meanings: one event, or a taking and a putting where the action amounts to both."""
        where = () if goal is None else (meaning("destination", goal.tree),)
        yield meaning("event", _action(action), thing.tree, *where)
        if goal is None:
            return
        for (first, second), composed in self.actions.composed.items():
            if composed == action:
                taking = meaning("event", _action(first), thing.tree)
                for reference in ((meaning("entity", leaf(IT)),), ()):
                    yield meaning("sequence", taking, meaning("event", _action(second), *reference, *where))


def _action(number: int) -> RclNode:
    return leaf(Concept(ACTION_SPACE, number))
