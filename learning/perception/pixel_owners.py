"""Which of the things known each pixel shows."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from learning.perception.segments import LEAST_PIXELS, Pixels
from learning.perception.track import Track

NEAR = 0.008
"""Scale of distance [m] and"""
ALIKE = 35.0
"""of colour, of 255, in which a pixel is nearest to one of the things known:"""
FAR = 4.0
"""farther than this it belongs to none."""
ENOUGH = 0.25
"""Part of a connected part's pixels that must vote for the thing that gets it all,"""
FEW = 0.1
"""while others get less than this part of its votes."""


def owners_of(seen: Pixels, tracks: Sequence[Track]) -> NDArray[np.int64]:
    """Number of the track that each pixel belongs to, (n,); -1 for none.

    Each pixel votes for the track that has a point like it, in place and colour, nearest to it. A connected part
    belongs to the one track that gets its votes, or is cut where several do: things that touch.

    Args:
        seen: What stands out.
        tracks: The things known, where they are believed to be now.
    """
    owner = np.full(len(seen.pixels), -1, dtype=np.int64)
    trusted = np.flatnonzero(seen.trusted)
    if not tracks or not len(trusted):
        return owner
    points = np.concatenate([track.points() for track in tracks])
    colours = np.concatenate([track.colours for track in tracks])
    whose = np.concatenate([np.full(len(track.colours), number) for number, track in enumerate(tracks)])
    tree = cKDTree(np.hstack((points / NEAR, colours / ALIKE)))
    places = np.hstack((seen.points[trusted] / NEAR, seen.colours[trusted] / ALIKE))
    distance, nearest = tree.query(places, distance_upper_bound=FAR)
    voted = np.isfinite(distance)
    vote = np.where(voted, whose[np.where(voted, nearest, 0)], -1)
    parts = int(seen.part.max()) + 1
    table = np.zeros((parts, len(tracks)), dtype=np.int64)
    np.add.at(table, (seen.part[trusted[voted]], vote[voted]), 1)
    size = np.bincount(seen.part[trusted], minlength=parts)
    most = table.argmax(axis=1)
    votes = table[np.arange(parts), most]
    others = table.sum(axis=1) - votes
    single = (votes >= np.maximum(2, ENOUGH * size)) & (others < np.maximum(LEAST_PIXELS, FEW * votes))
    several = (votes >= 2) & ~single
    owner[:] = np.where(single[seen.part], most[seen.part], -1)
    shared = several[seen.part[trusted]] & voted
    owner[trusted[shared]] = vote[shared]
    return owner


def unowned(seen: Pixels, owner: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Pixels of connected parts that belong to no track at all, (n,)."""
    if not len(seen.pixels):
        return np.zeros(0, dtype=bool)
    taken = np.bincount(seen.part, weights=owner >= 0) > 0
    return np.asarray(~taken[seen.part])
