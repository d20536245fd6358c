"""Keeping simulated time beside real time."""

import time

MOST_BEHIND = 0.05
"""A loop that is later than this gives the lost time up, rather than running fast to make it up [s]."""


class Pace:
    """Says when the next step is due.

    A step that comes late makes the following ones come early until the schedule is met again, but never more than
    `MOST_BEHIND` is made up: after a longer pause the arm goes on at its own speed.

    Attributes:
        given_up: Time that was not made up, in all [s].
    """

    def __init__(self, period: float) -> None:
        """Start the schedule now.

        Args:
            period: Time between two steps [s].
        """
        self.given_up = 0.0
        self._period = period
        self._due = time.monotonic()
        self._late: list[float] = []

    def wait(self) -> None:
        """Sleep until the next step is due."""
        self._due += self._period
        now = time.monotonic()
        if now < self._due:
            time.sleep(self._due - now)
            now = time.monotonic()
        late = now - self._due
        self._late.append(late)
        if late > MOST_BEHIND:
            self.given_up += late
            self._due = now

    def restart(self) -> None:
        """Begin anew from now, after a pause that was meant."""
        self._due = time.monotonic()

    def lateness(self) -> tuple[float, float]:
        """Median and largest lateness of the steps since this was last asked [s]."""
        late = sorted(self._late) or [0.0]
        self._late.clear()
        return late[len(late) // 2], late[-1]
