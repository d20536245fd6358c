"""Noticing what happens between two control steps, so that a demo says it in words once."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Protocol

from robots.pose import FloatArray

from .demo_events import EventKind
from .drive_command import MAX_AGE, DriveCommand

SAFETY_GAP = 60
"""Fewest control steps between two events about slowing down: a quarter of a second. A stop is told at once."""


class ArmOutcome(Protocol):
    """What a servo says of one arm."""

    @property
    def asked(self) -> FloatArray:
        """Twist asked for, (6,)."""

    @property
    def executed(self) -> FloatArray:
        """Twist executed, (6,)."""

    @property
    def reason(self) -> str:
        """Why they differ."""

    @property
    def detail(self) -> str:
        """The joint, the pair or the fault behind the reason."""


class DriveOutcome(Protocol):
    """What a robot's servo says of one control step."""

    @property
    def joint_velocity(self) -> FloatArray:
        """Executed velocities of all driven joints, (n,) [rad/s]."""

    @property
    def base_twist(self) -> FloatArray | Sequence[float]:
        """Executed speed [m/s] and turning speed [rad/s] of the base, (2,)."""

    @property
    def base_asked(self) -> FloatArray | Sequence[float]:
        """What was wanted of it, (2,)."""

    @property
    def openings(self) -> Mapping[str, float] | Sequence[float]:
        """Wanted gaps between the fingers, by arm or in the robot's order [m]."""

    @property
    def arms(self) -> Mapping[str, ArmOutcome]:
        """Of each arm."""

    @property
    def state(self) -> str:
        """`ok`, `slowed` or `stopped`."""

    @property
    def reason(self) -> str:
        """Why it is not ok."""


def openings_of(result: DriveOutcome) -> tuple[float, ...]:
    """Wanted gaps between the fingers, in the order of the arms [m]."""
    given = result.openings
    values = [given[name] for name in result.arms] if isinstance(given, Mapping) else given
    return tuple(float(value) for value in values)


class EventWatch:
    """Compares each control step with the one before."""

    def __init__(self) -> None:
        """Start with nothing wrong."""
        self._safety = ("ok", "")
        self._since = -SAFETY_GAP
        self._stop = False
        self._lost = ""
        self._openings: tuple[float, ...] = ()

    def after(self, step: int, command: DriveCommand, result: DriveOutcome) -> Iterator[tuple[EventKind, str, str]]:
        """Kind, text and arm of what happened in this step."""
        if command.stop != self._stop:
            self._stop = command.stop
            yield "stop", "emergency stop" if command.stop else "emergency stop released", ""
        lost = command.fault or ("input is older than 0.1 s" if not command.age <= MAX_AGE else "")
        if lost != self._lost:
            # A fault that names a value changes with it: only the change between good and bad is an event.
            if bool(lost) != bool(self._lost):
                yield "device", f"lost: {lost}" if lost else "found again", ""
            self._lost = lost
        safety = (str(result.state), str(result.reason) if result.state != "ok" else "")
        told = safety[0] == "stopped" and self._safety[0] != "stopped"
        if safety != self._safety and (told or step - self._since >= SAFETY_GAP):
            self._safety, self._since = safety, step
            yield "safety", f"{safety[0]}: {safety[1]}" if safety[1] else safety[0], ""
        openings = openings_of(result)
        if openings != self._openings:
            for name, before, now in zip(result.arms, self._openings, openings, strict=False):
                if before != now:
                    yield "gripper", "closes" if now < before else "opens", name
            self._openings = openings
