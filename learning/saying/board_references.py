"""Referring expressions for things and places of the board: properties first, then relations to landmarks.

All short descriptions that fit a thing are tried, as in the full brevity method of Dale and Reiter (1995): what it
looks like and how it ranks among its likes, then where it is, by things and places that are referred to likewise.
"""

from collections.abc import Iterable, Iterator
from functools import cached_property

from learning.concept_id import Concept
from learning.grammar.board_elements import COLUMNS, BoardElements
from learning.grammar.description import MOST_COLOURS, Description, senses
from learning.grammar.innate import (
    ABOVE,
    BESIDE,
    CENTRE,
    COLLECTIVE,
    CORNER,
    EDGE,
    EXTREMES,
    NEAREST,
    REGION,
    SIDE_STEPS,
    SIDES,
    SINGLE,
    WHOLE,
    WITHIN,
)
from learning.grammar.rcl import RclNode
from learning.grammar.scene import bits
from learning.saying.ordering import meaning
from learning.saying.reference import Reference
from twin.board import CELLS

DEEPEST = 2
"""Things by which a thing is told are themselves told by others, so many times."""
MOST_GROUNDS = 4
"""Short ways to refer to a landmark that are tried, and as many that fit few things."""
MOST_NARROWED = 8
"""Ways to tell where a thing is that are narrowed down by one more landmark, where none tells it from all others."""
UNIQUE = ("thing", "thing, side", "collective", "place")
"""How a description that is said may be meant."""


class BoardReferences:
    """Referring expressions in one scene."""

    def __init__(
        self,
        scene: BoardElements,
        named: Iterable[Concept],
        together: frozenset[tuple[str, ...]],
        *,
        telling_where: bool = False,
    ) -> None:
        """Look at a scene.

        Args:
            scene: What there is.
            named: Concepts that have a name.
            together: What may be said of one thing together: labels, sorted.
            telling_where: Whether to tell where a thing is also if it is told from all others without.
        """
        self.scene = scene
        self._telling_where = telling_where
        self._together = together
        self.named = frozenset(named)
        self._known: dict[tuple[int, int], list[Reference]] = {}
        self._collectives: dict[int, list[Reference]] = {}

    def of_thing(self, thing: int, depth: int = DEEPEST) -> list[Reference]:
        """Ways to refer to a block, whatever else fits them; short ones first.

        Args:
            thing: Its index.
            depth: How many relations deep it may be told by others.
        """
        key = thing, depth
        if key not in self._known:
            plain = [each for description in self._descriptions(thing) for each in self._meant(description, thing)]
            found = list(plain)
            if depth > 0:
                landmarks = list(self._landmarks(thing, depth))
                where = [each for head in plain for each in self._located(head, thing, landmarks)]
                found += where
                narrow = sorted(where, key=lambda each: (each.mask.bit_count(), each.size))[:MOST_NARROWED]
                if narrow and narrow[0].mask != 1 << thing:
                    found += [each for head in narrow for each in self._located(head, thing, landmarks)]
            self._known[key] = sorted(found, key=lambda each: each.size)
        return self._known[key]

    def grounds(self, thing: int, depth: int) -> list[Reference]:
        """Ways to refer to a landmark: the shortest, and those that fit the fewest other things."""
        found = [each for each in self.of_thing(thing, depth) if self._sayable(each.tree)]
        narrow = sorted(found, key=lambda each: (each.mask.bit_count(), each.size))
        return list({id(each): each for each in (*found[:MOST_GROUNDS], *narrow[:MOST_GROUNDS])}.values())

    def _descriptions(self, thing: int) -> Iterator[Description]:
        """What a block looks like, alone or with a rank among its likes."""
        looks = [concept for concept in self.scene.looks(thing) if concept in self.named]
        shapes = [concept for concept in looks if concept.space == "shape"]
        colours = [concept for concept in looks if concept.space == "colour"]
        for shape in shapes:
            for told in ((), *((colour,) for colour in colours)):
                yield frozenset((shape, *told))
                for rank in (SINGLE, *SIDES, *EXTREMES):
                    if rank in self.named:
                        yield frozenset((shape, *told, rank))

    def _meant(self, description: Description, element: int) -> Iterator[Reference]:
        """The first sense of a description, if the element has it: others are not what listeners think of first."""
        sense = next((each for each in senses(description, self.scene) if each.feature in UNIQUE), None)
        if sense is None or sense.nearest or sense.idle or not sense.elements >> element & 1:
            return
        if self._sayable(tree := _entity(description)) or self._sayable(tree, "spatial-relation"):
            yield Reference(tree, sense.elements, len(description))

    def _sayable(self, entity: RclNode, *more: str) -> bool:
        """Whether the parts of an entity, and more, were ever said together."""
        return tuple(sorted((*(child.label for child in entity.children), *more))) in self._together

    @cached_property
    def _places(self) -> list[tuple[int, Reference]]:
        """Places with how they are referred to."""
        found = []
        for bit in bits(self.scene.places):
            place = self.scene.place(bit)
            if place is None or place.kind not in (CORNER, EDGE, CENTRE, REGION, WHOLE):
                continue
            concepts = frozenset((place.kind, *(SIDES[side] for side in place.sides)))
            if concepts <= self.named:
                mask = self.scene.landmarks(place.kind, place.sides)
                found.append((bit, Reference(_entity(concepts), mask, len(concepts))))
        return found

    def places(self) -> list[tuple[int, Reference]]:
        """Places with how they are referred to."""
        return self._places

    def collectives_with(self, block: int) -> list[Reference]:
        """Ways to refer to what stands on one another with a block in it."""
        if block not in self._collectives:
            self._collectives[block] = list(self._collective(block))
        return self._collectives[block]

    def _collective(self, block: int) -> Iterator[Reference]:
        column = self.scene.columns[block]
        tops = [block] if self.scene.held >> block & 1 else [self.scene.support[column], block]
        colours = [tuple(sorted(self.scene.colours_below(top) & self.named)) for top in tops]
        for told in dict.fromkeys(((), *colours)):
            description = frozenset((COLLECTIVE, *told))
            if COLLECTIVE not in self.named or len(told) > MOST_COLOURS:
                continue
            for sense in senses(description, self.scene):
                if sense.feature == "collective":
                    head = Reference(_entity(description), sense.elements, len(description))
                    yield head
                    yield from self._at_places(head, column)

    def _at_places(self, head: Reference, column: int) -> Iterator[Reference]:
        """What of some collectives is at, or nearest to, a place, if that holds of one in this column."""
        here = sum(1 << bit for bit in bits(head.mask) if self.scene.columns[bit] == column)
        for bit, ground in self._places:
            place = self.scene.place(bit)
            if place is None or place.kind in (WHOLE, REGION):
                continue
            relation = WITHIN if place.cells >> column & 1 else NEAREST
            for mask in self.scene.related(relation, ground.mask, head.mask)[:1]:
                if mask & here and relation in self.named:
                    where = meaning("spatial-relation", leaf(relation), ground.tree)
                    tree = meaning("entity", *head.tree.children, where)
                    yield Reference(tree, mask, head.size + 1 + ground.size, True)

    def _located(
        self, head: Reference, thing: int, landmarks: Iterable[tuple[Concept, Reference]]
    ) -> Iterator[Reference]:
        for relation, ground in landmarks:
            if relation not in self.named:
                continue
            if not self._sayable(head.tree, "spatial-relation"):
                continue
            for mask in self.scene.related(relation, ground.mask, head.mask)[:1]:  # what listeners think of first
                if mask >> thing & 1 and (mask != head.mask or mask == self._wanted(thing)):
                    where = meaning("spatial-relation", leaf(relation), ground.tree)
                    tree = meaning("entity", *head.tree.children, where)
                    yield Reference(tree, mask, head.size + 1 + ground.size, True)

    def _wanted(self, thing: int) -> int:
        """What may be told of although it rules nothing out."""
        return 1 << thing if self._telling_where else 0

    def _landmarks(self, thing: int, depth: int) -> Iterator[tuple[Concept, Reference]]:
        """Relations and landmarks that a block may be told by."""
        scene = self.scene
        if scene.held >> thing & 1:
            return
        column = scene.columns[thing]
        below = scene.below(thing)
        if below is not None:
            for ground in self.grounds(below, depth - 1):
                yield ABOVE, ground
        for bit, ground in self._places:
            place = scene.place(bit)
            if place is None:
                continue
            if place.kind == WHOLE:
                if below is None:
                    yield ABOVE, ground
            elif place.cells >> column & 1:
                yield from ((WITHIN, ground), (ABOVE, ground))
            elif place.kind != REGION:
                yield NEAREST, ground
        for collective in self.collectives_with(thing):
            yield WITHIN, collective
        for side, (dx, dy) in zip(SIDES, SIDE_STEPS, strict=True):
            for other in self._top_at(column, -dx, -dy):
                for ground in self.grounds(other, depth - 1):
                    yield from ((side, ground), (BESIDE, ground))

    def _top_at(self, column: int, dx: int, dy: int) -> list[int]:
        """The uppermost block so many cells away, if there is one."""
        x, y = divmod(column, CELLS)
        if not (0 <= x + dx < CELLS and 0 <= y + dy < CELLS):
            return []
        support = self.scene.support[(x + dx) * CELLS + y + dy]
        return [support] if support >= 0 else []

    def neighbours(self, column: int) -> Iterator[tuple[Concept, int]]:
        """Sides of uppermost blocks on which a column is, each with the block."""
        if not 0 <= column < COLUMNS:
            return
        for side, (dx, dy) in zip(SIDES, SIDE_STEPS, strict=True):
            for block in self._top_at(column, -dx, -dy):
                yield side, block


def leaf(concept: Concept) -> RclNode:
    """A concept as a leaf of a meaning."""
    return RclNode(concept.space, concept, 0, 0)


def _entity(description: Description) -> RclNode:
    return meaning("entity", *(leaf(concept) for concept in sorted(description)))
