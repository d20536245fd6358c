"""Input for the servo's benchmark: random, as bad as can be, and like a person's hand."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from robots import CollisionModel, RobotModel
from robots.obstacle import Obstacle
from robots.pose import FloatArray, Pose
from teleop.drive_command import ArmWish, DriveCommand

FRAMES = ("world", "base", "tool", "camera")
GRIPS = ("keep", "keep", "close", "open")


class InputMaker:
    """Makes one command after another."""

    def __init__(self, robot: RobotModel, obstacles: Sequence[Obstacle], rng: np.random.Generator) -> None:
        """Take a robot and where chance comes from."""
        self._robot, self._rng = robot, rng
        self._geometry = CollisionModel(robot, obstacles)
        self._kind, self._until = "random", 0
        self._command = DriveCommand()
        self._hand = np.zeros((len(robot.arms), 6))
        self._aim = self._hand.copy()

    def begin(self, kind: str) -> None:
        """Begin anew with a kind of input."""
        self._kind, self._until = kind, 0
        self._hand[:] = 0.0
        self._aim[:] = 0.0

    def command(self, q: FloatArray, base: Pose, step: int) -> DriveCommand:
        """The next command, for a robot at q (n,) [rad] with its base at a pose, at a step of the episode."""
        if self._kind == "human":
            return self._human(step)
        if step >= self._until:
            slow = self._kind == "random"
            self._until = step + int(self._rng.integers(1, 240 if slow else 160))
            self._command = self._random() if slow else self._adversarial(q, base)
        elif self._kind == "adversarial" and self._rng.uniform() < 0.01:
            self._command = _flipped(self._command)
        return self._command

    def _random(self) -> DriveCommand:
        rng = self._rng
        arms = {}
        for name, arm in self._robot.arms.items():
            if rng.uniform() < 0.2:
                continue
            size = 10.0 ** rng.uniform(-2, 0.3)
            twist = np.clip(size * rng.normal(size=6) * (rng.uniform(size=6) < 0.6), -2, 2)
            jog = None
            if rng.uniform() < 0.25:
                jog = int(rng.integers(len(arm.joint_names))), float(rng.uniform(-2, 2))
            arms[name] = ArmWish(
                tuple(twist.tolist()),
                FRAMES[rng.integers(4)],  # type: ignore[arg-type]
                GRIPS[rng.integers(4)],  # type: ignore[arg-type]
                jog,
            )
        return self._with_base(DriveCommand(arms, speed_ratio=float(rng.uniform(0.2, 1.0))))

    def _with_base(self, command: DriveCommand) -> DriveCommand:
        if self._robot.drive is None or self._rng.uniform() < 0.4:
            return command
        speed, turning = self._rng.uniform(-1, 1, 2) * (self._robot.drive.speed, self._robot.drive.yaw_rate)
        return replace(command, base=(float(speed), float(turning)))

    def _adversarial(self, q: FloatArray, base: Pose) -> DriveCommand:
        rng = self._rng
        kind = rng.integers(8)
        if kind == 0:
            return self._broken()
        if kind == 1:  # a joint straight to its end
            arms = {}
            for name, arm in self._robot.arms.items():
                joint = int(rng.integers(len(arm.joint_names)))
                arms[name] = ArmWish(jog=(joint, float(rng.choice((-1, 1))) * float(arm.velocity[joint])))
            return DriveCommand(arms)
        if kind in (2, 3, 4):
            return self._with_base(self._towards(q, base))
        if kind == 5:  # as far out as it goes
            return DriveCommand({name: ArmWish((1.0, 0.0, 0.3, 0.0, 0.0, 0.0), "tool") for name in self._robot.arms})
        return self._random()

    def _towards(self, q: FloatArray, base: Pose) -> DriveCommand:
        """Every arm towards what some link of it is nearest to."""
        self._geometry.place_base(base)
        near = self._geometry.near(q, 0.3)
        arms = {}
        for name in self._robot.arms:
            direction = self._rng.normal(size=3)
            if near:
                pair = near[min(int(self._rng.exponential(3.0)), len(near) - 1)]
                direction = pair.point_on_second - pair.point_on_first
                if self._rng.uniform() < 0.3:
                    direction = -direction
            direction = direction / max(float(np.linalg.norm(direction)), 1e-9)
            twist = np.concatenate((direction * self._rng.uniform(0.05, 2.0), self._rng.normal(size=3) * 0.3))
            arms[name] = ArmWish(tuple(twist.tolist()))
        return DriveCommand(arms)

    def _broken(self) -> DriveCommand:
        rng, good = self._rng, self._random()
        name = next(iter(self._robot.arms))
        return (
            replace(good, arms={name: ArmWish((math.nan, 0.0, 0.0, 0.0, 0.0, 0.0))}),
            replace(good, arms={name: ArmWish((0.0, 99.0, 0.0, 0.0, 0.0, 0.0))}),
            replace(good, arms={name: ArmWish(jog=(17, math.inf))}),
            replace(good, age=0.3),
            replace(good, enabled=False),
            replace(good, stop=True),
            replace(good, fault="unplugged"),
            replace(good, speed_ratio=math.nan),
        )[rng.integers(8)]

    def _human(self, step: int) -> DriveCommand:
        """Sticks that are pushed some way, held, let go, mostly one or two axes at a time; hands shake a little."""
        rng = self._rng
        if step >= self._until:
            self._until = step + int(rng.integers(60, 400))
            used = rng.uniform(size=self._aim.shape) < 0.25
            self._aim = used * rng.uniform(-1, 1, self._aim.shape) * ([0.3] * 3 + [0.8] * 3)
            if rng.uniform() < 0.2:
                self._aim[:] = 0.0
            self._base = rng.uniform(-0.5, 0.5, 2) * (rng.uniform(size=2) < 0.3)
            self._grip = GRIPS[rng.integers(4)]
        if step % 4 == 0:  # a gamepad reports at 60 Hz
            shake = 0.01 * rng.normal(size=self._aim.shape) * (self._aim != 0.0)
            self._hand += 0.25 * (self._aim + shake - self._hand)
            self._hand[np.abs(self._hand) < 1e-3] = 0.0
            arms = {
                name: ArmWish(tuple(self._hand[number].tolist()), "world", self._grip)  # type: ignore[arg-type]
                for number, name in enumerate(self._robot.arms)
            }
            base = tuple(self._base.tolist()) if self._robot.drive is not None else (0.0, 0.0)
            self._command = DriveCommand(arms, base)
        return self._command


def _flipped(command: DriveCommand) -> DriveCommand:
    """The opposite of a command."""
    arms = {
        name: replace(
            wish,
            twist=tuple(-value for value in wish.twist),
            jog=None if wish.jog is None else (wish.jog[0], -wish.jog[1]),
        )
        for name, wish in command.arms.items()
    }
    return replace(command, arms=arms, base=(-command.base[0], -command.base[1]))
