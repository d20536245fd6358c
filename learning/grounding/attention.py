"""What a shown move draws attention to, in terms of every kind of meaning: candidates for what its words are about.

A concept is salient when it is true of what moved, of where it went or came from, or of what bore it, and when it would
help to tell these from their likes: "nearest" and "leftmost" are salient only where several things look the same.
"""

from collections.abc import Sequence

from learning.concept_id import ACTION_SPACE, Concept
from learning.grammar.actions import ActionTable
from learning.grammar.board_elements import BoardElements
from learning.grammar.innate import (
    ABOVE,
    CENTRE,
    COLLECTIVE,
    CORNER,
    COUNTS,
    EDGE,
    EXTREMES,
    IT,
    LARGEST_COUNT,
    NEAREST,
    NEAREST_ONE,
    SELF,
    SIDE_STEPS,
    SIDES,
    SINGLE,
    UNIT,
    WITHIN,
)
from learning.grammar.scene import bits
from learning.grounding.alignment import Way
from learning.grounding.word_uses import HEADING_SPACE
from learning.percept import ShownAction
from twin.board import CELLS

HEADINGS = tuple(Concept(HEADING_SPACE, number) for number in range(4))
"""The direction in which something moved or lies from something else. Its words are those of `SIDES`; alignment counts
it apart because many a side is true of every scene, and few things move straight to one."""


def salient_meanings(scene: BoardElements, shown: ShownAction, ways: Sequence[Way] = (Way(),)) -> tuple[Concept, ...]:
    """Give the concepts that a shown action draws attention to, in a fixed order.

    Args:
        scene: The scene before the action.
        shown: The action.
        ways: The ways of speaking of it.
    """
    found = {Concept(ACTION_SPACE, number) for number in (shown.action, *shown.parts)}
    moved = shown.moved
    found |= scene.looks(moved)
    below = scene.below(moved)
    if below is not None:
        found |= {ABOVE, *scene.looks(below)}
        if scene.below(below) is not None:
            found |= {COLLECTIVE, *scene.colours_below(below)}
    found |= _telling(scene, moved, scene.clear | scene.held)
    found |= _inside(scene, 1 << scene.columns[moved])
    if shown.placement is not None:
        found |= _destination(scene, moved, shown.placement)
    if any(IT in way.untold for way in ways):
        found.add(IT)
    return tuple(sorted(found))


def ways_of_speaking(shown: ShownAction, actions: ActionTable) -> tuple[Way, ...]:
    """The ways of speaking of an action: as one, or of its parts one by one.

    Who tells of the parts begins with the first, and speaks of the moved thing again with the second; who tells of the
    whole does neither.
    """
    ways = []
    whole = Concept(ACTION_SPACE, shown.action)
    for pair, amounts_to in sorted(actions.composed.items()):
        if amounts_to == shown.action:
            first, second = (Concept(ACTION_SPACE, number) for number in pair)
            ways += [Way(untold=frozenset((first, second, IT))), Way(frozenset((first,)), frozenset((whole,)))]
    return tuple(ways) or (Way(),)


def _destination(scene: BoardElements, moved: int, placement: int) -> set[Concept]:
    found: set[Concept] = set()
    support = scene.support[placement]
    if support < 0:
        found.add(WITHIN)
        found |= _inside(scene, 1 << placement)
        found |= _neighbours(scene, moved, placement)
    else:
        found |= {ABOVE, *scene.looks(support)}
        found |= _telling(scene, support, scene.clear & ~(1 << moved))
        found |= _inside(scene, 1 << placement)
        if scene.single >> support & 1:
            found.add(SINGLE)
        else:
            found.add(COLLECTIVE)
            found.update(scene.colours_below(support))
    x, y = divmod(placement, CELLS)
    a, b = divmod(scene.columns[moved], CELLS)
    for side, (dx, dy) in zip(SIDES, SIDE_STEPS, strict=True):
        steps = (x - a) * dx + (y - b) * dy
        if support < 0 and 0 < steps <= LARGEST_COUNT and (x - a, y - b) == (steps * dx, steps * dy):
            found |= {HEADINGS[side.number], COUNTS[steps - 1], UNIT}
    return found


def _neighbours(scene: BoardElements, moved: int, placement: int) -> set[Concept]:
    """On which sides of something a thing was put down, and what that looks like."""
    found: set[Concept] = set()
    x, y = divmod(placement, CELLS)
    for side, (dx, dy) in zip(SIDES, SIDE_STEPS, strict=True):
        for block in bits(scene.clear & ~(1 << moved)):
            if divmod(scene.columns[block], CELLS) == (x - dx, y - dy):
                found |= {HEADINGS[side.number], *scene.looks(block)}
    return found


def _inside(scene: BoardElements, column: int) -> set[Concept]:
    """Places that a column is part of, the more telling ones: corners before edges."""
    for kind in (CORNER, EDGE, CENTRE):
        for place in scene.places_of_kind(kind):
            if place.cells & column:
                return {kind, WITHIN, *(SIDES[side] for side in place.sides)}
    return set()


def _telling(scene: BoardElements, one: int, among: int) -> set[Concept]:
    """What tells a thing from others that look the same and are as easy to reach."""
    alike = among | 1 << one
    for concept in scene.looks(one):
        alike &= scene.looking(concept)
    found: set[Concept] = set()
    if alike.bit_count() < 2:
        return found
    for kind in (CORNER, EDGE, CENTRE, SELF):
        for index in bits(scene.landmarks(kind, frozenset())):
            place = scene.place(index)
            if place is not None and scene.nearest(alike, 1 << index) == 1 << one:
                found |= {kind, NEAREST, *(SIDES[side] for side in place.sides)}
                if kind == SELF:
                    found.add(NEAREST_ONE)
                if kind == EDGE:
                    found.update(EXTREMES[side] for side in place.sides)
    if scene.single >> one & 1:
        found.add(SINGLE)
    return found
