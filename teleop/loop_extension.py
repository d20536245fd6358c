"""What may be added to the control loop from above: a part that hears what is said on the page and may move the robot.

Such a part lives in the loop's process, because commands are carried out on the very world that is seen and driven. It
is named by `module:name` in the settings, so that nothing here knows it.
"""

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Protocol

from .errors import TeleopError

if TYPE_CHECKING:
    from twin.world import World

    from .loop_deck import Deck

TEXT_KINDS = "JSTK"
"""First bytes of the loop's messages that are JSON: status, setup, and what an extension tells, short and long."""


class LentStopError(Exception):
    """The person stopped what moves the robot, or is gone: raised out of `World.step`, before the step.

    It is no `ShowtellError`, so that nothing between takes it for a plan that failed.
    """


class Desk(Protocol):
    """What the control loop offers an extension."""

    @property
    def deck(self) -> "Deck":
        """The scene and what is recorded."""

    def lend(self, why: str) -> AbstractContextManager["World"]:
        """Give the world away: until the end, whoever steps it moves the robot, in real time and in sight of all pages.

        Driving is locked meanwhile. Stopping works at every step: the step raises `LentStopError`, and whatever moves
        is braked within the robot's limits afterwards.

        Args:
            why: What is on, for people.

        Raises:
            TeleopError: Something is recorded or replayed, or the emergency stop holds.
        """

    def tell(self, kind: Literal["T", "K"], message: Mapping[str, object]) -> bool:
        """Tell all pages something; says whether it could be sent now. A newer message of a kind replaces it.

        `K` may be long; it waits until it is sent.
        """

    def notice(self, level: Literal["info", "warning", "error"], text: str) -> None:
        """Add a line to what happened."""

    def keep(self) -> Path:
        """Keep the demo that waits.

        Raises:
            TeleopError: None waits.
        """


class LoopExtension(Protocol):
    """What an extension is to the control loop."""

    def hear(self, message: dict[str, Any]) -> None:
        """Take a message of a page, of type `talk`; must not take long."""

    def step(self) -> None:
        """Do what is to be done; called once a control step, while nothing is lent."""

    def close(self) -> None:
        """End."""


MakeExtension = Callable[[Desk], LoopExtension]


def load_extension(name: str, options: Mapping[str, str]) -> MakeExtension:
    """Find what makes an extension.

    Args:
        name: `module:name` of a function of a desk and the options.
        options: What the function is given.

    Raises:
        TeleopError: There is no such function.
    """
    module, _, attribute = name.partition(":")
    try:
        make = getattr(import_module(module), attribute)
    except (ImportError, AttributeError) as error:
        raise TeleopError(f"the extension {name!r} cannot be loaded: {error}; give `module:name`") from error
    return lambda desk: make(desk, options)
