"""A robot: its arms, grippers and base, in the frame of the world where it stands."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np

from .arm_model import ArmModel
from .errors import RobotError
from .gripper import Gripper
from .ik_result import IkResult
from .pose import FloatArray, Pose, read_only
from .prepared_urdf import prepare_urdf
from .robot_check import check_against_urdf
from .robot_file import DriveSection, RobotFile, read_robot_file
from .robot_gripper import make_gripper
from .urdf import Urdf, read_urdf


@dataclass(frozen=True, slots=True)
class Drive:
    """A base on two driven wheels, which rolls over the floor in the direction of its x axis.

    Attributes:
        wheels: The joints of the left and the right wheel.
        wheel_radius: Radius on which they roll [m].
        track: Distance between them [m].
        speed: Limit of the speed [m/s], then of acceleration [m/s²] and jerk [m/s³].
        acceleration: See `speed`.
        jerk: See `speed`.
        yaw_rate: Limit of the turning speed [rad/s], then of acceleration [rad/s²] and jerk [rad/s³].
        yaw_acceleration: See `yaw_rate`.
        yaw_jerk: See `yaw_rate`.
        rollers: Links that slide over the floor without friction.
        on_floor: Links that touch the floor: wheels and rollers.
    """

    wheels: tuple[str, str]
    wheel_radius: float
    track: float
    speed: float
    acceleration: float
    jerk: float
    yaw_rate: float
    yaw_acceleration: float
    yaw_jerk: float
    rollers: tuple[str, ...]
    on_floor: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class CameraMount:
    """A camera on a link.

    Attributes:
        name: Name of the camera.
        link: The link that carries it.
        sensor: Kind of sensor, `kinect2` or `xtion`.
        pose_camera_in_link: The optical frame: x right, y down, z forward.
    """

    name: str
    link: str
    sensor: str
    pose_camera_in_link: Pose


class RobotModel:
    """A robot read from a folder with `robot.toml` and a URDF. Use `load_robot` to get one.

    A robot with a single arm can be asked for kinematics itself; one with several has them in `arms`. The arrays of
    the robot are those of its arms, one after the other.

    Attributes:
        folder: The folder it was read from.
        name: Name of the robot.
        description: One line about it.
        urdf_path: The URDF file, as prepared for use: meshes found and decimated, fingers mounted.
        arms: Its arms by name, in the file's order.
        drive: Its wheeled base, or None where the base is fixed.
        cameras: Cameras that it carries, by name.
        floor: Height of the floor in the base frame [m], None where it stands on the table.
        joint_names: Driven joints of all arms, n of them.
        lower: Lower position limits, (n,) [rad].
        upper: Upper position limits, (n,) [rad].
        velocity: Velocity limits, (n,) [rad/s].
        acceleration: Acceleration limits, (n,) [rad/s²].
        jerk: Jerk limits, (n,) [rad/s³].
        home: Home posture, (n,) [rad].
        mimic: Passive joints that follow driven ones, those of the fingers included.
        locked: Positions of joints that nothing drives, and of those that mimic them.
        may_touch: Pairs of links whose contact is not a collision.
        pose_base_in_world: Where the base stands; `placed_at` gives the same robot elsewhere.
    """

    def __init__(
        self, folder: Path, pose_base_in_world: Pose | None = None, *, finger_mounting: float | None = None
    ) -> None:
        """Read a robot folder.

        Args:
            folder: Folder that holds `robot.toml`.
            pose_base_in_world: Where the base stands; None takes the file's `[base]`.
            finger_mounting: How far outwards each finger is mounted [m]; None takes the file's.

        Raises:
            RobotError: A file is missing or wrong; names file, key and what is allowed.
        """
        self.folder = folder
        toml = folder / "robot.toml"
        spec = _mounted(read_robot_file(toml), finger_mounting)
        self.name = spec.name
        self.description = spec.description
        self.urdf_path = prepare_urdf(folder, spec)
        urdf = read_urdf(self.urdf_path)
        check_against_urdf(spec, urdf, toml)
        base = pose_base_in_world or Pose(np.array(spec.base.position), np.array(spec.base.orientation_xyzw))
        self.pose_base_in_world = base
        locked = _locked(spec, urdf)
        arms = {}
        for each in spec.arms:
            gripper = make_gripper(each, urdf, self.urdf_path, toml)
            called = spec.name if len(spec.arms) == 1 else f"{spec.name}'s arm {each.name}"
            arms[each.name] = ArmModel(each, urdf, self.urdf_path, gripper, base, called, locked)
        self.arms: Mapping[str, ArmModel] = MappingProxyType(arms)
        self.joint_names = tuple(name for arm in arms.values() for name in arm.joint_names)
        self.lower, self.upper, self.velocity, self.acceleration, self.jerk, self.home = (
            read_only(np.concatenate([getattr(arm, key) for arm in arms.values()]))
            for key in ("lower", "upper", "velocity", "acceleration", "jerk", "home")
        )
        fingers = {name for arm in arms.values() for name in arm.gripper.joints}
        self.finger_mimic = tuple(
            joint.mimic
            for joint in urdf.joints.values()
            if joint.mimic and joint.mimic.source in fingers and joint.name not in fingers
        )
        self.mimic = tuple(each for arm in arms.values() for each in arm.mimic) + self.finger_mimic
        self.locked: Mapping[str, float] = MappingProxyType(locked)
        self.may_touch = frozenset(frozenset(pair) for pair in spec.collision.ignore)
        self.floor = spec.floor
        self.drive = None if spec.drive is None else _drive(spec.drive, urdf)
        self.cameras: Mapping[str, CameraMount] = MappingProxyType(
            {
                name: CameraMount(
                    name, each.link, each.sensor, Pose(np.array(each.position), np.array(each.orientation_xyzw))
                )
                for name, each in spec.cameras.items()
            }
        )

    def __repr__(self) -> str:
        """Name, joints and place."""
        base = self.pose_base_in_world.position.tolist()
        return f"RobotModel({self.name!r}, joints={self.joint_names}, base={base})"

    def placed_at(self, pose_base_in_world: Pose) -> "RobotModel":
        """The same robot with its base elsewhere."""
        other = object.__new__(RobotModel)
        other.__dict__.update(self.__dict__)
        other.pose_base_in_world = pose_base_in_world
        other.arms = MappingProxyType({name: arm.placed_at(pose_base_in_world) for name, arm in self.arms.items()})
        return other

    @property
    def arm(self) -> ArmModel:
        """The only arm.

        Raises:
            RobotError: The robot has several.
        """
        if len(self.arms) > 1:
            raise RobotError(f"{self.name} has several arms: use arms[...] with one of {', '.join(self.arms)}")
        return next(iter(self.arms.values()))

    @property
    def gripper(self) -> Gripper:
        """The gripper of the only arm; see `ArmModel`."""
        return self.arm.gripper

    @property
    def tool_frame(self) -> str:
        """Tool frame of the only arm; see `ArmModel`."""
        return self.arm.tool_frame

    def slice_of(self, arm: str) -> slice:
        """Where an arm's joints are in the arrays of the robot."""
        start = 0
        for name, each in self.arms.items():
            if name == arm:
                return slice(start, start + len(each.joint_names))
            start += len(each.joint_names)
        raise RobotError(f"{self.name} has no arm {arm!r}: use one of {', '.join(self.arms)}")

    def forward_kinematics(self, q: FloatArray) -> Pose:
        """As `ArmModel.forward_kinematics` of the only arm."""
        return self.arm.forward_kinematics(q)

    def jacobian(self, q: FloatArray) -> FloatArray:
        """As `ArmModel.jacobian` of the only arm."""
        return self.arm.jacobian(q)

    def position_and_jacobian(self, q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """As `ArmModel.position_and_jacobian` of the only arm."""
        return self.arm.position_and_jacobian(q)

    def inverse_kinematics(
        self, target: Pose | FloatArray, start: FloatArray | None = None, tolerance: float = 1e-5
    ) -> IkResult:
        """As `ArmModel.inverse_kinematics` of the only arm, which takes more."""
        return self.arm.inverse_kinematics(target, start, tolerance)

    def expand(self, q: FloatArray, openings: Mapping[str, float] | None = None) -> dict[str, float]:
        """Positions of all joints by name.

        Args:
            q: Driven positions of all arms, (n,) [rad].
            openings: Gap of the fingers by arm [m]; without it the fingers are left out.
        """
        values = np.asarray(q, dtype=float)
        if values.shape != self.lower.shape:
            raise RobotError(f"{self.name} has {self.lower.size} driven joints, got values of shape {values.shape}")
        positions: dict[str, float] = {}
        start = 0
        for arm in self.arms.values():
            positions |= arm.expand(values[start : start + len(arm.joint_names)])
            start += len(arm.joint_names)
            if openings is not None:
                joints = arm.gripper.joints_at(openings.get(arm.name, arm.gripper.max_opening))
                positions |= dict(zip(arm.gripper.joints, joints, strict=True))
        if openings is not None:
            positions |= {each.joint: each.follow(positions[each.source]) for each in self.finger_mimic}
            positions |= self.locked
        return positions


def _drive(spec: DriveSection, urdf: Urdf) -> Drive:
    """The base of a robot file."""
    wheels = tuple(urdf.joints[name].child for name in spec.wheels)
    return Drive(**spec.model_dump(), on_floor=wheels + spec.rollers)


def _locked(spec: RobotFile, urdf: Urdf) -> dict[str, float]:
    """Positions of joints that nothing drives, and of those that mimic them."""
    followers = {
        joint.name: joint.mimic.follow(spec.locked[joint.mimic.source])
        for joint in urdf.joints.values()
        if joint.mimic and joint.mimic.source in spec.locked
    }
    return followers | spec.locked


def _mounted(spec: RobotFile, finger_mounting: float | None) -> RobotFile:
    """The file with its fingers mounted otherwise."""
    if finger_mounting is None:
        return spec
    if not np.isfinite(finger_mounting):
        raise RobotError(f"finger_mounting must be a finite number [m], got {finger_mounting}")
    arms = tuple(
        arm.model_copy(update={"gripper": arm.gripper.model_copy(update={"mounting": float(finger_mounting)})})
        for arm in spec.arms
    )
    return spec.model_copy(update={"arms": arms})
