"""Driving at this machine: a gamepad or the keys of a terminal move the robot in real time and record demos."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from robots.errors import ShowtellError

from .devices import Device
from .input_age import InputAge
from .loop_deck import Deck
from .loop_driver import DriveReport, OperatorInput
from .loop_pace import Pace

TELL_EVERY = 24
"""Control steps between two looks at how things are: 10 Hz."""


@dataclass(frozen=True, slots=True)
class HandStatus:
    """How things are, for a line on the screen.

    Attributes:
        mode: What the recorder does.
        seconds: Simulated time of the scene [s].
        manner: What the sticks move, and how.
        report: Whether the last wish was followed, and why not.
        device: What the person drives with; empty when it is lost.
        notice: What happened last.
    """

    mode: str
    seconds: float
    manner: str
    report: DriveReport
    device: str
    notice: str


def drive_by_hand(
    deck: Deck,
    device: Device,
    tell: Callable[[HandStatus], None],
    *,
    seconds: float | None = None,
    clock: Callable[[], float] = time.monotonic,
    pace: Pace | None = None,
) -> list[Path]:
    """Drive until Ctrl-C or for some time; what is being recorded then is kept.

    A lost device, and input that cannot be trusted, stop the robot smoothly; it goes on when the device is back and its
    sticks were let go.

    Args:
        deck: Scene, driver and recorder.
        device: What the person drives with.
        tell: Called ten times a second and when something happened.
        seconds: How long [s]; None goes on until Ctrl-C.
        clock: The time [s] on the device's clock; asked once a control step.
        pace: When steps are due; None takes real time.

    Returns:
        The demos that were recorded and kept, in order.
    """
    pace, ages = pace or Pace(deck.world.DT), InputAge(deck.world.DT)
    notice, step = "", 0
    before = set(deck.demos())
    try:
        while seconds is None or step * deck.world.DT < seconds:
            now = clock()
            reading = device.poll(now)
            age, arrived = ages.of(reading.timestamp, now)
            fault = reading.fault or ("" if reading.connected else "no device: plug it in")
            if not fault and ages.is_lost(age):
                fault = f"the {reading.name} is silent"
            wish = OperatorInput(reading.gamepad, True, age, fault, arrived and not fault)
            report, told = deck.step(wish)
            for event in deck.driver.mapping.take_events():
                changes = deck.changes
                try:
                    told = deck.press(event.name) or told
                except ShowtellError as error:
                    told = str(error)
                if deck.changes != changes:
                    pace.restart()  # the time in which the scene was set up is not made up
            step += 1
            if told or step % TELL_EVERY == 0:
                notice = told or notice
                time_now, manner = deck.world.state().time, deck.driver.manner
                tell(HandStatus(deck.mode, time_now, manner, report, reading.name if not fault else "", notice))
            pace.wait()
    except KeyboardInterrupt:
        pass
    finally:
        deck.close()
    return [path for path in deck.kept() if path.name not in before]
