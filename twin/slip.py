"""Whether what the fingers hold moves in them: measured against where it was when they had closed."""

from dataclasses import dataclass

import numpy as np

from robots.kinematics import rotation_matrix
from robots.pose import FloatArray, Pose

from .errors import TwinError
from .state import WorldState

SLIPPED = 0.005
"""An object that moved this far [m] in the hand has slipped."""
TURNED = 0.26
"""An object that turned this far [rad] in the hand has slipped: 15 degrees."""


@dataclass(frozen=True, slots=True)
class Slip:
    """How a held object has moved in the hand since it was gripped.

    Attributes:
        distance: Of the object's centre in the tool frame [m].
        angle: By which it turned in the tool frame [rad].
        lost: Whether the fingers do not both touch it any more.
    """

    distance: float
    angle: float
    lost: bool

    @property
    def slipped(self) -> bool:
        """Whether it moved more than a firm hold allows."""
        return self.lost or self.distance > SLIPPED or self.angle > TURNED


class SlipMonitor:
    """Watches one held object. Make it when the fingers have closed.

    Args:
        state: The world then.
        arm: Number of the arm that holds, in the robot's order.
        object_id: What it holds.

    Raises:
        TwinError: There is no such object.
    """

    def __init__(self, state: WorldState, arm: int, object_id: int) -> None:
        self._arm = arm
        self._id = object_id
        self._rotation, self._position = self._in_tool(state)

    def measure(self, state: WorldState) -> Slip:
        """Compare a later state of the same world."""
        rotation, position = self._in_tool(state)
        cosine = (np.trace(self._rotation.T @ rotation) - 1.0) / 2.0
        return Slip(
            distance=float(np.linalg.norm(position - self._position)),
            angle=float(np.arccos(np.clip(cosine, -1.0, 1.0))),
            lost=state.arms[self._arm].held != self._id,
        )

    def _in_tool(self, state: WorldState) -> tuple[FloatArray, FloatArray]:
        """Rotation matrix (3, 3) and position (3,) [m] of the object in the tool frame."""
        tool = state.arms[self._arm].pose_tool_in_world
        thing = _pose_of(state, self._id)
        back = rotation_matrix(tool.orientation_xyzw).T
        return back @ rotation_matrix(thing.orientation_xyzw), back @ (thing.position - tool.position)


def _pose_of(state: WorldState, object_id: int) -> Pose:
    for each in state.objects:
        if each.id == object_id:
            return each.pose_object_in_world
    raise TwinError(f"no object {object_id}; the scene has {', '.join(str(each.id) for each in state.objects)}")
