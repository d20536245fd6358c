"""What the robot feels of itself in a demo: joints, hands, and which arm acts."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from learning.errors import PerceptionError
from robots.pose import FloatArray, Pose, read_only

if TYPE_CHECKING:
    from robots.model import RobotModel
    from teleop import Demo
    from twin.scene_view import RobotState
    from twin.state import WorldState

FRAME_TIME = 0.1
"""Time between two frames of an observation [s]."""


@dataclass(frozen=True, slots=True)
class Proprioception:
    """Own state over F frames.

    Attributes:
        times: (F,) [s].
        bodies: Joints, finger gaps and base of each frame, F of them.
        arm: Name of the arm that acts.
        tool: Its tool frame in the world: position [m] and quaternion xyzw, (F, 7).
        closed: Whether its gripper was told to close, (F,).
        opening: Measured gap between its fingers, (F,) [m].
        force: Force felt at its wrist along the axes of the world, (F, 3) [N]; None where it is not felt.
        hand_pull: Vertical force of the empty hand at rest, as its masses say [N]; None where no force is felt.
    """

    times: FloatArray
    bodies: "tuple[RobotState, ...]"
    arm: str
    tool: FloatArray
    closed: NDArray[np.bool_]
    opening: FloatArray
    force: FloatArray | None
    hand_pull: float | None = None

    @property
    def wrist_force(self) -> FloatArray | None:
        """The force, or None where a value is missing."""
        return None if self.force is None or not np.isfinite(self.force).all() else self.force


def frames_of(times: FloatArray) -> NDArray[np.int64]:
    """Indices of the states that are looked at: about one each `FRAME_TIME`, and the last, which says how it ended."""
    picked = np.searchsorted(times, np.arange(times[0], times[-1], FRAME_TIME) - 1e-9)
    return np.unique(np.append(picked, len(times) - 1))


def proprioception_of(demo: "Demo", robot: "RobotModel") -> Proprioception:
    """Gather what the robot felt of itself in a recorded demo.

    Args:
        demo: The recording.
        robot: Its robot.

    Raises:
        PerceptionError: Joint positions are missing or are not those of this robot.
    """
    from twin.scene_view import RobotState

    states, times = demo.states, np.asarray(demo.times, dtype=np.float64)
    if states.q.shape[1:] != robot.home.shape or not np.isfinite(states.q).all():
        raise PerceptionError(
            f"{demo.path}: joint positions of shape {states.q.shape} do not fit {robot.name}'s "
            f"{len(robot.home)} joints in every state: record the demo again"
        )
    picked = frames_of(times)
    names = tuple(robot.arms)
    if demo.hands is not None and demo.hands.names == names:
        tools, closed, openings = demo.hands.tools, demo.hands.closed, demo.hands.openings
        wrench: FloatArray | None = demo.hands.wrist_wrenches
    else:  # a demo that was driven with one gamepad and one arm
        tools, closed, openings = states.tool[:, None], states.gripper_closed[:, None], states.gripper_opening[:, None]
        names, wrench = names[:1], None
    acting = acting_arm(tools[:, :, :3])
    home = robot.pose_base_in_world
    bases = [home if demo.base is None else Pose(demo.base[k, :3], demo.base[k, 3:]) for k in picked]
    bodies = tuple(
        RobotState(states.q[k], dict(zip(names, openings[k].tolist(), strict=True)), base)
        for k, base in zip(picked, bases, strict=True)
    )
    return Proprioception(
        times=read_only(times[picked]),
        bodies=bodies,
        arm=names[acting],
        tool=read_only(tools[picked, acting]),
        closed=np.asarray(closed, dtype=bool)[picked, acting],
        opening=read_only(openings[picked, acting]),
        force=None if wrench is None else read_only(wrench[picked, acting, :3]),
        hand_pull=None if wrench is None else _hand_pull(robot, bodies[0], names[acting]),
    )


def proprioception_at(state: "WorldState", robot: "RobotModel", frames: int, arm: str | None = None) -> Proprioception:
    """What the robot feels of itself in a world that stands still, for a number of frames.

    Args:
        state: The world now.
        robot: Its robot.
        frames: How many frames.
        arm: The arm that acts; None takes one whose gripper is closed, else the first.

    Raises:
        PerceptionError: There is no such arm.
    """
    from twin.scene_view import robot_state

    names = tuple(robot.arms)
    if arm is not None and arm not in names:
        raise PerceptionError(f"{robot.name} has no arm {arm!r}; it has {', '.join(names)}")
    shut = [name for name, hand in zip(names, state.arms, strict=True) if hand.gripper_closed]
    name = arm or (shut[0] if shut else names[0])
    hand = state.arms[names.index(name)]
    tool = np.concatenate((hand.pose_tool_in_world.position, hand.pose_tool_in_world.orientation_xyzw))
    return Proprioception(
        times=read_only(state.time + FRAME_TIME * np.arange(frames)),
        bodies=(robot_state(robot, state),) * frames,
        arm=name,
        tool=read_only(np.tile(tool, (frames, 1))),
        closed=np.full(frames, hand.gripper_closed),
        opening=read_only(np.full(frames, hand.gripper_opening)),
        force=read_only(np.tile(hand.wrist_wrench[:3], (frames, 1))),
        hand_pull=_hand_pull(robot, robot_state(robot, state), name),
    )


def _hand_pull(robot: "RobotModel", body: "RobotState", arm: str) -> float:
    """Vertical force of an empty hand at rest [N]; posture does not matter."""
    return _pull_of(robot.urdf_path, arm, lambda: _resting_pull(robot, body, arm))


def _resting_pull(robot: "RobotModel", body: "RobotState", arm: str) -> float:
    from robots.hand_dynamics import HandDynamics

    dynamics = HandDynamics(robot)
    joints = {name: (position, 0.0, 0.0) for name, position in robot.expand(body.q, body.openings).items()}
    dynamics.move(joints, body.pose_base_in_world, np.zeros(6), np.zeros(6))
    return float(dynamics.wrench(arm)[2])


_PULLS: dict[tuple[Path, str], float] = {}
"""What hands pull, by URDF and arm: it does not change, and building the model takes as long as two pictures."""


def _pull_of(urdf: Path, arm: str, found: Callable[[], float]) -> float:
    if (urdf, arm) not in _PULLS:
        _PULLS[urdf, arm] = found()
    return _PULLS[urdf, arm]


def acting_arm(positions: FloatArray) -> int:
    """Index of the arm whose tool went the longest way; the first where none moved.

    Args:
        positions: Tool positions, (T, A, 3) [m].
    """
    if len(positions) < 2:
        return 0
    return int(np.linalg.norm(np.diff(positions, axis=0), axis=2).sum(axis=0).argmax())
