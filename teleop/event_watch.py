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

    def __init__(self, rate: int) -> None:
        """Start with nothing wrong.

        Args:
            rate: Control steps a second.
        """
        self._rate = rate
        self._safety = ("ok", "")
        self._since = -SAFETY_GAP
        self._stop = False
        self._lost = ""
        self._openings: tuple[float, ...] = ()
        self._heard: int | None = None
        """Step of the last input that could be trusted."""
        self._brakes: int | None = None
        """Step at which braking began, while what was moving is not at rest yet."""
        self._told_to_stop = False
        self._moved = False

    def after(
        self, step: int, command: DriveCommand, result: DriveOutcome, *, arrived: bool = True
    ) -> Iterator[tuple[EventKind, str, str]]:
        """Kind, text and arm of what happened in this step; `arrived` says whether input came since the last."""
        if command.stop != self._stop:
            self._stop = command.stop
            yield "stop", "emergency stop" if command.stop else "emergency stop released", ""
        lost = command.fault or ("input is older than 0.1 s" if not command.age <= MAX_AGE else "")
        if lost != self._lost:
            # A fault that names a value changes with it: only the change between good and bad is an event.
            if bool(lost) != bool(self._lost):
                yield "device", f"lost: {lost}{self._since_heard(step)}" if lost else "found again", ""
            self._lost = lost
        if arrived and not lost:
            self._heard = step
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
        yield from self._rest(step, bool(lost) or command.stop or not command.enabled, result)

    def _since_heard(self, step: int) -> str:
        if self._heard is None:
            return ""
        return f"; the last input came {1000 * (step - self._heard) / self._rate:.0f} ms before"

    def _rest(self, step: int, told_to_stop: bool, result: DriveOutcome) -> Iterator[tuple[EventKind, str, str]]:
        """Say when everything is at rest that was moving when it was told to stop."""
        if told_to_stop and not self._told_to_stop and self._moved:
            self._brakes = step
        elif not told_to_stop:
            self._brakes = None
        self._told_to_stop = told_to_stop
        self._moved = any(map(any, (result.joint_velocity, result.base_twist)))
        if self._brakes is not None and not self._moved:
            yield "safety", f"at rest {1000 * (step + 1 - self._brakes) / self._rate:.0f} ms after braking began", ""
            self._brakes = None
