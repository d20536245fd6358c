"""The board's elements: blocks, what stands on one another, places; and how they are measured (innate).

Elements are bits of one integer: first the blocks, then the collectives (every column of two or more from the board up
to some height), then the places. Placements are bits of another: one a column of cells.
"""

from collections.abc import Callable
from math import hypot

from learning.concept_id import Concept
from learning.grammar.arrangement import Arrangement
from learning.grammar.board_places import LAST, Place, board_places
from learning.grammar.innate import (
    ABOVE,
    BESIDE,
    EXTREMES,
    NEAREST,
    OTHER,
    SELF,
    SIDE_STEPS,
    SIDES,
    SINGLE,
    WHOLE,
    WITHIN,
)
from learning.grammar.scene import bits
from learning.percept import NO_CONCEPT
from twin.board import CELLS

TOLERANCE = 1e-6
"""Distances that differ by less [cells] are equal."""
COLUMNS = CELLS * CELLS


class BoardElements:
    """What language can speak of on a board ."""

    def __init__(self, arrangement: Arrangement, bearing_shapes: frozenset[int] | None = None) -> None:
        """Index an arrangement.

        Args:
            arrangement: How the blocks stand.
            bearing_shapes: Shape concepts that something can rest on, None when that is not known yet.
        """
        self.count = count = len(arrangement.columns)
        held = arrangement.held
        self.held = 0 if held is None else 1 << held
        columns, levels = list(arrangement.columns), arrangement.levels
        self._looks: dict[Concept, int] = {}
        for space, numbers in (("colour", arrangement.colours), ("shape", arrangement.shapes)):
            for index, number in enumerate(numbers):
                if number != NO_CONCEPT:
                    concept = Concept(space, number)
                    self._looks[concept] = self._looks.get(concept, 0) | 1 << index
        stacks: list[list[int]] = [[] for _ in range(COLUMNS)]
        for index in sorted(range(count), key=levels.__getitem__):
            if index != held:
                stacks[columns[index]].append(index)
        self.columns = columns
        self._block_below: dict[int, int] = {}
        self._on: dict[int, int] = {}
        self._collectives: list[tuple[int, ...]] = []
        self._landing_of: dict[int, int] = {}
        self.single = 0
        self.blocks = (1 << count) - 1
        self.clear = 0
        self._on_board = 0
        for column, stack in enumerate(stacks):
            if not stack:
                continue
            self._on_board |= 1 << stack[0]
            self.clear |= 1 << stack[-1]
            self._landing_of[stack[-1]] = 1 << column
            if len(stack) == 1:
                self.single |= 1 << stack[0]
            for below, above in zip(stack, stack[1:], strict=False):
                self._on[below] = 1 << above
                self._block_below[above] = below
        for column, stack in enumerate(stacks):
            for height in range(2, len(stack) + 1):
                bit = count + len(self._collectives)
                self._collectives.append(tuple(stack[:height]))
                columns.append(column)
                if height == len(stack):
                    self._landing_of[bit] = 1 << column
                else:
                    self._on[bit] = 1 << stack[height]
        self._first_place = first = count + len(self._collectives)
        self._places = board_places()
        self.things = (1 << first) - 1
        self.places = ((1 << len(self._places)) - 1) << first
        self._colour_of = [Concept("colour", number) for number in arrangement.colours]
        self._made_of = [frozenset(self._colour_of[i] for i in members) for members in self._collectives]
        # Elements on which nothing rests: clear blocks, what is in the gripper, whole columns, and all places.
        self._open = self.held | self.places | sum(1 << element for element in self._landing_of)
        # What a thing let go over each column would rest on, -1 for the board itself.
        self.support = [stack[-1] if stack else -1 for stack in stacks]
        self.usable = 0
        for column, below in enumerate(self.support):
            if below < 0 or bearing_shapes is None or arrangement.shapes[below] in bearing_shapes:
                self.usable |= 1 << column
        self.floor = sum(1 << column for column, stack in enumerate(stacks) if not stack)
        # What rests on a block that has one clear block on it: such blocks are what "from" and "that is on" speak of.
        self._bearing = 0
        for index in range(first):
            on = self._on.get(index, 0)
            if on & self.clear:
                self._bearing |= 1 << index
        self._memory: dict[tuple[object, ...], tuple[int, ...]] = {}

    def place(self, element: int) -> Place | None:
        """Give the place that an element is, None when it is a thing."""
        return self._places[element - self._first_place] if element >= self._first_place else None

    def looking(self, concept: Concept) -> int:
        """Blocks of a colour or shape concept."""
        return self._looks.get(concept, 0)

    def looks(self, block: int) -> frozenset[Concept]:
        """Colour and shape concepts of a block."""
        return frozenset(concept for concept, mask in self._looks.items() if mask >> block & 1)

    def below(self, block: int) -> int | None:
        """The block that a block stands on; None on the board or in the gripper."""
        return self._block_below.get(block)

    def colours_below(self, block: int) -> frozenset[Concept]:
        """Colours of a block and of everything below it."""
        found = {self._colour_of[block]}
        while (below := self._block_below.get(block)) is not None:
            found.add(self._colour_of[below])
            block = below
        return frozenset(found)

    def places_of_kind(self, kind: Concept) -> list[Place]:
        """All places of a kind."""
        return [place for place in self._places if place.kind == kind]

    def collectives(self, colours: frozenset[Concept], size: int | None) -> int:
        """Collectives made of exactly these colours (any, if none is named) and of so many blocks."""
        mask = 0
        for index, members in enumerate(self._collectives):
            if (not colours or self._made_of[index] == colours) and (size is None or len(members) == size):
                mask |= 1 << (self.count + index)
        return mask

    def landmarks(self, kind: Concept, sides: frozenset[int]) -> int:
        """Places of a kind that lie towards all of these sides."""
        mask = 0
        for index, place in enumerate(self._places):
            if place.kind == kind and sides <= place.sides:
                mask |= 1 << (self._first_place + index)
        return mask

    def ranked(self, rank: Concept, mask: int) -> tuple[int, ...]:
        """What of a set has a rank in it: all that are single, or those furthest to a side.

        Returns:
            One set of elements, or several where it is open among what the rank is taken.
        """
        if rank == OTHER:
            return (mask,)
        if rank == SINGLE:
            return (mask & self.single,)
        side = EXTREMES.index(rank)
        dx, dy = SIDE_STEPS[side]

        def short_of(element: int) -> float:
            x, y = divmod(self.columns[element], CELLS)
            return float(-dx * x - dy * y)

        return self._among(mask & self.things, short_of)

    def open_to_choice(self, mask: int) -> bool:
        """Whether more than one of these elements is clear, so that a rank among them says something."""
        clear = mask & self._open or mask
        return bool(clear & (clear - 1))

    def _among(self, mask: int, cost: Callable[[int], float]) -> tuple[int, ...]:
        found: list[int] = []
        for part in (mask & self._open, mask & self._bearing, mask):
            if part:
                best = _least(part, cost)
                if best not in found:
                    found.append(best)
        return tuple(found)

    def distance(self, one: int, other: int) -> float:
        """How far two elements are apart in the plane [cells]."""
        a, b = self.place(one), self.place(other)
        if a is not None and b is not None:
            return 0.0 if a.cells & b.cells else float(LAST)
        if b is not None:
            return b.distance[self.columns[one]]
        if a is not None:
            return a.distance[self.columns[other]]
        c, d = self.columns[one], self.columns[other]
        return hypot(c // CELLS - d // CELLS, c % CELLS - d % CELLS)

    def nearest(self, mask: int, ground: int) -> int:
        """Elements of a set that are nearest to any of `ground`."""
        grounds = bits(ground)
        return _least(mask, lambda element: min(self.distance(element, each) for each in grounds))

    def nearest_to_robot(self, mask: int) -> int:
        """Elements of a set that are nearest to the robot."""
        key = ("robot", mask)
        if key not in self._memory:
            robot = self.landmarks(SELF, frozenset())
            clear = mask & self._open
            self._memory[key] = (self.nearest(clear or mask, robot),)
        return self._memory[key][0]

    def related(self, relation: Concept, ground: int, head: int) -> tuple[int, ...]:
        """What of `head` stands in a relation to any of `ground`: one set, or several where the measure is open."""
        key = (relation, ground, head)
        known = self._memory.get(key)
        if known is None:
            known = self._memory[key] = tuple(mask for mask in self._related(relation, ground, head) if mask)
        return known

    def _related(self, relation: Concept, ground: int, head: int) -> tuple[int, ...]:
        head &= ~self.held  # what is in the gripper stands nowhere
        if relation == NEAREST:
            grounds = bits(ground)
            # What is over or under a thing is on it, not near it.
            taken = sum(1 << self.columns[each] for each in grounds if self.place(each) is None)
            rest = head & ~ground & ~self._standing(head, taken)
            if not ground or not rest:
                return ()
            return self._among(rest, lambda element: min(self.distance(element, each) for each in grounds))
        found = 0
        for each in bits(ground):
            place = self.place(each)
            if place is not None:
                if relation in (ABOVE, WITHIN):
                    if place.kind == WHOLE:
                        found |= head & self._on_board
                    elif place.cells:
                        found |= self._standing(head, place.cells)
                elif relation == BESIDE and place.cells:
                    found |= self._standing(head, place.cells)
            elif relation == ABOVE:
                found |= self._on.get(each, 0)
            elif relation == WITHIN:
                if each >= self.count:
                    for member in self._collectives[each - self.count]:
                        found |= 1 << member
            else:
                found |= self._standing(head & self.things, self._beside(relation, each))
        return (head & found,)

    def _standing(self, mask: int, cells: int) -> int:
        return sum(1 << element for element in bits(mask & self.things) if cells >> self.columns[element] & 1)

    def _beside(self, relation: Concept, element: int) -> int:
        """Columns next to an element: to one side of it, or to all."""
        x, y = divmod(self.columns[element], CELLS)
        sides = SIDE_STEPS if relation == BESIDE else (SIDE_STEPS[SIDES.index(relation)],)
        return _columns([(x + dx, y + dy) for dx, dy in sides])

    def landing(self, relation: Concept, ground: int) -> int:
        """Placements that stand in a relation to any of `ground`."""
        key = ("landing", relation, ground)
        known = self._memory.get(key)
        if known is None:
            known = self._memory[key] = (self._landing(relation, ground),)
        return known[0]

    def _landing(self, relation: Concept, ground: int) -> int:
        found = 0
        for each in bits(ground):
            place = self.place(each)
            if place is not None:
                if relation == NEAREST:
                    found |= _least(self.usable, place.distance.__getitem__)
                elif place.kind == WHOLE:
                    found |= self.floor
                elif relation in SIDES and SIDES.index(relation) not in place.sides:
                    continue
                else:
                    found |= place.cells
            elif relation == WITHIN:
                continue  # nothing can be put into what is solid
            elif relation == ABOVE:
                found |= self._landing_of.get(each, 0)
            elif relation in (BESIDE, NEAREST):
                found |= self._beside(BESIDE, each)
            else:
                found |= self._beside(relation, each)
        return found

    def shifted(self, side: Concept, steps: int, ground: int) -> int:
        """Placements so many steps to one side of any of `ground`."""
        dx, dy = SIDE_STEPS[SIDES.index(side)]
        cells = []
        for each in bits(ground & self.things):
            x, y = divmod(self.columns[each], CELLS)
            cells.append((x + steps * dx, y + steps * dy))
        return _columns(cells)


def _columns(cells: list[tuple[int, int]]) -> int:
    mask = 0
    for x, y in cells:
        if 0 <= x < CELLS and 0 <= y < CELLS:
            mask |= 1 << (x * CELLS + y)
    return mask


def _least(mask: int, cost: Callable[[int], float]) -> int:
    """Elements of a set whose cost is the lowest."""
    best, lowest = 0, float("inf")
    while mask:
        low = mask & -mask
        mask ^= low
        value = cost(low.bit_length() - 1)
        if value < lowest - TOLERANCE:
            best, lowest = low, value
        elif value <= lowest + TOLERANCE:
            best |= low
    return best
