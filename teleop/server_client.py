"""One page that is connected: how much it may say, how late it is, and what it is still to be told."""

import asyncio
import contextlib
import time

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

MESSAGES_A_SECOND = 250.0
"""What a page may send; ours sends at most 125."""
BURST = 250.0
"""What it may send at once after a pause."""
DRIFT = 1e-3
"""How fast two clocks may run apart [s/s], and how fast an estimate that was too small is forgotten."""
_MOST_TEXTS = 64


class Allowance:
    """A bucket of messages that fills with time (token bucket)."""

    def __init__(self, rate: float = MESSAGES_A_SECOND, burst: float = BURST) -> None:
        """Start full."""
        self._rate, self._burst = rate, burst
        self._left, self._at = burst, time.monotonic()

    def take(self, now: float) -> bool:
        """Use one up; says whether there was one.

        Args:
            now: Monotonic time [s].
        """
        self._left = min(self._burst, self._left + self._rate * (now - self._at))
        self._at = now
        if self._left < 1.0:
            return False
        self._left -= 1.0
        return True


class Lateness:
    """How much later than the fastest message a message is.

    Clocks of page and server differ by an unknown constant; the smallest difference seen stands for no delay. So what a
    frozen page or a stalled network held back is known to be old when it comes at last.
    """

    def __init__(self) -> None:
        """Nothing seen yet."""
        self._least: float | None = None
        self._at = 0.0

    def of(self, sent: float, received: float) -> float:
        """Extra delay of a message [s].

        Args:
            sent: By the page's clock [s].
            received: By the server's clock [s].
        """
        difference = received - sent
        if self._least is None:
            self._least = difference
        else:
            self._least = min(difference, self._least + DRIFT * max(received - self._at, 0.0))
        self._at = received
        return difference - self._least


class Client:
    """One connected page.

    What it does not read in time is replaced by newer poses and status, so a slow page costs nothing but its own
    smoothness.

    Attributes:
        number: Counts the pages since the server started.
        allowance: Messages it may send.
        lateness: Delay of its messages.
    """

    def __init__(self, connection: ServerConnection, number: int) -> None:
        """Take a connection on; `pump` must run for it to hear anything."""
        self.connection = connection
        self.number = number
        self.allowance = Allowance()
        self.lateness = Lateness()
        self._texts: list[str] = []
        self._latest: dict[str, str | bytes] = {}
        self._wake = asyncio.Event()

    def tell(self, text: str) -> None:
        """Send a message that must arrive; a page that reads nothing any more is given up."""
        if len(self._texts) >= _MOST_TEXTS:
            self.connection.transport.abort()
            return
        self._texts.append(text)
        self._wake.set()

    def show(self, kind: str, message: str | bytes) -> None:
        """Send a message that a newer one of its kind replaces."""
        self._latest.pop(kind, None)  # in the order of the newest
        self._latest[kind] = message
        self._wake.set()

    async def pump(self) -> None:
        """Send what is to be sent, as fast as the page reads, until the connection ends."""
        with contextlib.suppress(ConnectionClosed):
            while True:
                await self._wake.wait()
                self._wake.clear()
                while self._texts or self._latest:
                    if self._texts:
                        await self.connection.send(self._texts.pop(0))
                    else:
                        kind = next(iter(self._latest))
                        await self.connection.send(self._latest.pop(kind))
