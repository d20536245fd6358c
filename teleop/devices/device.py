"""What every input device says, and how it is asked."""

from dataclasses import dataclass
from types import TracebackType
from typing import Protocol, Self

from teleop.gamepad import RESTING, GamepadState


@dataclass(frozen=True, slots=True)
class DeviceReading:
    """What a device said last.

    Attributes:
        gamepad: Its sticks and buttons, in W3C's standard layout; at rest when it is not connected.
        timestamp: When the device was last known to say this [s], on the clock of `time.monotonic`: its newest event or
            sign of life. Whoever moves something by it compares this with the time now.
        connected: Whether it is there.
        name: What it is called.
        fault: Why it cannot be trusted; empty when it can.
    """

    gamepad: GamepadState = RESTING
    timestamp: float = 0.0
    connected: bool = False
    name: str = ""
    fault: str = ""


class Device(Protocol):
    """Something that people drive with. Losing it is a reading, never an exception."""

    def poll(self, now: float) -> DeviceReading:
        """Say what the device says now; never waits, never raises.

        Args:
            now: The time [s], of `time.monotonic`.
        """

    def close(self) -> None:
        """Let go of the device; may be called again."""

    def __enter__(self) -> Self:
        """Return the device."""

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close it."""


class DeviceBase:
    """Entering and leaving, the same for every device."""

    def close(self) -> None:
        """Let go of the device; may be called again."""

    def __enter__(self) -> Self:
        """Return the device."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close it."""
        self.close()
