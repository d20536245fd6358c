"""One arm of a robot: a chain of driven joints with a gripper at its end, in the frame of the world."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from .errors import RobotError
from .gripper import Gripper
from .ik_mask import TaskMask
from .ik_result import IkResult
from .inverse_kinematics import MAX_RESTARTS, IkSolver
from .kinematics import Kinematics, quaternion_xyzw, rotation_matrix
from .pose import FloatArray, Pose, read_only
from .robot_file import ArmSection
from .urdf import Mimic, Urdf


class ArmModel:
    """An arm. `RobotModel.arms` has those of a robot.

    Attributes:
        name: Name of the arm, such as `left`.
        joint_names: Driven joints, n of them; all arrays follow this order.
        lower: Lower position limits, (n,) [rad]; -inf where a joint turns for ever.
        upper: Upper position limits, (n,) [rad].
        velocity: Velocity limits, (n,) [rad/s].
        acceleration: Acceleration limits, (n,) [rad/s²].
        jerk: Jerk limits, (n,) [rad/s³].
        home: Home posture, (n,) [rad].
        motor_force: Largest force of each drive in physics [Nm or N]; 0 where the URDF's effort is meant.
        mimic: Passive joints that follow driven ones.
        tool_frame: Link whose pose is the tool's: between the finger tips.
        gripper: The fingers.
        pose_base_in_world: Where the robot's base stands.
    """

    def __init__(
        self,
        spec: ArmSection,
        urdf: Urdf,
        urdf_path: Path,
        gripper: Gripper,
        base: Pose,
        called: str,
        locked: Mapping[str, float],
    ) -> None:
        """Take an arm from a checked robot file; messages call it `called`. Joints that nothing drives are locked."""
        self.name = spec.name
        self._called = called
        self.joint_names = spec.joints
        self.lower = read_only([urdf.joints[name].lower for name in self.joint_names])
        self.upper = read_only([urdf.joints[name].upper for name in self.joint_names])
        self.velocity = read_only(spec.velocity)
        self.acceleration = read_only(spec.acceleration)
        self.jerk = read_only(spec.jerk)
        self.home = read_only(spec.home)
        self.motor_force = spec.motor_force or (0.0,) * len(self.joint_names)
        self.mimic = _mimicking(urdf, self.joint_names)
        self.tool_frame = spec.tool_frame
        self.gripper = gripper
        self._kinematics = Kinematics(urdf_path, self.joint_names, self.mimic, self.tool_frame, locked)
        self._solver = IkSolver(self._kinematics, self.lower, self.upper, self.home)
        self._stand(base)

    def __repr__(self) -> str:
        """Name and joints."""
        return f"ArmModel({self.name!r}, joints={self.joint_names})"

    def placed_at(self, pose_base_in_world: Pose) -> "ArmModel":
        """The same arm with the robot's base elsewhere."""
        other = object.__new__(ArmModel)
        other.__dict__.update(self.__dict__)
        other._kinematics = self._kinematics.copy()
        other._solver = self._solver.with_kinematics(other._kinematics)
        other._stand(pose_base_in_world)
        return other

    def _stand(self, pose_base_in_world: Pose) -> None:
        self.pose_base_in_world = pose_base_in_world
        self._base_position = pose_base_in_world.position
        self._base_rotation = rotation_matrix(pose_base_in_world.orientation_xyzw)

    def forward_kinematics(self, q: FloatArray) -> Pose:
        """Pose of the tool in the world for driven positions q (n,) [rad]."""
        rotation, position = self._kinematics.placement(self._vector(q))
        return Pose(
            self._base_rotation @ position + self._base_position, quaternion_xyzw(self._base_rotation @ rotation)
        )

    def jacobian(self, q: FloatArray) -> FloatArray:
        """Jacobian of the tool (6, n): linear [m/rad] then angular rows, along the axes of the world."""
        return self.position_and_jacobian(q)[1]

    def position_and_jacobian(self, q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Tool position in the world (3,) [m] and Jacobian (6, n), in one pass (for control loops)."""
        _, position, jacobian = self._kinematics.placement_and_jacobian(self._vector(q))
        turned = np.concatenate((self._base_rotation @ jacobian[:3], self._base_rotation @ jacobian[3:]))
        return self._base_rotation @ position + self._base_position, turned

    def inverse_kinematics(
        self,
        target: Pose | FloatArray,
        start: FloatArray | None = None,
        tolerance: float = 1e-5,
        *,
        orientation_tolerance: float = 1e-4,
        posture: FloatArray | None = None,
        mask: TaskMask | None = None,
        max_restarts: int = MAX_RESTARTS,
    ) -> IkResult:
        """Find a posture that brings the tool to a pose, a position, or what of a pose counts.

        Args:
            target: Wanted tool pose in the world, or its position alone, (3,) [m].
            start: Posture to start from and stay near to, (n,) [rad]; None starts at known postures near the target.
            tolerance: Accepted distance [m].
            orientation_tolerance: Accepted angle [rad].
            posture: Posture that the freedom left by the task is used to come near to, (n,).
            mask: Which axes count, of the tool or of the robot's base; None takes all six of a pose, or the position.
            max_restarts: How many starts may follow the first one.

        Returns:
            Posture inside the limits, success, errors and, without success, the reason. Equal questions get equal
            answers: restarts come from a fixed set of postures.

        Raises:
            RobotError: The target is not finite or has the wrong shape.
        """
        return self._solver.solve(
            self._in_base(target),
            None if start is None else self._vector(start),
            None if posture is None else self._vector(posture),
            mask,
            tolerance,
            orientation_tolerance,
            max_restarts,
        )

    def _in_base(self, target: Pose | FloatArray) -> Pose | FloatArray:
        """A target in the base frame; what is no target is passed on to be refused."""
        turn = self._base_rotation.T
        if isinstance(target, Pose):
            position = turn @ (target.position - self._base_position)
            return Pose(position, quaternion_xyzw(turn @ rotation_matrix(target.orientation_xyzw)))
        wanted = np.asarray(target, dtype=float)
        return turn @ (wanted - self._base_position) if wanted.shape == (3,) else wanted

    def expand(self, q: FloatArray) -> dict[str, float]:
        """Positions of driven and passive joints by name, for driven positions q (n,) [rad]."""
        positions = dict(zip(self.joint_names, self._vector(q).tolist(), strict=True))
        for each in self.mimic:
            positions[each.joint] = each.follow(positions[each.source])
        return positions

    def _vector(self, q: FloatArray) -> FloatArray:
        """Check the shape of joint values."""
        vector = np.asarray(q, dtype=float)
        if vector.shape != self.lower.shape:
            raise RobotError(f"{self._called} has {self.lower.size} driven joints, got values of shape {vector.shape}")
        return vector


def _mimicking(urdf: Urdf, driven: tuple[str, ...]) -> tuple[Mimic, ...]:
    """The joints that mimic a driven one."""
    return tuple(joint.mimic for joint in urdf.joints.values() if joint.mimic and joint.mimic.source in driven)
