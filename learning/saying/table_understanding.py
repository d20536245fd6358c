"""What a sentence about a table says, by its words alone, and what of it is there: for reading back what is said."""

from dataclasses import dataclass

from learning.concept_id import ACTION_SPACE, REFERENCE_SPACE, Concept
from learning.grammar.rcl import RclNode
from learning.grammar.table_chart import LOCATION
from learning.grounding.table_scene import TableScene

Goal = tuple[frozenset[Concept], int]
"""Where something goes: relations or places, and the objects that the relation is to, as a mask (0 for a place)."""


@dataclass(frozen=True, slots=True)
class TableUnderstanding:
    """What is told.

    Attributes:
        tree: Its tree.
        action: Number of what is done, None where no action is told.
        things: Objects that it may be done to, as a mask.
        goal: Where they go, None where that is not told.
    """

    tree: RclNode
    action: int | None
    things: int
    goal: Goal | None


class TableDenotation:
    """What parts of trees denote in a scene."""

    def __init__(self, scene: TableScene) -> None:
        """Look at a scene; what was shown in it is not looked at."""
        self._scene = scene
        self._masks = scene.masks()
        self.everything = (1 << len(scene.looks)) - 1

    def understand(self, tree: RclNode) -> TableUnderstanding:
        """What a command says."""
        actions = [node.concept for node in tree.nodes() if node.concept is not None and node.label == ACTION_SPACE]
        entities = [child for event in _events(tree) for child in event.children if child.label == "entity"]
        named = [each for each in entities if not any(child.label == REFERENCE_SPACE for child in each.children)]
        goals = [child for event in _events(tree) for child in event.children if child.label == "destination"]
        return TableUnderstanding(
            tree=tree,
            action=actions[-1].number if actions else None,
            things=self.things(named[0]) if named else 0,
            goal=self._goal(goals[-1].children[0]) if goals and goals[-1].children else None,
        )

    def things(self, entity: RclNode) -> int:
        """Objects that an entity denotes, as a mask."""
        mask = self.everything
        for child in entity.children:
            if child.label == "spatial-relation":
                mask &= self._standing(child)
            elif child.concept is not None:
                mask &= self._masks.get(child.concept, 0)
        return mask

    def _goal(self, where: RclNode) -> Goal:
        concepts = frozenset(child.concept for child in where.children if child.concept is not None)
        ground = next((self.things(child) for child in where.children if child.label == "entity"), 0)
        return concepts, ground

    def _standing(self, where: RclNode) -> int:
        """Objects that are somewhere."""
        concepts, ground = self._goal(where)
        if all(child.label == LOCATION for child in where.children):
            return sum(1 << index for index, at in enumerate(self._scene.places) if concepts <= at)
        mask = 0
        for (i, j), related in self._scene.relations.items():
            if ground >> j & 1 and concepts <= related:
                mask |= 1 << i
        return mask


def _events(tree: RclNode) -> list[RclNode]:
    return [node for node in tree.nodes() if node.label == "event"]
