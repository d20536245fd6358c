"""The root of every error that Showtell raises on purpose."""


class ShowtellError(Exception):
    """Base of all errors whose message is meant for the user: one line, value, bound, next step."""


class RobotError(ShowtellError, ValueError):
    """A robot is unknown, or its `robot.toml` or URDF is wrong."""
