"""Motion on the twin: straight segments of the tool and moves of the gripper, 240 times a second."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from executor.errors import RefusalError
from executor.motion_plan import MotionPlan, MoveTool, Step
from executor.segment import Segment, ToolLimits
from robots.pose import FloatArray
from twin.state import JointCommand

if TYPE_CHECKING:
    from robots import RobotModel
    from twin import World

TOOL_LIMITS = ToolLimits(velocity=0.40, acceleration=1.5, jerk=15.0)
"""Free travel. Precise moves (onto, with and away from an object at its place) take `PRECISE`."""
PRECISE = ToolLimits(velocity=0.12, acceleration=0.6, jerk=6.0)
FEEDBACK = 12.0
"""Gain from tool position error to tool velocity [1/s]."""
ARRIVED = 0.0002
"""Tool error at which a waypoint counts as reached [m]."""
SETTLE = 0.5
"""Longest wait for the tool at a waypoint [s]."""
FADE = (0.75, 0.5, 0.25, 0.0)
"""What is left of the feedback's last, small joint velocity in the steps before a stop, to keep the jerk limit."""
GRIP_TIME = (0.15, 1.5)
"""Shortest and longest wait for the fingers [s]."""


@dataclass(frozen=True, slots=True)
class Arrival:
    """How a tool move ended.

    Attributes:
        position: Where the tool stands, (3,) [m].
        error: Distance to the waypoint [m].
        duration: Simulated time it took [s].
    """

    position: FloatArray
    error: float
    duration: float


class Motion:
    """Moves the tool and the gripper of one world.

    Args:
        world: The world to step.
        limits: Limits of free travel.
        precise: Limits of moves near objects.

    Attributes:
        opening: Gap that the fingers are told to make [m].
        on_start: Called before the first step of every move.
        on_step: Called with each step of a plan when it begins.
    """

    def __init__(self, world: "World", limits: ToolLimits = TOOL_LIMITS, precise: ToolLimits = PRECISE) -> None:
        self.world = world
        self.limits = limits
        self.precise = precise
        self.on_start: Callable[[], None] = lambda: None
        self.on_step: Callable[[Step], None] = lambda step: None
        self.resume()

    def resume(self) -> None:
        """Take over the world as it is now, at rest."""
        self._rate: FloatArray = np.zeros(len(self.world.robot.joint_names))
        self.opening = 0.0 if self.world.state().gripper_closed else self.world.robot.gripper.max_opening

    def check_reach(self, plan: MotionPlan) -> None:
        """See that every waypoint can be reached.

        Raises:
            RefusalError: A waypoint is outside the arm's reach.
        """
        start = self.world.state().q
        for step in plan.steps:
            if isinstance(step, MoveTool):
                found = self.world.robot.inverse_kinematics(step.position, start=start)
                if not found.success:
                    raise RefusalError(f"the arm cannot reach that far: {step} is {1000 * found.error:.0f} mm away")
                start = found.q

    def run(self, plan: MotionPlan) -> list[Arrival]:
        """Carry out a plan, with a stop after every step; returns how each tool move ended."""
        arrivals = []
        for step in plan.steps:
            self.on_step(step)
            if isinstance(step, MoveTool):
                near = step.purpose in ("descend", "lower", "retreat", "lift")
                arrivals.append(self.move_to(step.position, self.precise if near else self.limits))
            else:
                self.grip(step.closed)
        return arrivals

    def move_to(self, target: FloatArray, limits: ToolLimits | None = None) -> Arrival:
        """Move the tool on a straight line to `target` [m] in the world, and stop there."""
        robot = self.world.robot
        state = self.world.state()
        begun = state.time
        segment = self._plan(state.q, state.pose_tool_in_world.position, target, limits or self.limits)
        steps = max(1, int(np.ceil(segment.duration / self.world.DT)))
        self.on_start()
        q = state.q
        for index in range(1, steps + 1):
            position, velocity, _ = segment.at(index * self.world.DT)
            q = self._step(robot, q, position, velocity)
        for _ in range(int(SETTLE / self.world.DT)):
            if np.linalg.norm(robot.forward_kinematics(q).position - segment.end) < ARRIVED:
                break
            q = self._step(robot, q, segment.end, np.zeros(3))
        for share in FADE:
            self.world.step(JointCommand(share * self._rate, self.opening))
        end = self.world.state()
        where = end.pose_tool_in_world.position
        return Arrival(where, float(np.linalg.norm(where - segment.end)), end.time - begun)

    def grip(self, closed: bool) -> None:
        """Open or close the gripper and wait until the fingers stand still."""
        self.opening = 0.0 if closed else self.world.robot.gripper.max_opening
        still = JointCommand(np.zeros(len(self.world.robot.joint_names)), self.opening)
        window = round(GRIP_TIME[0] / self.world.DT)
        self.on_start()
        before = np.inf
        for _ in range(round(GRIP_TIME[1] / GRIP_TIME[0])):
            for _ in range(window):
                self.world.step(still)
            now = self.world.state().gripper_opening
            if abs(now - before) < 1e-4:
                return
            before = now

    def _plan(self, q: FloatArray, start: FloatArray, target: FloatArray, limits: ToolLimits) -> Segment:
        """Plan a segment and slow it down until every joint stays within its velocity and acceleration limits."""
        robot = self.world.robot
        segment = Segment(start, target, limits)
        times = np.linspace(0.0, segment.duration, 25)[1:]
        last: FloatArray = np.zeros(len(q))
        slower = 1.0
        joints = q
        step = times[0] if len(times) else 1.0
        for time in times:
            position, velocity, _ = segment.at(float(time))
            found = robot.inverse_kinematics(position, start=joints)
            joints = found.q
            rate: FloatArray = last
            if found.success:
                rate = np.asarray(np.linalg.solve(robot.jacobian(joints)[:3], velocity), dtype=np.float64)
            slower = max(slower, float((np.abs(rate) / (0.9 * robot.velocity)).max()))
            slower = max(slower, float(np.sqrt((np.abs(rate - last) / step / (0.9 * robot.acceleration)).max())))
            last = rate
        return segment if slower == 1.0 else Segment(start, target, limits.scaled(slower))

    def _step(self, robot: "RobotModel", q: FloatArray, position: FloatArray, velocity: FloatArray) -> FloatArray:
        """One control step towards a point of the reference: v = v_ref + k (p_ref - p), joints by the Jacobian."""
        here, jacobian = robot.position_and_jacobian(q)
        error, linear = position - here, jacobian[:3]
        # Damped least squares: near a singularity the arm slows down instead of racing.
        rate = linear.T @ np.linalg.solve(linear @ linear.T + 1e-6 * np.eye(3), velocity + FEEDBACK * error)
        rate /= max(1.0, float((np.abs(rate) / robot.velocity).max()))
        self._rate = rate
        self.world.step(JointCommand(rate, self.opening))
        return self.world.state().q
