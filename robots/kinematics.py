"""The door to Pinocchio: tool pose and Jacobian of a chain with mimicking joints, in the base frame."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from .errors import RobotError
from .pose import FloatArray, Pose
from .urdf import Mimic


@dataclass(frozen=True, slots=True)
class Chain:
    """Joints from the base to the tool, each of which carries the next.

    Attributes:
        joints: For each, (m, 19): rotation matrix, row by row, and translation to its frame (12); its axis there (3);
            1 if it slides, 0 if it turns; the index of the driven joint that it follows, ratio and offset.
        tool: Rotation matrix and translation from the last joint's frame to the tool's, (12,).
    """

    joints: FloatArray
    tool: FloatArray


class Kinematics:
    """Forward kinematics and Jacobian of one tool frame over the driven joints.

    Passive joints are folded in: with full positions q_full = M q + offset, the Jacobian of the driven joints is
    J_full M. All other joints stay where they are locked, or at their neutral position. Not safe to share between
    threads: Pinocchio keeps its results in one `Data`.
    """

    def __init__(
        self,
        urdf: Path,
        driven: Sequence[str],
        mimic: Sequence[Mimic],
        tool_frame: str,
        locked: Mapping[str, float] | None = None,
    ) -> None:
        """Build the reduced model.

        Raises:
            RobotError: Pinocchio cannot read the URDF, or it has no such frame.
        """
        full = whole_model(urdf)
        moving = {*driven, *(each.joint for each in mimic)}
        still = [full.getJointId(name) for name in full.names[1:] if name not in moving]
        self._model = pin.buildReducedModel(full, still, configuration(full, locked or {}))
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
        # Without passive joints, driven joints are Pinocchio's own: time is saved in solvers' loops.
        square = self._matrix.shape[0] == self._matrix.shape[1]
        self._direct = square and not self._offset.any() and bool((self._matrix == np.eye(len(self._offset))).all())

    def copy(self) -> "Kinematics":
        """The same chain with results of its own: for another thread, or another place of the base."""
        other = object.__new__(Kinematics)
        other.__dict__.update(self.__dict__)
        other._data = self._model.createData()
        return other

    def _velocity_index(self, joint: str) -> int:
        return int(self._model.joints[self._model.getJointId(joint)].idx_v)

    def _full(self, q: FloatArray) -> FloatArray:
        """Pinocchio's configuration (nq,) for driven positions (n,)."""
        full = q if self._direct else self._matrix @ q + self._offset
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
        return placement.rotation, placement.translation, jacobian if self._direct else jacobian @ self._matrix

    def chain(self) -> Chain:
        """The chain's geometry as plain numbers, for compiled solvers.

        Raises:
            RobotError: A joint of the chain has more than one degree of freedom.
        """
        data, rows = self._model.createData(), []
        frame = self._model.frames[self._frame]
        pin.computeJointJacobians(self._model, data, self._neutral)
        for index in list(self._model.supports[frame.parentJoint])[1:]:
            joint = self._model.joints[index]
            if joint.nv != 1:
                raise RobotError(f"joint {self._model.names[index]} must turn about or slide along one axis")
            motion = pin.getJointJacobian(self._model, data, index, pin.ReferenceFrame.LOCAL)[:, joint.idx_v]
            slides = bool(np.abs(motion[:3]).max() > np.abs(motion[3:]).max())
            axis = motion[:3] if slides else motion[3:]
            placement, follows = self._model.jointPlacements[index], self._matrix[joint.idx_v]
            source = int(np.argmax(np.abs(follows)))
            tail = [float(slides), float(source), follows[source], self._offset[joint.idx_v]]
            rows.append(np.concatenate((placement.rotation.ravel(), placement.translation, axis, tail)))
        tool = np.concatenate((frame.placement.rotation.ravel(), frame.placement.translation))
        return Chain(np.array(rows).reshape(-1, 19), tool)


@lru_cache(maxsize=16)
def _read_model(urdf: Path, changed: float) -> Any:
    del changed  # part of the key: a file that was written anew is read anew
    try:
        return pin.buildModelFromUrdf(str(urdf))
    except (ValueError, RuntimeError) as error:
        raise RobotError(f"{urdf}: Pinocchio cannot read it: {' '.join(str(error).split())}") from error


def whole_model(urdf: Path) -> Any:
    """Pinocchio's model of a URDF, which nobody may change.

    Raises:
        RobotError: Pinocchio cannot read the URDF.
    """
    return _read_model(urdf, urdf.stat().st_mtime)


def configuration(model: Any, joints: Mapping[str, float]) -> FloatArray:
    """Pinocchio's configuration (nq,) for joint positions by name; the other joints are at neutral.

    Continuous joints are (cos, sin) in Pinocchio.
    """
    change = np.zeros(model.nv)
    for name, value in joints.items():
        change[model.joints[model.getJointId(name)].idx_v] = value
    return np.asarray(pin.integrate(model, pin.neutral(model), change))


def frame_pose(urdf: Path, joints: Mapping[str, float], frame: str) -> Pose:
    """Pose of a frame in the base frame, for joint positions by name; the other joints are at neutral.

    Raises:
        RobotError: There is no such frame.
    """
    model = whole_model(urdf)
    if not model.existFrame(frame):
        raise RobotError(f"{urdf}: no frame {frame!r}; it has {', '.join(each.name for each in model.frames[1:])}")
    data = model.createData()
    pin.framesForwardKinematics(model, data, configuration(model, joints))
    placement = data.oMf[model.getFrameId(frame)]
    return Pose(placement.translation.copy(), quaternion_xyzw(placement.rotation))


def frame_positions(urdf: Path, joints: Mapping[str, float], frames: Sequence[str]) -> list[FloatArray]:
    """Positions (3,) [m] of frames in the base frame, for joint positions by name; the other joints are at neutral."""
    model = whole_model(urdf)
    data = model.createData()
    pin.framesForwardKinematics(model, data, configuration(model, joints))
    return [data.oMf[model.getFrameId(frame)].translation.copy() for frame in frames]


_ORIGIN = np.zeros(3)


def quaternion_xyzw(rotation: FloatArray) -> FloatArray:
    """Unit quaternion (4,) of a rotation matrix (3, 3), with w >= 0."""
    # Not by pin.Quaternion(rotation): each of those takes 80 bytes that nobody gives back.
    values = pin.SE3ToXYZQUAT(pin.SE3(np.asarray(rotation, dtype=float), _ORIGIN))[3:]
    return np.asarray(-values if values[3] < 0 else values)


def rotation_matrix(orientation_xyzw: FloatArray) -> FloatArray:
    """Rotation matrix (3, 3) of a quaternion (4,), which is normalized first."""
    x, y, z, w = np.asarray(orientation_xyzw, dtype=float) / np.linalg.norm(orientation_xyzw)
    return np.asarray(pin.Quaternion(w, x, y, z).toRotationMatrix())


def rpy_matrix(rpy: Sequence[float]) -> FloatArray:
    """Rotation matrix (3, 3) of a URDF's roll, pitch and yaw [rad]: fixed axes, x first."""
    return np.asarray(pin.rpy.rpyToMatrix(np.array(rpy, dtype=float)))
