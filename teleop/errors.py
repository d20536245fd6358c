"""Errors of teleoperation."""

from robots.errors import ShowtellError


class TeleopError(ShowtellError):
    """Base of what goes wrong in teleoperation."""


class ServoError(TeleopError, ValueError):
    """A servo was given arrays of the wrong shape or a control period that is not positive."""


class DemoError(TeleopError, ValueError):
    """A file is not a demo, or cannot be read or written; the message names the file."""


class TaskError(TeleopError, ValueError):
    """A task cannot be done or described in this scene."""
