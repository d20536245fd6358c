"""The door to Pinocchio: tool pose and Jacobian of a chain with mimicking joints, in the base frame."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pinocchio as pin

from .errors import RobotError
from .pose import FloatArray
from .urdf import Mimic


class Kinematics:
    """Forward kinematics and Jacobian of one tool frame over the driven joints.

    Passive joints are folded in: with full positions q_full = M q + offset, the Jacobian of the driven joints is
    J_full M. All other joints stay at their neutral position. Not safe to share between threads: Pinocchio keeps its
    results in one `Data`.
    """

    def __init__(self, urdf: Path, driven: Sequence[str], mimic: Sequence[Mimic], tool_frame: str) -> None:
        """Build the reduced model.

        Raises:
            RobotError: Pinocchio cannot read the URDF, or it has no such frame.
        """
        try:
            full = pin.buildModelFromUrdf(str(urdf))
        except (ValueError, RuntimeError) as error:
            raise RobotError(f"{urdf}: Pinocchio cannot read it: {error}") from error
        moving = {*driven, *(each.joint for each in mimic)}
        locked = [full.getJointId(name) for name in full.names[1:] if name not in moving]
        self._model = pin.buildReducedModel(full, locked, pin.neutral(full))
        if not self._model.existFrame(tool_frame):
            frames = ", ".join(frame.name for frame in self._model.frames[1:])
            raise RobotError(f"{urdf}: no frame {tool_frame!r}; it has {frames}")
        self._data = self._model.createData()
        self._frame = self._model.getFrameId(tool_frame)
        self._neutral = pin.neutral(self._model)
        self._matrix = np.zeros((self._model.nv, len(driven)))
        self._offset = np.zeros(self._model.nv)
        column = {name: index for index, name in enumerate(driven)}
        for name, index in column.items():
            self._matrix[self._velocity_index(name), index] = 1.0
        for each in mimic:
            row = self._velocity_index(each.joint)
            self._matrix[row, column[each.source]] = each.ratio
            self._offset[row] = each.offset
        # Continuous joints are (cos, sin) in Pinocchio, so that positions differ from velocities in number.
        self._plain = self._model.nq == self._model.nv

    def _velocity_index(self, joint: str) -> int:
        return int(self._model.joints[self._model.getJointId(joint)].idx_v)

    def _full(self, q: FloatArray) -> FloatArray:
        """Pinocchio's configuration (nq,) for driven positions (n,)."""
        full = self._matrix @ q + self._offset
        return full if self._plain else np.asarray(pin.integrate(self._model, self._neutral, full))

    def placement(self, q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Rotation matrix (3, 3) and position (3,) [m] of the tool in the base frame, for q (n,)."""
        pin.framesForwardKinematics(self._model, self._data, self._full(q))
        placement = self._data.oMf[self._frame]
        return placement.rotation, placement.translation

    def placement_and_jacobian(self, q: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """As `placement`, and the Jacobian (6, n): linear then angular rows, axes of the base frame."""
        jacobian = pin.computeFrameJacobian(
            self._model, self._data, self._full(q), self._frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        )
        pin.updateFramePlacement(self._model, self._data, self._frame)
        placement = self._data.oMf[self._frame]
        return placement.rotation, placement.translation, jacobian @ self._matrix


def quaternion_xyzw(rotation: FloatArray) -> FloatArray:
    """Unit quaternion (4,) of a rotation matrix (3, 3), with w >= 0."""
    values = pin.Quaternion(rotation).coeffs()
    return np.asarray(-values if values[3] < 0 else values)


def rotation_matrix(orientation_xyzw: FloatArray) -> FloatArray:
    """Rotation matrix (3, 3) of a quaternion (4,), which is normalized first."""
    x, y, z, w = np.asarray(orientation_xyzw, dtype=float) / np.linalg.norm(orientation_xyzw)
    return np.asarray(pin.Quaternion(w, x, y, z).toRotationMatrix())
