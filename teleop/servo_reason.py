"""Why a robot does not do what it is asked to."""

from enum import StrEnum


class DriveReason(StrEnum):
    """Why the executed motion is not the asked one."""

    NONE = ""
    STOPPED = "emergency stop"
    BAD_INPUT = "bad input"
    LOST_INPUT = "input lost"
    DISABLED = "not enabled"
    COLLISION = "too near"
    CONTACT = "in contact"
    POSITION_LIMIT = "position limit"
    SINGULARITY = "singularity"
    VELOCITY_LIMIT = "velocity limit"
    UNREACHABLE = "unreachable direction"
    ACCELERATION_LIMIT = "acceleration or jerk limit"


STOPPING = frozenset((DriveReason.STOPPED, DriveReason.BAD_INPUT, DriveReason.LOST_INPUT, DriveReason.DISABLED))
"""Reasons for which everything brakes."""
