"""Errors of input devices."""

from teleop.errors import TeleopError


class DeviceError(TeleopError, ValueError):
    """A device cannot be opened, or what came from outside is no gamepad's reading."""
