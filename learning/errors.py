"""Errors of learning."""

from robots.errors import ShowtellError


class LearningError(ShowtellError):
    """Base of what goes wrong in learning."""


class ReleaseError(LearningError, ValueError):
    """A file of a Train-Robots release is missing or malformed; the message names file and line."""


class KnowledgeError(LearningError, ValueError):
    """A knowledge file cannot be read; the message names file and field."""


class PerceptionError(LearningError, ValueError):
    """What a demo or world shows cannot be perceived: nothing moved, or no concept was learned yet."""
