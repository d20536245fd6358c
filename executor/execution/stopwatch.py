"""Wall-clock time spent on each part of carrying out a command."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field


@dataclass(slots=True)
class Stopwatch:
    """Wall-clock time spent on each part of the work [s]."""

    seconds: dict[str, float] = field(default_factory=dict)
    begun: float = field(default_factory=time.perf_counter)

    @contextmanager
    def part(self, name: str) -> Iterator[None]:
        """Add the time that the body takes to a part."""
        begun = time.perf_counter()
        try:
            yield
        finally:
            self.add(name, time.perf_counter() - begun)

    def add(self, name: str, seconds: float) -> None:
        """Add time to a part [s]."""
        self.seconds[name] = self.seconds.get(name, 0.0) + seconds

    def mark_once(self, name: str) -> None:
        """Keep the time since the start under a name, the first time that this is called."""
        if name not in self.seconds:
            self.seconds[name] = time.perf_counter() - self.begun

    def restart(self) -> None:
        """Begin anew."""
        self.seconds = {}
        self.begun = time.perf_counter()
