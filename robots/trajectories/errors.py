"""The error of this package, and how its messages write numbers."""

import numpy as np

from robots.errors import RobotError
from robots.pose import FloatArray


class MotionError(RobotError):
    """A motion was asked for with numbers that make no sense, or the limits leave none."""


def listed(values: FloatArray) -> str:
    """Numbers on one line, for messages."""
    return f"[{', '.join(f'{value:.6g}' for value in np.ravel(values))}]"
