"""Errors of the executor and its command line."""

from robots.errors import ShowtellError


class ExecutorError(ShowtellError):
    """Base of what goes wrong in the executor."""


class RefusalError(ExecutorError):
    """A goal cannot be carried out in this scene; the message says why, in plain words."""


class InputError(ExecutorError, ValueError):
    """An argument of a command is wrong; the message gives the value and what is allowed."""
