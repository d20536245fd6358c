"""The straight way between two poses: the position on a line, the orientation turning about one axis (slerp)."""

import numpy as np
from scipy.spatial.transform import Rotation

from robots.pose import FloatArray, Pose

from .errors import MotionError, listed


class PoseLine:
    """Poses from `start` to `end`, by fraction of the way.

    Attributes:
        length: Of the way of the position [m].
        angle: By which the orientation turns [rad], 0 to pi.
    """

    def __init__(self, start: Pose, end: Pose) -> None:
        """Prepare the line.

        Raises:
            MotionError: A number is not finite or a quaternion is zero.
        """
        for name, pose in (("start", start), ("goal", end)):
            values = np.concatenate([pose.position, pose.orientation_xyzw])
            if values.shape != (7,) or not np.all(np.isfinite(values)) or not np.any(pose.orientation_xyzw):
                raise MotionError(
                    f"the {name} pose must be 3 + 4 finite numbers, no zero quaternion; got {listed(values)}"
                )
        self._position, self._step = start.position, end.position - start.position
        self._rotation = Rotation.from_quat(start.orientation_xyzw)
        # Axis times angle of the turn, in the world's axes.
        self._turn = (Rotation.from_quat(end.orientation_xyzw) * self._rotation.inv()).as_rotvec()
        self.length = float(np.linalg.norm(self._step))
        self.angle = float(np.linalg.norm(self._turn))

    def at(self, fraction: float) -> Pose:
        """The pose at a fraction of the way, 0 to 1."""
        rotation = Rotation.from_rotvec(self._turn * fraction) * self._rotation
        return Pose(self._position + fraction * self._step, rotation.as_quat())


def pose_error(wanted: Pose, pose: Pose) -> FloatArray:
    """Translation [m] and rotation vector [rad] in the world's axes that carry `pose` to `wanted`, (6,)."""
    turn = Rotation.from_quat(wanted.orientation_xyzw) * Rotation.from_quat(pose.orientation_xyzw).inv()
    return np.concatenate([wanted.position - pose.position, turn.as_rotvec()])
