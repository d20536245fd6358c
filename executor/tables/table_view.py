"""How a table looked once, with numbers that things keep from look to look."""

from colorsys import hls_to_rgb
from dataclasses import dataclass, field, replace

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


LOOKED_FOR = 3
"""In so many looks what is not seen any more is looked for."""


@dataclass(frozen=True, slots=True)
class Lost:
    """A thing that was seen and is not any more.

    Attributes:
        number: Its number.
        hsl: Hue, saturation, lightness as it was seen last, (3,).
        colour: The same, embedded as in `TableView`, (3,).
        looks: Looks in which it was not seen.
    """

    number: int
    hsl: FloatArray
    colour: FloatArray
    looks: int


@dataclass(frozen=True, slots=True)
class TableView:
    """A look.

    Attributes:
        observation: What was seen.
        things: Where things are, and how large.
        numbers: Number of each thing, (N,); the same thing has the same one in later looks.
        held: Index of what is in the hand, None for nothing.
        feels: Whether the closed fingers feel something between them, seen or not.
        lost: Things that were seen before and are not now.
        hsl: Hue, saturation, lightness of each thing in the frame in which it looks as it mostly does, (N, 3).
        colours: The same, embedded so that equal distances look alike, (N, 3).
    """

    observation: Observation
    things: TableThings
    numbers: tuple[int, ...]
    held: int | None
    feels: bool = False
    lost: tuple[Lost, ...] = ()
    hsl: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    colours: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))

    @classmethod
    def of(cls, observation: Observation, before: "TableView | None" = None) -> "TableView":
        """Take a look; what is like a thing of the look before, and where that was or is held, keeps its number."""
        _, last = anchors(observation)
        count = len(observation.object_ids)
        assert observation.extent is not None  # a camera measures what it sees
        extent = np.median(observation.extent, axis=0) if count else np.zeros((0, 3))
        hsl, colours = _typical(observation.colour)
        held, feels = held_thing(observation), bool(felt(observation)[-1])
        yaw = None if observation.yaw is None else np.array(observation.yaw[-1])
        if yaw is not None and held is not None:
            yaw[held] = np.nan  # the hand hides how it is turned
        things = TableThings(last, extent, yaw)
        view = cls(observation, things, tuple(range(count)), held, feels, (), hsl, colours)
        if before is None:
            return view
        view = _recalled(replace(view, numbers=_kept_numbers(view, before)), before)
        gone = [
            Lost(number, before.hsl[index], before.colours[index], 0) for index, number in enumerate(before.numbers)
        ]
        gone = [replace(each, looks=each.looks + 1) for each in (*before.lost, *gone)]
        return replace(view, lost=tuple(each for each in gone if each.number not in view.numbers))

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
        things = replace(self.things, location=location)
        return replace(self, observation=moved, things=things, held=held, feels=held is not None)


def _typical(colour: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Colour (N, 3) of things seen in colours (F, N, 3) in some frames, plain and embedded: red has hues of 0 and 1."""
    embedded = np.asarray(TableColour.embed(colour))
    off = np.linalg.norm(embedded - np.median(embedded, axis=0), axis=2)
    frame, thing = off.argmin(axis=0), np.arange(colour.shape[1])
    return colour[frame, thing], embedded[frame, thing]


def alike(one: TableView, first: int, other: TableView, second: int) -> bool:
    """Whether two things may be the same by their colour."""
    return float(np.linalg.norm(one.colours[first] - other.colours[second])) < TableColour.kind_width


def lost_colours(view: TableView) -> FloatArray:
    """Red, green, blue of 255 of the things that were seen a few looks ago and are not now, (k, 3)."""
    hsl = [each.hsl for each in view.lost if each.looks <= LOOKED_FOR]
    return np.array([hls_to_rgb(hue, light, pure) for hue, pure, light in hsl]).reshape(-1, 3) * 255.0


def _recalled(view: TableView, before: TableView) -> TableView:
    """The view in which what was lost and looks like a new thing is that thing again."""
    for lost in before.lost:
        new = [index for index, number in enumerate(view.numbers) if number not in before.numbers]
        off = {
            index: float(np.linalg.norm(view.colours[index] - lost.colour))
            for index in new
            if lost.number not in view.numbers
        }
        if off and min(off.values()) < TableColour.kind_width:
            view = view.numbered(min(off, key=lambda index: off[index]), lost.number)
    return view


def _kept_numbers(now: TableView, before: TableView) -> tuple[int, ...]:
    """Numbers of what is where a thing like it was, then of what is like a thing that is left over; else new ones."""
    fresh = max((*before.numbers, *(each.number for each in before.lost)), default=-1) + 1
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
