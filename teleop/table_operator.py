"""A scripted person who drives one hand over a table: along straight lines, with a little tremble, touching gently.

It does one stroke after the other, looks at the world at 60 Hz, and says what it wants as `DriveCommand`. Which strokes
lead to a goal is chosen by others; this is only the hand that holds the device.
"""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from robots.pose import FloatArray, Pose
from twin.state import ArmState, WorldState

from .drive_command import ArmWish, DriveCommand
from .strokes import Grip, Manner, Press, Reach, Stroke

LOOK_EVERY = 4
"""Control steps between two looks: 60 Hz, as devices report."""
GAIN = 6.0
"""How soon it slows down before a goal [1/s]."""
AHEAD = 0.12
"""It minds where the hand will be after this time [s]: a hand that moves goes on for a while."""
CALM = 0.02
"""A hand that is at its goal is slower than this [m/s]."""
TURN_GAIN = 5.0
"""How soon it ends a turn [1/s]."""
TREMBLE_FADES = 0.06
"""Nearer to a goal than this [m] the hand is held more steadily."""
ONWARDS = 0.02
"""A point that is only passed counts as reached within this distance [m];"""
ONWARDS_TURN = 0.25
"""and this angle [rad]."""
FINGERS_STILL = 0.0003
"""Fingers have stopped when their gap changed by less than this [m] in `FINGERS_WATCHED`."""
FINGERS_WATCHED = 0.1
"""Time [s]."""
FINGERS_LONGEST = 3.0
"""No gripper needs longer [s]."""
FEELING = 0.8
"""Part of a new force that is felt at once."""
TOUCH = 1.0
"""Force at which a hand that presses notices what it presses on [N]."""
YIELDING = 1e-4
"""How fast the hand gives way to a force that it does not want [m/s/N]."""
FEEL_AFTER = 0.2
"""A stroke does not trust the force it feels before this time [s]: what is carried has to be set in motion."""


class TableOperator:
    """Drives one arm through strokes.

    Attributes:
        done: Whether it has put the device down.
        failed: Why it gave up; empty while all is well.
        stroke: Number of the stroke it is at.
        felt: Mean force with which the hand pressed on something last [N].
    """

    def __init__(
        self,
        arms: Sequence[str],
        arm: str,
        strokes: Sequence[Stroke],
        rng: np.random.Generator,
        manner: Manner | None = None,
    ) -> None:
        """Take up the device.

        Args:
            arms: Names of the robot's arms, in order.
            arm: The one to drive.
            strokes: What to do.
            rng: Source of tremble and hesitation.
            manner: How; None for the usual manner.
        """
        self.done = False
        self.failed = ""
        self.stroke = 0
        self.felt = 0.0
        self._arm, self._number = arm, tuple(arms).index(arm)
        self._rng = rng
        self._manner = manner or Manner()
        self._strokes = tuple(strokes)
        self._strayed = np.zeros(3)
        self._weight: FloatArray = np.full(3, np.nan)
        self._state: WorldState
        self._script = self._do()

    def act(self, state: WorldState) -> DriveCommand:
        """Look at the world and say what is wanted now; call at 60 Hz."""
        self._state = state
        if np.isnan(self._weight).any():
            self._weight = self._hand.wrist_wrench[:3].copy()
        wish = next(self._script, None)
        return DriveCommand() if wish is None else DriveCommand({self._arm: wish})

    @property
    def _hand(self) -> ArmState:
        return self._state.arms[self._number]

    def _do(self) -> Iterator[ArmWish]:
        for number, stroke in enumerate(self._strokes):
            self.stroke = number
            if isinstance(stroke, Reach):
                yield from self._reach(stroke)
                if not stroke.onwards:
                    yield from self._rest(float(self._rng.uniform(0.0, self._manner.hesitation)))
            elif isinstance(stroke, Grip):
                yield from self._grip(stroke)
            elif isinstance(stroke, Press):
                yield from self._press(stroke)
            else:
                yield from self._rest(stroke.seconds)
            if self.failed:
                break
        self.done = True

    def _reach(self, stroke: Reach) -> Iterator[ArmWish]:
        goal, began = stroke.pose, self._state.time
        off, turn = difference(self._hand.pose_tool_in_world, goal)
        way = float(np.linalg.norm(off))
        along = off / way if way > 1e-6 else np.zeros(3)
        start = self._hand.wrist_wrench[:3].copy()
        expected = way / stroke.speed + float(np.linalg.norm(turn)) / stroke.turning
        before, seen = self._hand.pose_tool_in_world.position, self._state.time
        near, aligned = (ONWARDS, ONWARDS_TURN) if stroke.onwards else (stroke.near, stroke.aligned)
        while True:
            off, turn = difference(self._hand.pose_tool_in_world, goal)
            distance, angle = float(np.linalg.norm(off)), float(np.linalg.norm(turn))
            elapsed = self._state.time - began
            position = self._hand.pose_tool_in_world.position
            velocity = (position - before) / max(self._state.time - seen, 1e-3)
            before, seen = position, self._state.time
            if distance < near and angle < aligned and (stroke.onwards or np.linalg.norm(velocity) < CALM):
                return
            if stroke.push is not None and elapsed > FEEL_AFTER:
                pushed = -float((self._hand.wrist_wrench[:3] - start) @ along)
                if pushed > stroke.push:
                    return
            if elapsed > 1.5 * expected + stroke.patience:
                self.failed = f"stuck {1000 * distance:.0f} mm and {angle:.2f} rad before stroke {self.stroke}'s end"
                return
            if not stroke.onwards:
                off = off - AHEAD * velocity
                distance = float(np.linalg.norm(off))
            yield self._towards(stroke, off, turn, distance, angle)

    def _press(self, stroke: Press) -> Iterator[ArmWish]:
        along = np.asarray(stroke.direction, dtype=float)
        start, pushed, felt = self._state.time, 0.0, []
        touched: float | None = None
        while touched is None or self._state.time - touched < stroke.seconds:
            # The arm is stiff, so that what it feels is smoothed and answered by very slow motion.
            pushed += FEELING * (-float((self._hand.wrist_wrench[:3] - self._weight) @ along) - pushed)
            if touched is None:
                if pushed > TOUCH:
                    touched = self._state.time
                elif stroke.speed * (self._state.time - start) > stroke.farthest:
                    self.failed = f"nothing pushed back in {1000 * stroke.farthest:.0f} mm"
                    return
                speed = stroke.speed
            if touched is not None:
                felt.append(pushed)
                speed = max(-stroke.speed, min(stroke.speed, YIELDING * (stroke.force - pushed)))
            x, y, z = (speed * along).tolist()
            yield ArmWish((x, y, z, 0.0, 0.0, 0.0))
        self.felt = float(np.mean(felt))

    def _towards(self, stroke: Reach, off: FloatArray, turn: FloatArray, distance: float, angle: float) -> ArmWish:
        """The twist towards a goal: both parts arrive together, as far as their limits allow."""
        seconds = max(distance / stroke.speed, angle / stroke.turning, 1e-6)
        rate, turn_rate = 1.0 / seconds, 1.0 / seconds
        if not stroke.onwards:
            rate, turn_rate = min(rate, GAIN), min(turn_rate, TURN_GAIN)
        self._strayed = 0.9 * self._strayed + self._rng.normal(0.0, 0.4 * self._manner.tremble, 3)
        steadied = min(distance / TREMBLE_FADES, 1.0)
        velocity = off * rate + steadied * self._strayed
        x, y, z, roll, pitch, yaw = np.concatenate((velocity, turn * turn_rate)).tolist()
        return ArmWish((x, y, z, roll, pitch, yaw))

    def _grip(self, stroke: Grip) -> Iterator[ArmWish]:
        began = looked = self._state.time
        gap = math.inf
        yield ArmWish(gripper=stroke.wish)
        while self._state.time - began < FINGERS_LONGEST:
            if self._state.time - looked >= FINGERS_WATCHED:
                now = self._hand.gripper_opening
                if abs(now - gap) < FINGERS_STILL:
                    break
                gap, looked = now, self._state.time
            yield ArmWish(gripper=stroke.wish)
        yield from self._rest(stroke.settle)

    def _rest(self, seconds: float) -> Iterator[ArmWish]:
        until = self._state.time + seconds
        while self._state.time < until - 1e-9:
            yield ArmWish()


def difference(start: Pose, goal: Pose) -> tuple[FloatArray, FloatArray]:
    """What leads from one pose to another: shift (3,) [m] and rotation vector (3,) [rad], along the world's axes."""
    ax, ay, az, aw = (-start.orientation_xyzw[:3]).tolist() + [float(start.orientation_xyzw[3])]
    bx, by, bz, bw = goal.orientation_xyzw.tolist()
    vector = np.array(
        [
            bw * ax + bx * aw + by * az - bz * ay,
            bw * ay - bx * az + by * aw + bz * ax,
            bw * az + bx * ay - by * ax + bz * aw,
        ]
    )
    scalar = bw * aw - bx * ax - by * ay - bz * az
    size = float(np.linalg.norm(vector))
    if scalar < 0.0:
        vector, scalar = -vector, -scalar
    angle = 2.0 * math.atan2(size, scalar)
    return goal.position - start.position, vector * (angle / size if size > 1e-12 else 2.0)
