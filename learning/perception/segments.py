"""Table-top segmentation: what stands out from the table, cut into pieces by depth and colour."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from learning.perception.pixel_kernel import FOUND, connect
from learning.perception.robot_eye import Look
from learning.perception.surface_colour import DARK, SHADED, surface_colour
from learning.perception.table import TableView
from robots.pose import FloatArray

JUMP = 0.018
"""Difference of depth between neighbouring pixels that parts two things [m]: seven standard deviations at 1 m."""
COLOUR_JUMP = 0.008
"""Difference of depth that parts two colours [m]: three standard deviations."""
ANOTHER_COLOUR = 0.12
"""Distance of two chromaticities (red and green, each over the sum) that are two colours,"""
CHROMA_NOISE = 8.0
"""and how much more it must be in the dark, over the sum of a pixel's channels."""
LEAST_PIXELS = 6
"""Fewer pixels are noise."""
TOGETHER = 0.015
"""Pieces of one colour nearer than this are one thing, seen with something of itself before it [m]."""
LID_SHARE = 0.6
"""A piece that stands on another and has less than this part of its pixels is a lid or a cap of it."""
SUPPORT = 0.010
"""A pixel's depth counts when two neighbours of the same piece agree within this [m]."""
HOLE = 0.03
"""Across a patch without depth, as shiny or steep places have, the depth of one thing changes by this at most [m]."""
_LIMITS = np.array([JUMP, COLOUR_JUMP, ANOTHER_COLOUR, CHROMA_NOISE, SUPPORT, HOLE, SHADED, DARK])


@dataclass(frozen=True, slots=True)
class Piece:
    """A connected part of the picture that stands out from the table.

    Attributes:
        pixels: Numbers of its pixels, (n,).
        measured: Numbers of those whose depth can be trusted, (m,).
        points: Their places in the world, (m, 3) [m].
        depth: Their depths, (m,) [m].
        colours: Their red, green, blue, (m, 3) of 255.
        beside_robot: Whether it touches a pixel of the robot or the border of the picture.
    """

    pixels: NDArray[np.int64]
    measured: NDArray[np.int64]
    points: FloatArray
    depth: FloatArray
    colours: FloatArray
    beside_robot: bool

    @property
    def colour(self) -> FloatArray:
        """Red, green, blue of its surface, (3,) of 255; of what a hand may hide, as if nothing did."""
        return surface_colour(self.colours, self.points[:, 2], hidden=self.beside_robot)


@dataclass(frozen=True, slots=True)
class Pixels:
    """All pixels that stand out, n of them, and the parts they make.

    Attributes:
        pixels: Numbers in the picture, (n,).
        depth: Depths, (n,) [m]; 0 where nothing was measured.
        points: Places in the world, (n, 3) [m]; senseless where depth is 0.
        colours: Red, green, blue, (n, 3) of 255.
        part: Number of the connected part of each, (n,).
        trusted: Whether depth was measured and neighbours agree, (n,).
        exposed: Whether a pixel has no pixel of the robot, nor the border of the picture, beside it, (n,).
    """

    pixels: NDArray[np.int64]
    depth: FloatArray
    points: FloatArray
    colours: FloatArray
    part: NDArray[np.int64]
    trusted: NDArray[np.bool_]
    exposed: NDArray[np.bool_]

    def piece(self, chosen: NDArray[np.bool_]) -> Piece:
        """The piece made of chosen pixels, (n,)."""
        good = chosen & self.trusted
        return Piece(
            self.pixels[chosen], self.pixels[good], self.points[good], self.depth[good], self.colours[good],
            not bool(self.exposed[chosen].all()),
        )  # fmt: skip


def standing_out(look: Look, view: TableView) -> Pixels:
    """Find what stands out from the table and is not the robot, and which pixels of it are connected.

    Neighbouring pixels are connected unless their depths differ by more than noise and slope explain, or their colours
    differ and their depths a little.

    Args:
        look: The picture.
        view: The table from where the camera is.
    """
    kinds = view.sort(look)
    pixels = np.flatnonzero(kinds == FOUND)
    depth = look.depth.reshape(-1)[pixels].astype(float)
    colours = look.colour.reshape(-1, 3)[pixels].astype(float)
    part, agreeing, exposed = connect(kinds, pixels, depth, colours, _LIMITS)
    points = view.points_at(depth, pixels)
    return Pixels(pixels, depth, points, colours, part, (depth > 0) & (agreeing >= 2), exposed)


def pieces_of(seen: Pixels, chosen: NDArray[np.bool_], apart: FloatArray | None = None) -> list[Piece]:
    """The things that some pixels show, without knowing any of them from before.

    Parts of one colour that are together in space are one thing, and so is a thing with its lid; parts of a few pixels
    are noise.

    Args:
        seen: All that stands out.
        chosen: Which pixels to look at, (n,).
        apart: Red, green, blue of things that may lie in or on others and are no parts of them, (k, 3); None: none.
    """
    if not chosen.any():
        return []
    labels, sizes = np.unique(seen.part[chosen], return_counts=True)
    masks = [chosen & (seen.part == label) for label in labels[sizes >= LEAST_PIXELS]]
    masks = [mask for mask in masks if (mask & seen.trusted).sum() >= LEAST_PIXELS // 2]
    if apart is not None:
        masks = [cut for mask in masks for cut in _cut(seen, mask, apart)]
    masks.sort(key=lambda mask: -int(mask.sum()))
    things: list[NDArray[np.bool_]] = []
    for mask in masks:
        for number, thing in enumerate(things):
            if _one_thing(seen, thing, mask, apart):
                things[number] = thing | mask
                break
        else:
            things.append(mask)
    return [seen.piece(thing) for thing in things]


def joined(pieces: Sequence[Piece]) -> Piece:
    """Several pieces, at least one, as one."""
    return Piece(
        np.concatenate([each.pixels for each in pieces]),
        np.concatenate([each.measured for each in pieces]),
        np.concatenate([each.points for each in pieces]),
        np.concatenate([each.depth for each in pieces]),
        np.concatenate([each.colours for each in pieces]),
        any(each.beside_robot for each in pieces),
    )


def _one_thing(
    seen: Pixels, large: NDArray[np.bool_], small: NDArray[np.bool_], apart: FloatArray | None = None
) -> bool:
    """Whether a smaller part belongs to the thing that a larger one shows."""
    one, other = seen.points[large & seen.trusted], seen.points[small & seen.trusted]
    distance, _ = cKDTree(one).query(other)
    if np.min(distance) > TOGETHER:
        return False
    total = seen.colours.sum(axis=1)
    chroma = [np.median(_chroma(seen.colours[each]), axis=0) for each in (large, small)]
    dark, bright = sorted(float(np.median(total[each])) for each in (large, small))
    another = ANOTHER_COLOUR + CHROMA_NOISE / (dark + 1.0)
    shaded = bright + DARK <= SHADED * (dark + DARK)
    if shaded and np.abs(chroma[0] - chroma[1]).sum() < another:
        return True
    if apart is not None and np.any(np.abs(_chroma(apart) - chroma[1]).sum(axis=1) < another):
        return False
    on_top = np.percentile(other[:, 2], 10) > np.percentile(one[:, 2], 75) - SUPPORT
    inside = np.all(
        (other[:, :2].mean(axis=0) > one[:, :2].min(axis=0)) & (other[:, :2].mean(axis=0) < one[:, :2].max(axis=0))
    )
    return bool(on_top and inside and small.sum() < LID_SHARE * large.sum())


def _cut(seen: Pixels, mask: NDArray[np.bool_], apart: FloatArray) -> list[NDArray[np.bool_]]:
    """A connected part without what has the colour of a known thing, and that by itself, where it is the smaller half.

    Where things touch, depth does not part them.
    """
    chroma, total = _chroma(seen.colours), seen.colours.sum(axis=1)
    found: list[NDArray[np.bool_]] = []
    for known in _chroma(apart):
        like = mask & (np.abs(chroma - known).sum(axis=1) < ANOTHER_COLOUR + CHROMA_NOISE / (total + 1.0))
        if LEAST_PIXELS <= like.sum() < 0.5 * mask.sum():
            found.append(like)
            mask = mask & ~like
    return [*found, mask]


def _chroma(colours: FloatArray) -> FloatArray:
    """Red and green, each over the sum of the channels, (n, 2)."""
    return np.asarray(colours[:, :2] / (colours.sum(axis=1) + 1.0)[:, None])
