"""A robot: its joints, limits, gripper and kinematics, in the frame of the world where it stands."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .errors import RobotError
from .inverse_kinematics import MAX_RESTARTS, IkResult, solve_position
from .kinematics import Kinematics, quaternion_xyzw, rotation_matrix
from .pose import FloatArray, Pose, read_only
from .robot_file import RobotFile, read_robot_file
from .urdf import Mimic, Urdf, read_urdf

_TABLE_SIZE = 256
"""Postures spread over the joint ranges from which the nearest serve as starts of inverse kinematics."""


@dataclass(frozen=True, slots=True)
class Gripper:
    """Two parallel fingers, each joint position being half of the gap between them.

    Attributes:
        joints: The two finger joints.
        max_opening: Gap when open [m].
        force: Closing force of each finger [N].
        closing_speed: Speed of each finger [m/s].
    """

    joints: tuple[str, str]
    max_opening: float
    force: float
    closing_speed: float


class RobotModel:
    """A robot read from a folder with `robot.toml` and a URDF. Use `load_robot` to get one.

    Attributes:
        folder: The folder it was read from.
        name: Name of the robot.
        description: One line about it.
        urdf_path: The URDF file.
        joint_names: Driven joints, n of them; all arrays follow this order.
        lower: Lower position limits, (n,) [rad].
        upper: Upper position limits, (n,) [rad].
        velocity: Velocity limits, (n,) [rad/s].
        acceleration: Acceleration limits, (n,) [rad/s²].
        jerk: Jerk limits, (n,) [rad/s³].
        home: Home posture, (n,) [rad].
        mimic: Passive joints that follow driven ones.
        tool_frame: Link whose pose is the tool's: between the finger tips.
        gripper: The fingers.
        pose_base_in_world: Where the base stands; `placed_at` gives the same robot elsewhere.
    """

    def __init__(self, folder: Path, pose_base_in_world: Pose | None = None) -> None:
        """Read a robot folder.

        Args:
            folder: Folder that holds `robot.toml`.
            pose_base_in_world: Where the base stands; None takes the file's `[base]`.

        Raises:
            RobotError: A file is missing or wrong; names file, key and what is allowed.
        """
        self.folder = folder
        toml = folder / "robot.toml"
        spec = read_robot_file(toml)
        self.name = spec.name
        self.description = spec.description
        self.urdf_path = folder / spec.urdf
        urdf = read_urdf(self.urdf_path)
        _check_against_urdf(spec, urdf, toml)
        self.joint_names = spec.arm.joints
        self.lower = read_only([urdf.joints[name].lower for name in self.joint_names])
        self.upper = read_only([urdf.joints[name].upper for name in self.joint_names])
        self.velocity = read_only(spec.arm.velocity)
        self.acceleration = read_only(spec.arm.acceleration)
        self.jerk = read_only(spec.arm.jerk)
        self.home = read_only(spec.arm.home)
        self.mimic = _arm_mimic(urdf, self.joint_names)
        self.tool_frame = spec.arm.tool_frame
        self.gripper = Gripper(
            (spec.gripper.joints[0], spec.gripper.joints[1]),
            spec.gripper.max_opening,
            spec.gripper.force,
            spec.gripper.closing_speed,
        )
        self.pose_base_in_world = pose_base_in_world or Pose(
            np.array(spec.base.position), np.array(spec.base.orientation_xyzw)
        )
        self._base_position = self.pose_base_in_world.position
        self._base_rotation = rotation_matrix(self.pose_base_in_world.orientation_xyzw)
        self._kinematics = Kinematics(self.urdf_path, self.joint_names, self.mimic, self.tool_frame)
        self._table: tuple[FloatArray, FloatArray] | None = None

    def __repr__(self) -> str:
        """Name, joints and place."""
        return f"RobotModel({self.name!r}, joints={self.joint_names}, base={self._base_position.tolist()})"

    def placed_at(self, pose_base_in_world: Pose) -> "RobotModel":
        """The same robot with its base elsewhere."""
        return RobotModel(self.folder, pose_base_in_world)

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
        self, position: FloatArray, start: FloatArray | None = None, tolerance: float = 1e-5
    ) -> IkResult:
        """Find a posture that brings the tool to a position.

        Args:
            position: Wanted tool position in the world, (3,) [m].
            start: Posture to start from, (n,) [rad]; None starts at the known posture nearest to the position.
            tolerance: Accepted distance [m].

        Returns:
            Posture inside the limits, success and error. Equal questions get equal answers: restarts come from a fixed
            set of postures.
        """
        target = np.asarray(position, dtype=float)
        if target.shape != (3,) or not np.isfinite(target).all():
            raise RobotError(f"position must be three finite numbers [m], got {position!r}")

        def evaluate(q: FloatArray) -> tuple[FloatArray, FloatArray]:
            at, jacobian = self.position_and_jacobian(q)
            return at, jacobian[:3]

        bounds = (self.lower, self.upper, tolerance)
        if start is not None:
            result = solve_position(evaluate, target, [self._vector(start)], *bounds)
            if result.success:
                return result
        retry = solve_position(evaluate, target, self._starts(target), *bounds)
        if start is None or retry.error < result.error:
            return retry
        return result

    def expand(self, q: FloatArray) -> dict[str, float]:
        """Positions of driven and passive joints by name, for driven positions q (n,) [rad]."""
        positions = dict(zip(self.joint_names, self._vector(q).tolist(), strict=True))
        for each in self.mimic:
            positions[each.joint] = each.ratio * positions[each.source] + each.offset
        return positions

    def _vector(self, q: FloatArray) -> FloatArray:
        """Check the shape of joint values."""
        vector = np.asarray(q, dtype=float)
        if vector.shape != self.lower.shape:
            raise RobotError(f"{self.name} has {self.lower.size} driven joints, got values of shape {vector.shape}")
        return vector

    def _starts(self, target: FloatArray) -> list[FloatArray]:
        """Postures whose tool positions are nearest to a target (3,), nearest first."""
        if self._table is None:
            # A fixed generator: the table is a property of the robot, like its limits.
            draws = np.random.default_rng(0).random((_TABLE_SIZE, self.lower.size))
            lower, upper = np.maximum(self.lower, -np.pi), np.minimum(self.upper, np.pi)
            postures = np.concatenate((self.home[None], lower + draws * (upper - lower)))
            self._table = postures, np.array([self.position_and_jacobian(q)[0] for q in postures])
        postures, positions = self._table
        order = np.argsort(np.linalg.norm(positions - target, axis=1), kind="stable")
        return list(postures[order[: MAX_RESTARTS + 1]])


def _arm_mimic(urdf: Urdf, driven: tuple[str, ...]) -> tuple[Mimic, ...]:
    """The joints that mimic a driven one."""
    return tuple(joint.mimic for joint in urdf.joints.values() if joint.mimic and joint.mimic.source in driven)


def _check_against_urdf(spec: RobotFile, urdf: Urdf, toml: Path) -> None:
    """Check what robot.toml says against the URDF.

    Raises:
        RobotError: A joint or frame is not in the URDF, a posture leaves the limits, or a limit is above the URDF's.
    """
    movable = ", ".join(urdf.joints)
    for key, names in (("arm.joints", spec.arm.joints), ("gripper.joints", spec.gripper.joints)):
        for name in names:
            if name not in urdf.joints:
                raise RobotError(f"{toml}: {key}: no movable joint {name!r} in {spec.urdf}; it has {movable}")
            if urdf.joints[name].mimic is not None:
                raise RobotError(f"{toml}: {key}: {name!r} mimics another joint and cannot be driven")
    if spec.arm.tool_frame not in urdf.links:
        raise RobotError(
            f"{toml}: arm.tool_frame: no link {spec.arm.tool_frame!r} in {spec.urdf}; it has {', '.join(urdf.links)}"
        )
    for index, name in enumerate(spec.arm.joints):
        joint = urdf.joints[name]
        home, velocity = spec.arm.home[index], spec.arm.velocity[index]
        if not joint.lower <= home <= joint.upper:
            raise RobotError(f"{toml}: arm.home: {name} must be in {joint.lower}..{joint.upper} rad, got {home}")
        if velocity > joint.velocity:
            raise RobotError(f"{toml}: arm.velocity: {name} may be at most {joint.velocity} rad/s, got {velocity}")
    for name in spec.gripper.joints:
        reach = urdf.joints[name].upper
        if spec.gripper.max_opening > 2 * reach + 1e-9:
            raise RobotError(
                f"{toml}: gripper.max_opening: {name} opens to {reach} m, so at most {2 * reach}, "
                f"got {spec.gripper.max_opening}"
            )
