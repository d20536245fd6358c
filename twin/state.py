"""What crosses the door of a world: commands in, states out."""

from collections.abc import Sequence
from dataclasses import dataclass

from robots.pose import FloatArray, Pose, read_only


@dataclass(frozen=True, slots=True)
class JointCommand:
    """One control command.

    Attributes:
        velocity: Velocities of the driven joints of all arms, (n,) [rad/s].
        gripper_opening: Wanted gap between the fingers [m]: one number for every arm, or one each.
        base_twist: Speed along the base's x axis [m/s] and turning speed [rad/s]; only for a robot on wheels.
    """

    velocity: FloatArray
    gripper_opening: float | Sequence[float]
    base_twist: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class ObjectState:
    """True state of one object in the world frame (for replay and scoring; the board's perception adds noise)."""

    id: int
    pose_object_in_world: Pose


@dataclass(frozen=True, slots=True)
class ArmState:
    """What is true of one arm's hand, and what is felt there.

    Attributes:
        gripper_opening: Measured gap between the fingers [m].
        gripper_closed: Whether the gripper was last told to close.
        pose_tool_in_world: Tool frame.
        held: Id of the object that both fingers touch, else None.
        wrist_wrench: What hand and held object pull at the last joint, (6,): force [N] and torque about that joint
            [Nm], along the axes of the world. A hand at rest shows the weight of both, downwards.
        finger_effort: Efforts of the two finger motors [N or Nm].
    """

    gripper_opening: float
    gripper_closed: bool
    pose_tool_in_world: Pose
    held: int | None
    wrist_wrench: FloatArray
    finger_effort: tuple[float, float]

    def __post_init__(self) -> None:
        """Freeze the array."""
        object.__setattr__(self, "wrist_wrench", read_only(self.wrist_wrench))


@dataclass(frozen=True, slots=True)
class WorldState:
    """True state of the world at one instant.

    What is said of the gripper and the tool is the first arm's; `arms` has it for every arm.

    Attributes:
        time: Simulated time [s].
        q: Driven joint positions, (n,) [rad].
        dq: Driven joint velocities, (n,) [rad/s].
        gripper_opening: Measured gap between the fingers [m].
        gripper_closed: Whether the gripper was last told to close.
        pose_tool_in_world: Tool frame (between the finger tips).
        objects: All objects, in the order of the scene's specification.
        held: Id of the object that both fingers touch, else None.
        effort: Motor efforts of the driven joints, (n,) [Nm or N].
        arms: Hands of all arms, in the robot's order.
        pose_base_in_world: The robot's base; it moves on a robot with wheels.
    """

    time: float
    q: FloatArray
    dq: FloatArray
    gripper_opening: float
    gripper_closed: bool
    pose_tool_in_world: Pose
    objects: tuple[ObjectState, ...]
    held: int | None
    effort: FloatArray | None = None
    arms: tuple[ArmState, ...] = ()
    pose_base_in_world: Pose | None = None
