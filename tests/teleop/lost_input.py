"""What every stop of a demo must satisfy, whatever it was that lost the input."""

from collections.abc import Sequence
from pathlib import Path

from teleop import Demo, load_demo
from teleop.demo_stops import Stop, stops_of
from teleop.loop import SILENT

PERIOD = 1.0 / 240.0
ROUNDING = 1e-9
TOLERANCE = 2.0 * PERIOD
"""Rest is seen at the end of a control period (one), and the acceleration at the start of braking is known as the mean
of the period before only, half a period from its end: to take the difference away takes half a period (one)."""


def check_stops(path: Path, reasons: Sequence[str]) -> list[Stop]:
    """The demo's stops have these reasons, in this order; returns them. All are in time, in simulated time.

    On a machine that is busy with other tests a client may be late by itself: more stops for silence may come between.
    """
    demo = load_demo(path)
    left, found = list(reasons), []
    for stop in stops_of(demo):
        _check_in_time(stop)
        if left and stop.reason == left[0]:
            found.append(stop)
            del left[0]
            assert stop.needed > 3.0 * TOLERANCE, f"too slow to tell: {stop}"
            _check_told(demo, stop)
        else:
            assert stop.reason == SILENT, stop
    assert not left
    return found


def _check_in_time(stop: Stop) -> None:
    """Braking began within 100 ms of the last input and took no longer than the limits need."""
    assert stop.delay is not None and stop.delay <= 0.1 + ROUNDING, stop
    assert stop.taken is None or stop.taken <= stop.needed + TOLERANCE, stop


def _check_told(demo: Demo, stop: Stop) -> None:
    """The demo's events say in words when braking began and why, and when everything was at rest."""
    step = round(stop.braking / PERIOD)
    told = [event.text for event in demo.events if event.step == step and event.kind in ("device", "stop", "safety")]
    assert any(stop.reason in text for text in told), (stop, told)
    assert stop.rest is not None, stop
    last = round(stop.rest / PERIOD) - 1
    rest = f"at rest {1000 * (last + 1 - step) / demo.rate:.0f} ms after braking began"
    assert (last, rest) in [(event.step, event.text) for event in demo.events]
