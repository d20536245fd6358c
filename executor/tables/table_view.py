"""How a table looked once, with numbers that things keep from look to look."""

from colorsys import hls_to_rgb
from dataclasses import dataclass, replace

import numpy as np

from executor.tables.places import TableThings
from learning.concepts.table_spaces import TableColour
from learning.interpretation.table_interpreter import held_thing
from learning.perception.handling import felt
from learning.perception.observation import Observation
from learning.perception.tracks import anchors
from robots.pose import FloatArray

SAME_PLACE = 0.04
"""What is seen so near to where a thing like it was is the same [m]."""
ALOFT = 0.25
"""Height at which a held thing is imagined [m]."""


@dataclass(frozen=True, slots=True)
class TableView:
    """A look.

    Attributes:
        observation: What was seen.
        things: Where things are, and how large.
        numbers: Number of each thing, (N,); the same thing has the same one in later looks.
        held: Index of what is in the hand, None for nothing.
        feels: Whether the closed fingers feel something between them, seen or not.
    """

    observation: Observation
    things: TableThings
    numbers: tuple[int, ...]
    held: int | None
    feels: bool = False

    @classmethod
    def of(cls, observation: Observation, before: "TableView | None" = None) -> "TableView":
        """Take a look; what is like a thing of the look before, and where that was or is held, keeps its number."""
        _, last = anchors(observation)
        count = len(observation.object_ids)
        assert observation.extent is not None  # a camera measures what it sees
        things = TableThings(last, np.median(observation.extent, axis=0) if count else np.zeros((0, 3)))
        view = cls(observation, things, tuple(range(count)), held_thing(observation), bool(felt(observation)[-1]))
        return view if before is None else replace(view, numbers=_kept_numbers(view, before))

    def index_of(self, number: int | None) -> int | None:
        """Index of the thing with a number; None where it is not seen."""
        return self.numbers.index(number) if number in self.numbers else None

    def numbered(self, index: int, number: int) -> "TableView":
        """The view in which a thing has a number; what had that number gets the thing's."""
        old = self.numbers[index]
        swapped = [old if each == number else each for each in self.numbers]
        swapped[index] = number
        return replace(self, numbers=tuple(swapped))

    def with_moved(self, index: int, position: FloatArray | None, holds: bool) -> "TableView":
        """The view in which a thing is somewhere else, or in the hand."""
        location = np.array(self.things.location)
        track = np.array(self.observation.location)
        if holds:
            location[index, 2] = ALOFT
        elif position is not None:
            location[index] = position
        track[:, index] = location[index]
        held = index if holds else None if self.held == index else self.held
        moved = replace(self.observation, location=track)
        return TableView(moved, replace(self.things, location=location), self.numbers, held, held is not None)


def looks(view: TableView, index: int) -> FloatArray:
    """Colour of a thing as it is mostly seen, embedded so that equal distances look alike, (3,)."""
    return np.asarray(TableColour.embed(np.median(view.observation.colour[:, index], axis=0)))


def alike(one: TableView, first: int, other: TableView, second: int) -> bool:
    """Whether two things may be the same by their colour."""
    return float(np.linalg.norm(looks(one, first) - looks(other, second))) < TableColour.kind_width


def lost_colours(now: TableView, before: TableView) -> FloatArray:
    """Red, green, blue of 255 of the things that were seen before and are not now, (k, 3)."""
    lost = [index for index, number in enumerate(before.numbers) if number not in now.numbers]
    hsl = [np.median(before.observation.colour[:, index], axis=0) for index in lost]
    return np.array([hls_to_rgb(hue, light, pure) for hue, pure, light in hsl]).reshape(-1, 3) * 255.0


def _kept_numbers(now: TableView, before: TableView) -> tuple[int, ...]:
    """Numbers of what is where a thing like it was, then of what is like a thing that is left over; else new ones."""
    fresh = max(before.numbers, default=-1) + 1
    numbers: dict[int, int] = {}
    pairs = sorted(
        (float(np.linalg.norm(now.things.location[i] - before.things.location[j])), i, j)
        for i in range(len(now.numbers))
        for j in range(len(before.numbers))
        if alike(now, i, before, j)
    )
    for limit in (SAME_PLACE, np.inf):  # first what stayed, then what was carried
        for away, i, j in pairs:
            if away < limit and i not in numbers and before.numbers[j] not in numbers.values():
                numbers[i] = before.numbers[j]
    for i in range(len(now.numbers)):
        if i not in numbers:
            numbers[i] = fresh
            fresh += 1
    return tuple(numbers[i] for i in range(len(now.numbers)))
