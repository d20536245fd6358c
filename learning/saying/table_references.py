"""Referring expressions for things at a table, and for where they go: looks first, then places and relations."""

from collections.abc import Iterable, Iterator
from itertools import combinations

from learning.concept_id import Concept
from learning.grammar.rcl import RclNode
from learning.grammar.table_chart import element_of
from learning.grounding.table_scene import TableScene
from learning.saying.ordering import meaning
from learning.saying.reference import Destination, Reference
from learning.saying.table_understanding import TableDenotation

MOST_LOOKS = 3
MOST_PLACES = 2


class TableReferences:
    """Referring expressions in one scene."""

    def __init__(
        self,
        scene: TableScene,
        named: Iterable[Concept],
        together: frozenset[tuple[str, ...]],
        placed: frozenset[tuple[str, ...]],
    ) -> None:
        """Look at a scene.

        Args:
            scene: What there is.
            named: Concepts that have a name.
            together: What may be said of one thing together: labels, sorted.
            placed: What may be said of where something is: labels, sorted.
        """
        self.scene = scene
        self.denotation = TableDenotation(scene)
        self._named = frozenset(named)
        self._together = together
        self._placed = placed

    def of_thing(self, thing: int, *, located: bool = True) -> list[Reference]:
        """Ways to refer to a thing, whatever else fits them; short ones first.

        Args:
            thing: Its index.
            located: Whether it may be told by where it is.
        """
        plain = list(self._looks(thing))
        found = [each for each in plain if self._sayable(each.tree, ())]
        if located:
            for where in self._places(thing):
                for head in plain:
                    if self._sayable(head.tree, (where.label,)):
                        tree = meaning("entity", *head.tree.children, where)
                        mask = self.denotation.things(tree)
                        if mask >> thing & 1:
                            found.append(Reference(tree, mask, head.size + _size(where), True))
        return sorted(found, key=lambda each: each.size)

    def destinations(self, moved: int) -> list[Destination]:
        """Ways to tell where the moved thing goes: next to things that are told alone, or to places."""
        found = []
        for other, related in self.scene.goal_relations.items():
            for ground in self.of_thing(other, located=False):
                if ground.mask & ~(1 << moved) == 1 << other == ground.mask:
                    found += [self._at((concept,), ground) for concept in sorted(related & self._named)]
        for size in range(1, MOST_PLACES + 1):
            for told in combinations(sorted(self.scene.goal & self._named), size):
                found.append(self._at(told, None))
        return [each for each in found if _labels(each.tree) in self._placed]

    def _at(self, concepts: tuple[Concept, ...], ground: Reference | None) -> Destination:
        parts = [leaf(concept) for concept in concepts]
        if ground is None:
            return Destination(meaning("spatial-relation", *parts), 0, len(parts))
        return Destination(meaning("spatial-relation", *parts, ground.tree), ground.mask, len(parts) + ground.size)

    def _looks(self, thing: int) -> Iterator[Reference]:
        looks = sorted(self.scene.looks[thing] & self._named)
        for size in range(1, MOST_LOOKS + 1):
            for told in combinations(looks, size):
                if len({element_of(concept) for concept in told}) == size:
                    tree = meaning("entity", *map(leaf, told))
                    yield Reference(tree, self.denotation.things(tree), size)

    def _places(self, thing: int) -> Iterator[RclNode]:
        """Where a thing is, by places and by other things that looks tell alone."""
        for size in range(1, MOST_PLACES + 1):
            for told in combinations(sorted(self.scene.places[thing] & self._named), size):
                yield from self._allowed(meaning("spatial-relation", *map(leaf, told)))
        for (one, other), related in self.scene.relations.items():
            if one == thing:
                for ground in self._looks(other):
                    if ground.mask == 1 << other and self._sayable(ground.tree, ()):
                        for concept in sorted(related & self._named):
                            yield from self._allowed(meaning("spatial-relation", leaf(concept), ground.tree))

    def _allowed(self, where: RclNode) -> Iterator[RclNode]:
        if _labels(where) in self._placed:
            yield where

    def _sayable(self, entity: RclNode, more: tuple[str, ...]) -> bool:
        return tuple(sorted((*(child.label for child in entity.children), *more))) in self._together


def leaf(concept: Concept) -> RclNode:
    """A concept as a leaf of a meaning."""
    return RclNode(element_of(concept), concept, 0, 0)


def _labels(node: RclNode) -> tuple[str, ...]:
    return tuple(sorted(child.label for child in node.children))


def _size(where: RclNode) -> int:
    return sum(node.concept is not None for node in where.nodes())
