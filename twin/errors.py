"""Errors of the twin."""

from robots.errors import ShowtellError


class TwinError(ShowtellError):
    """Base of what goes wrong in the twin."""


class SceneError(TwinError, ValueError):
    """A scene is unknown or its specification is wrong."""
