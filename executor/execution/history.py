"""Going back: moments of a world before each command that moved something."""

from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from twin import World
    from twin.world import Snapshot

KEPT = 20
"""Commands that can be undone; each keeps a state of physics in memory."""


@dataclass(frozen=True, slots=True)
class Moment:
    """A moment to go back to.

    Attributes:
        snapshot: The world then.
        last: Track number of what had been handled last then.
        sentence: What was said then.
    """

    snapshot: "Snapshot"
    last: int | None
    sentence: str


class History:
    """The last moments before commands.

    Args:
        world: The world.
    """

    def __init__(self, world: "World") -> None:
        self.world = world
        self._moments: deque[Moment] = deque(maxlen=KEPT)

    def __len__(self) -> int:
        """How many commands can be undone."""
        return len(self._moments)

    def keep(self, sentence: str, last: int | None) -> None:
        """Keep this moment, before a sentence is carried out."""
        self._moments.append(Moment(self.world.snapshot(), last, sentence))

    def drop(self) -> None:
        """Forget the last kept moment: nothing was done after it."""
        self._moments.pop()

    def go_back(self) -> Moment | None:
        """Restore the world of the last kept moment, and forget it; None where there is none."""
        if not self._moments:
            return None
        moment = self._moments.pop()
        self.world.restore(moment.snapshot)
        return moment
