"""What crosses the door of a world: commands in, states out."""

from dataclasses import dataclass

from robots.pose import FloatArray, Pose


@dataclass(frozen=True, slots=True)
class JointCommand:
    """One control command.

    Attributes:
        velocity: Velocities of the driven joints, (n,) [rad/s].
        gripper_opening: Wanted gap between the fingers [m].
    """

    velocity: FloatArray
    gripper_opening: float


@dataclass(frozen=True, slots=True)
class ObjectState:
    """True state of one object in the world frame (for replay and scoring; the board's perception adds noise)."""

    id: int
    pose_object_in_world: Pose


@dataclass(frozen=True, slots=True)
class WorldState:
    """True state of the world at one instant.

    Attributes:
        time: Simulated time [s].
        q: Driven joint positions, (n,) [rad].
        dq: Driven joint velocities, (n,) [rad/s].
        gripper_opening: Measured gap between the fingers [m].
        gripper_closed: Whether the gripper was last told to close.
        pose_tool_in_world: Tool frame (between the finger tips).
        objects: All objects, in the order of the scene's specification.
        held: Id of the object that both fingers touch, else None.
    """

    time: float
    q: FloatArray
    dq: FloatArray
    gripper_opening: float
    gripper_closed: bool
    pose_tool_in_world: Pose
    objects: tuple[ObjectState, ...]
    held: int | None
