"""What the executor sees of a scene when it looks: noisy places of objects and tool, nothing of the true state."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from learning.perception.observation import Observation
from robots.pose import FloatArray, read_only

HELD_WITHIN = 0.030
"""An object whose centre is nearer than this to the tool frame of a closed gripper is held [m]: half a block's
diagonal plus noise, and less than the distance to a neighbouring block."""


@dataclass(frozen=True, slots=True)
class Sight:
    """Places in the world frame, averaged over the frames of one look.

    Attributes:
        object_ids: Track numbers, (N,).
        location: Object centres, (N, 3) [m].
        tool: Tool frame, (3,) [m].
        gripper_closed: Whether the gripper was last told to close.
        held: Track number of the object between the closed fingers, else None.
    """

    object_ids: NDArray[np.int64]
    location: FloatArray
    tool: FloatArray
    gripper_closed: bool
    held: int | None

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        object.__setattr__(self, "location", read_only(self.location))
        object.__setattr__(self, "tool", read_only(self.tool))

    @classmethod
    def of(cls, observation: Observation) -> "Sight":
        """Average the frames of a look at a scene that stands still."""
        location = observation.location.mean(axis=0)
        tool = observation.gripper_location.mean(axis=0)
        closed = bool(observation.gripper_closed[-1])
        held = None
        if closed and len(observation.object_ids):
            distance = np.linalg.norm(location - tool, axis=1)
            nearest = int(distance.argmin())
            if distance[nearest] < HELD_WITHIN:
                held = int(observation.object_ids[nearest])
        return cls(observation.object_ids, location, tool, closed, held)

    def where(self, object_id: int) -> FloatArray:
        """Centre of one object, (3,) [m].

        Raises:
            KeyError: There is no such track.
        """
        found = np.flatnonzero(self.object_ids == object_id)
        if not len(found):
            raise KeyError(object_id)
        place: FloatArray = self.location[int(found[0])]
        return place
