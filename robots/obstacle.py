"""A convex thing that a robot should not run into."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from .errors import RobotError
from .pose import FloatArray, Pose, read_only

FLOOR = "floor"
"""Name of the obstacle on which wheels roll."""
FLAT = 1e-6
"""Corners whose thickness is this part of their width, or less, lie in a plane."""


@dataclass(frozen=True, slots=True)
class Obstacle:
    """A convex thing in the world.

    Attributes:
        name: What it is called in answers.
        kind: `box` with full side lengths, `sphere` with its radius, `cylinder` with its radius and its length along
            z, or `hull`.
        size: Numbers of the kind [m]; empty for a hull.
        pose_obstacle_in_world: Where it is.
        corners: Corners of a hull, (k, 3) [m].
    """

    name: str
    kind: Literal["box", "sphere", "cylinder", "hull"]
    size: tuple[float, ...]
    pose_obstacle_in_world: Pose
    corners: FloatArray | None = None

    def __post_init__(self) -> None:
        """Freeze the corners.

        Raises:
            RobotError: The number of sizes is not the kind's, one is not positive, corners have no hull, or the pose is
                not finite.
        """
        if self.corners is not None:
            object.__setattr__(self, "corners", read_only(self.corners))
        wanted = {"box": 3, "sphere": 1, "cylinder": 2, "hull": 0}
        if self.kind not in wanted:
            raise RobotError(f"obstacle {self.name!r}: kind must be one of {', '.join(wanted)}, got {self.kind!r}")
        if len(self.size) != wanted[self.kind] or not all(np.isfinite(self.size)) or min(self.size, default=1.0) <= 0:
            raise RobotError(
                f"obstacle {self.name!r}: a {self.kind} needs {wanted[self.kind]} positive sizes [m], got {self.size}"
            )
        where = self.pose_obstacle_in_world
        if not (np.isfinite(where.position).all() and np.isfinite(where.orientation_xyzw).all()):
            raise RobotError(
                f"obstacle {self.name!r}: its pose must be finite, got {where.position} {where.orientation_xyzw}"
            )
        # coal ends the whole process when it is asked for the hull of flat corners.
        if self.kind == "hull" and (self.corners is None or not span_a_volume(self.corners)):
            raise RobotError(
                f"obstacle {self.name!r}: a hull needs finite corners (k, 3) [m], at least four and not all in a plane"
            )


def span_a_volume(corners: FloatArray) -> bool:
    """Whether corners (k, 3) are finite and do not all lie in a plane."""
    if corners.ndim != 2 or corners.shape[1] != 3 or len(corners) < 4 or not np.isfinite(corners).all():
        return False
    spread = np.linalg.svd(corners - corners.mean(axis=0), compute_uv=False)
    return bool(spread[2] > FLAT * spread[0])
