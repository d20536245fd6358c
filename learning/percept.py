"""A scene in the learner's own symbols: the predicates that language is grounded in (thesis 3.3.4)."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robots.pose import FloatArray

IntArray = NDArray[np.int64]
NO_CONCEPT = -1


@dataclass(frozen=True, slots=True)
class Percept:
    """Predicates of one scene at one instant (before an action), for N objects and M placements.

    A *placement* is a position where an object would come to rest if it were let go there: on the table, or on top of
    what stands below. Concept numbers index the concepts of one feature space: number 3 of `colour` is `colour_3`.

    Attributes:
        object_ids: Track numbers, (N,).
        location: Object centres, (N, 3) [m].
        properties: Feature space (`colour`, `shape`, `location`) to the concept number of each object, (N,).
        relations: Feature space (`direction`, `distance`) to the concept number of each ordered pair, (N, N); entry
            [i, j] is where object i is as seen from object j; `NO_CONCEPT` where the pair is too far apart to relate.
        placements: Candidate resting positions of a block's centre, (M, 3) [m].
        placement_properties: Feature space (`location`) to the concept number of each placement, (M,).
        placement_relations: Like `relations`, for a block at placement m as seen from object j, (M, N).
        support: Index of the object directly below each placement, -1 for the table, (M,).
        clear: Whether nothing rests on the object, (N,).
        held: Index (not id) of the object in the gripper, or None.
    """

    object_ids: IntArray
    location: FloatArray
    properties: Mapping[str, IntArray]
    relations: Mapping[str, IntArray]
    placements: FloatArray
    placement_properties: Mapping[str, IntArray]
    placement_relations: Mapping[str, IntArray]
    support: IntArray
    clear: NDArray[np.bool_]
    held: int | None


@dataclass(frozen=True, slots=True)
class ShownAction:
    """What a demo showed, in the same symbols: the vision tree's content (thesis 5.2).

    Attributes:
        action: Number of the action graphlet (`action_<n>`).
        parts: Numbers of all known action graphlets that this one contains, itself included.
        moved: Index of the manipulated object in the percept.
        placement: Index of the placement where it ended, or None when it ended in the gripper.
        final_location: Where it ended, (3,) [m].
    """

    action: int
    parts: tuple[int, ...]
    moved: int
    placement: int | None
    final_location: FloatArray
