"""Commands and servo results of a two-armed robot, for tests of what is recorded of them."""

from dataclasses import dataclass

import numpy as np

from robots.pose import FloatArray
from teleop.drive_command import ArmWish, DriveCommand


@dataclass(frozen=True)
class ArmResult:
    asked: FloatArray
    executed: FloatArray
    reason: str = ""
    detail: str = ""


@dataclass(frozen=True)
class DriveResult:
    joint_velocity: FloatArray
    base_twist: FloatArray
    base_asked: FloatArray
    openings: dict[str, float]
    arms: dict[str, ArmResult]
    state: str = "ok"
    reason: str = ""


def random_command(rng: np.random.Generator) -> DriveCommand:
    left = ArmWish(tuple(rng.normal(size=6)), "tool", "close")
    right = ArmWish(jog=(3, float(rng.normal())))
    return DriveCommand({"left": left, "right": right}, (float(rng.normal()), 0.0), float(rng.random()), age=0.01)


def random_result(rng: np.random.Generator, **changes: object) -> DriveResult:
    arms = {name: ArmResult(rng.normal(size=6), rng.normal(size=6), "collision") for name in ("left", "right")}
    values: dict[str, object] = {
        "joint_velocity": rng.normal(size=14),
        "base_twist": rng.normal(size=2),
        "base_asked": rng.normal(size=2),
        "openings": {"left": 0.04, "right": 0.02},
        "arms": arms,
    }
    return DriveResult(**(values | changes))  # type: ignore[arg-type]
