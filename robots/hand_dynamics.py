"""What hands pull at their wrists while a robot moves: Newton's and Euler's equations (Pinocchio)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from .kinematics import rotation_matrix
from .model import RobotModel
from .pose import FloatArray, Pose, read_only


@dataclass(frozen=True, slots=True)
class Load:
    """A rigid body that moves with a hand.

    Attributes:
        mass: Its mass [kg].
        centre: Its centre of mass in the world, (3,) [m].
        inertia: About the centre of mass along the axes of the world, (3, 3) [kg m²].
    """

    mass: float
    centre: FloatArray
    inertia: FloatArray

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        for name in ("centre", "inertia"):
            object.__setattr__(self, name, read_only(getattr(self, name)))


class HandDynamics:
    """Forces in the last movable joint before each arm's tool. Not safe to share between threads.

    Tell it how the robot moves, then ask for the wrench of each arm.
    """

    def __init__(self, robot: RobotModel) -> None:
        """Build the model, whose base may move."""
        self._model = pin.buildModelFromUrdf(str(robot.urdf_path), pin.JointModelFreeFlyer())
        self._data = self._model.createData()
        self._neutral = pin.neutral(self._model)
        self._velocity_at = {
            name: self._model.joints[number].idx_v for number, name in enumerate(self._model.names) if number > 1
        }
        self._mimic = robot.mimic
        self._still = dict(robot.locked)
        self._wrists = {
            name: self._model.frames[self._model.getFrameId(arm.tool_frame)].parentJoint
            for name, arm in robot.arms.items()
        }

    def move(
        self,
        joints: Mapping[str, tuple[float, float, float]],
        pose_base_in_world: Pose,
        twist_base_in_world: FloatArray,
        acceleration_base_in_world: FloatArray,
    ) -> None:
        """Take in how the robot moves.

        Args:
            joints: Position, velocity and acceleration of driven joints and fingers by name [rad or m, s]; passive ones
                follow.
            pose_base_in_world: Where the base is.
            twist_base_in_world: Velocity of the base frame, (6,): linear [m/s] then angular [rad/s], world's axes.
            acceleration_base_in_world: Acceleration of the base frame, (6,) [m/s², rad/s²], likewise.
        """
        change, velocity, acceleration = np.zeros((3, self._model.nv))
        for name, position in self._still.items():
            change[self._velocity_at[name]] = position
        for name, values in joints.items():
            at = self._velocity_at[name]
            change[at], velocity[at], acceleration[at] = values
        for each in self._mimic:
            at, (position, speed, gain) = self._velocity_at[each.joint], joints[each.source]
            change[at] = each.follow(position)
            if each.lower < change[at] < each.upper:
                velocity[at], acceleration[at] = each.ratio * speed, each.ratio * gain
        turn = rotation_matrix(pose_base_in_world.orientation_xyzw)
        linear, angular = turn.T @ twist_base_in_world[:3], turn.T @ twist_base_in_world[3:]
        velocity[:6] = np.concatenate((linear, angular))
        # Pinocchio's acceleration is that of the moving frame: of a base that turns, without the centripetal part.
        acceleration[:3] = turn.T @ acceleration_base_in_world[:3] - pin.skew(angular) @ linear
        acceleration[3:6] = turn.T @ acceleration_base_in_world[3:]
        q = pin.integrate(self._model, self._neutral, change)
        q[:3], q[3:7] = pose_base_in_world.position, pose_base_in_world.orientation_xyzw
        pin.rnea(self._model, self._data, q, velocity, acceleration)
        pin.updateGlobalPlacements(self._model, self._data)

    def wrench(
        self, arm: str, loads: Sequence[Load] = (), contacts: Sequence[tuple[FloatArray, FloatArray]] = ()
    ) -> FloatArray:
        """What a hand pulls at its last joint, (6,): force [N] and torque about the joint [Nm], world's axes.

        Args:
            arm: Name of the arm.
            loads: What moves with the hand.
            contacts: Point (3,) [m] and force (3,) [N] of everything else that acts on the hand or its loads, in the
                world.
        """
        joint, data = self._wrists[arm], self._data
        place = data.oMi[joint]
        needed = data.f[joint].copy()  # what the joint must give for the hand to move as it does
        for load in loads:
            turn = place.rotation
            body = pin.Inertia(load.mass, turn.T @ (load.centre - place.translation), turn.T @ load.inertia @ turn)
            needed += body * data.a_gf[joint] + data.v[joint].cross(body * data.v[joint])
        force, torque = -place.rotation @ needed.linear, -place.rotation @ needed.angular
        for point, pull in contacts:
            force = force + pull
            torque = torque + pin.skew(point - place.translation) @ pull
        return np.concatenate((force, torque))
