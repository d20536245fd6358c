"""Pages are lost while they drive: the robot stops in time, in simulated time, and the demo and the status say why.

Real server, real control loop in its own process, real WebSockets. What is checked is what the demo recorded.
"""

from collections.abc import Awaitable, Callable
from pathlib import Path

import orjson
import pytest

from teleop import check_replay
from teleop.loop import SILENT, ControlLoop
from teleop.loop_channel import Channel
from teleop.loop_deck import Deck
from tests.teleop.lost_input import PERIOD, check_stops
from tests.teleop.test_server import SIDEWAYS, STILL, Page, Visitors, visited

GONE, GIVEN_BACK = "the page that held control is gone", "control was given back"
NOT_ENABLED, EMERGENCY = "not enabled", "emergency stop"
OUT_OF_RANGE = "gamepad axis left_x is 7.0, allowed -1..1"
BOTH_WAYS = (SIDEWAYS, STILL | {"axes": [1.0, 0.0, 0.0, 0.0]})


def served(scene: str, folder: Path, test: Callable[[Visitors], Awaitable[None]]) -> Path:
    """Run a test with a server of its own; returns the demo that was recorded."""
    visited(test, folder, scene)
    (path,) = folder.glob("*.mcap")
    return path


async def record(page: Page) -> None:
    await page.take()
    await page.say(type="do", action="record")
    await page.until(lambda page: page.status["deck"]["mode"] == "recording", saying=STILL)


async def drive(page: Page, sideways: dict[str, object]) -> None:
    """Take control if need be, let go of everything, and drive until the arm is at its speed; once more if we were slow
    on a busy machine, which stops the robot too."""
    if not page.yours:
        await page.take()
    while not page.status["executed"] > 0.9 * page.status["asked"] > 0.0:
        await page.until(lambda page: page.status["state"] == "ok" and not page.status["moving"], saying=STILL)
        await page.until(
            lambda page: (
                page.status["executed"] > 0.9 * page.status["asked"] > 0.0 or page.status["state"] == "stopped"
            ),
            saying=sideways,
        )


async def at_rest(watcher: Page, reason: str) -> None:
    """The status names the reason and the robot comes to rest."""
    await watcher.until(lambda page: page.status["state"] == "stopped" and reason in page.status["reason"])
    await watcher.until(lambda page: not page.status["moving"])


def test_every_way_of_losing_a_page(tmp_path: Path) -> None:
    async def test(visitors: Visitors) -> None:
        async with visitors.page() as watcher:
            async with visitors.page() as first:
                await record(first)
                await drive(first, BOTH_WAYS[0])
                await at_rest(watcher, SILENT)  # it stays connected and says nothing more
                assert any(SILENT in text for _, _, text in watcher.status["notices"])
                await first.hold(BOTH_WAYS[0], 0.1)
                await watcher.until(lambda page: page.status["reason"].startswith("let go of the sticks first"))
                assert not watcher.status["moving"]  # a stick that is still held moves nothing
                await drive(first, BOTH_WAYS[1])
                await first.input(STILL | {"axes": [7.0, 0.0, 0.0, 0.0]})
                await at_rest(watcher, OUT_OF_RANGE)
                await drive(first, BOTH_WAYS[0])
                await first.hold(BOTH_WAYS[0] | {"enabled": False}, 0.4)
                await drive(first, BOTH_WAYS[1])
                await watcher.say(type="stop")
                await first.until(lambda page: page.status["stopped"] and not page.status["moving"], saying=SIDEWAYS)
                await first.say(type="release")
                await drive(first, BOTH_WAYS[0])
                await first.say(type="control", action="release")
                await at_rest(watcher, GIVEN_BACK)
                await drive(first, BOTH_WAYS[1])
                await first.connection.close()
                await at_rest(watcher, GONE)
                assert any(GONE in text for _, _, text in watcher.status["notices"])
            async with visitors.page() as second:
                await drive(second, BOTH_WAYS[0])
                second.connection.transport.abort()  # as when its process is killed
                await at_rest(watcher, GONE)

    path = served("board", tmp_path, test)
    check_stops(path, [SILENT, OUT_OF_RANGE, NOT_ENABLED, EMERGENCY, GIVEN_BACK, GONE, GONE])
    assert check_replay(path).max_error == 0.0


@pytest.mark.parametrize("scene", ["tabletop", "ordering"])
def test_other_robots_stop_for_a_page_that_is_silent_and_for_one_that_is_gone(scene: str, tmp_path: Path) -> None:
    async def test(visitors: Visitors) -> None:
        async with visitors.page() as watcher, visitors.page() as driver:
            await record(driver)
            await drive(driver, BOTH_WAYS[0])
            await at_rest(watcher, SILENT)
            await drive(driver, BOTH_WAYS[1])
            driver.connection.transport.abort()
            await at_rest(watcher, GONE)

    check_stops(served(scene, tmp_path, test), [SILENT, GONE])


class Clock:
    """A clock that goes too slowly for a loop that makes lost time up."""

    now = 50.0

    def monotonic(self) -> float:
        return self.now

    def time(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        del seconds


def test_a_loop_that_makes_lost_time_up_counts_in_simulated_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the clock no time passes after the last input; the robot brakes all the same after 24 control steps."""
    clock = Clock()
    monkeypatch.setattr("teleop.loop.time", clock)
    ours, theirs = Channel.pair()
    deck = Deck("board", None, 3, tmp_path)
    loop, server = ControlLoop(deck, ours), Channel(theirs)

    def say(**message: object) -> None:
        server.send(orjson.dumps(message))

    def told(state: dict[str, object]) -> None:
        clock.now += 2e-3  # half as fast as the simulation
        say(type="input", **state, received=clock.now, late=0.0, stamp=clock.now)

    try:
        say(type="do", action="record", text="", demo="")
        for step in range(220):
            if step < 120:
                told(STILL if step < 3 else SIDEWAYS)
            loop.step()
            server.receive()
    finally:
        deck.close()
        ours.close()
    (path,) = tmp_path.glob("*.mcap")
    (stop,) = check_stops(path, [SILENT])
    assert stop.delay == pytest.approx(24 * PERIOD)
