"""The error of this package, and how its messages write numbers."""

import math

import numpy as np

from robots.errors import RobotError
from robots.pose import FloatArray


class MotionError(RobotError):
    """A motion was asked for with numbers that make no sense, or the limits leave none."""


def check_positive(what: str, values: dict[str, float]) -> None:
    """Check that limits can be kept.

    Args:
        what: What they are limits of, for the message.
        values: Limits by name.

    Raises:
        MotionError: One is not positive and finite.
    """
    for name, value in values.items():
        if not value > 0 or not math.isfinite(value):
            raise MotionError(f"{what} limit {name} must be positive and finite; got {value}")


def listed(values: FloatArray) -> str:
    """Numbers on one line, for messages."""
    return f"[{', '.join(f'{value:.6g}' for value in np.ravel(values))}]"
