"""A thing's shape in the course of a demo: measured in its best views, and in worse ones to know what those change.

What stands free is seen whole at times; what is in the hand all the time never is, and then the views that show most of
its surface are the best there are. The other views, half hidden by the hand or by another thing, are no measurement of
the shape, but they tell what being hidden does to one: tracks are must-link information.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from learning.perception.shape_histogram import BINS, shape_histogram
from learning.perception.table import TableView
from robots.pose import FloatArray

FRAMES = 4
"""Frames of a demo at which a thing's shape is measured, good and bad views alike,"""
BEST = 4
"""and frames at which it is seen best."""
NEARLY_MOST = 0.8
"""Views of what is never seen whole that show this part of the most surface ever seen of it are its best."""
SOME = 0.3
"""Views that show less than this part of it are not looked at."""
STEADIED = 5
"""Frames before and after each that are averaged where the thing rests and as much of it is seen: noise of depth falls
to a third."""
SAME_PLACE = 0.004
"""A thing that moved less rests [m]."""


@dataclass(frozen=True, slots=True)
class Glimpse:
    """What is seen of a thing at one frame.

    Attributes:
        frame: When.
        whole: Whether it is all that can be seen of it from here.
        centre: Where its middle was, (3,) [m].
        pixels: Numbers of its measured pixels, (m,).
        depth: Their depths, (m,) [m].
        view: The table from where the camera was.
    """

    frame: int
    whole: bool
    centre: FloatArray
    pixels: NDArray[np.int64]
    depth: FloatArray
    view: TableView

    @property
    def surface(self) -> float:
        """How much of its surface is seen: pixels times the square of their distance [m²]."""
        away = self.centre - self.view.pose_camera_in_world.position
        return len(self.pixels) * float(away @ away)


@dataclass(frozen=True, slots=True)
class ShapeOverTime:
    """A thing's shape at every frame; NaN where it was never measured.

    Attributes:
        best: As its nearest best view shows it, (F, 33).
        glimpsed: As the nearest view of any sort shows it, (F, 33).
    """

    best: FloatArray
    glimpsed: FloatArray


def shape_over_time(glimpses: Sequence[Glimpse], frames: int) -> ShapeOverTime:
    """Measure a thing's shape at a few frames spread over a demo.

    Args:
        glimpses: What was seen of it, in order.
        frames: How many frames there are, F.
    """
    most = max((each.surface for each in glimpses), default=0.0)
    glimpses = [each for each in glimpses if each.surface >= SOME * most]
    best = _best(glimpses)
    found: dict[int, FloatArray] = {}
    for number in sorted({*_spread(range(len(glimpses)), FRAMES), *_spread(best, BEST)}):
        eye = glimpses[number].view.pose_camera_in_world.position
        histogram = shape_histogram(_steadied(glimpses, number), eye)
        if histogram is not None:
            found[number] = histogram
    when = {number: glimpses[number].frame for number in found}
    measured = [number for number in found if number in set(best)] or list(found)
    return ShapeOverTime(_filled(found, when, measured, frames), _filled(found, when, list(found), frames))


def _best(glimpses: Sequence[Glimpse]) -> list[int]:
    """Numbers of the best views: whole ones, else those that show most; of these, those in which the thing rests."""
    best = [number for number, each in enumerate(glimpses) if each.whole]
    if not best and glimpses:
        most = max(each.surface for each in glimpses)
        best = [number for number, each in enumerate(glimpses) if each.surface >= NEARLY_MOST * most]
    chosen = [glimpses[number] for number in best]
    return [best[each] for each in range(len(best)) if _rests(chosen, each)] or best


def _spread(numbers: Sequence[int], count: int) -> list[int]:
    """So many of some numbers, spread evenly, or all of them."""
    if not numbers:
        return []
    places = np.unique(np.linspace(0, len(numbers) - 1, min(count, len(numbers))).round())
    return [numbers[int(each)] for each in places]


def _filled(found: dict[int, FloatArray], when: dict[int, int], numbers: Sequence[int], frames: int) -> FloatArray:
    """Histograms (F, 33) in which every frame has that of the nearest of some views."""
    if not numbers:
        return np.full((frames, BINS), np.nan)
    times = np.array([when[number] for number in numbers])
    nearest = np.abs(np.arange(frames)[:, None] - times).argmin(axis=1)
    return np.asarray(np.stack([found[number] for number in numbers])[nearest])


def _rests(glimpses: Sequence[Glimpse], number: int) -> bool:
    """Whether the thing is where it is in the views just before and after."""
    here = glimpses[number]
    beside = [each for each in glimpses[max(number - 2, 0) : number + 3] if abs(each.frame - here.frame) <= 3]
    return len(beside) > 1 and all(np.abs(each.centre - here.centre).max() < SAME_PLACE for each in beside)


def _steadied(glimpses: Sequence[Glimpse], number: int) -> FloatArray:
    """Points (n, 3) [m] of a view, each pixel's depth averaged over like views around while the thing rests."""
    here = glimpses[number]
    around = [
        each
        for each in glimpses[max(number - STEADIED, 0) : number + STEADIED + 1]
        if each.view is here.view
        and np.abs(each.centre - here.centre).max() < SAME_PLACE
        and NEARLY_MOST * here.surface <= each.surface <= here.surface / NEARLY_MOST
    ]
    pixels = np.concatenate([each.pixels for each in around])
    depth = np.concatenate([each.depth for each in around])
    unique, which, counts = np.unique(pixels, return_inverse=True, return_counts=True)
    mean = np.bincount(which.reshape(-1), weights=depth) / counts
    often = counts >= 0.5 * len(around)
    return here.view.points_at(mean[often], unique[often])
