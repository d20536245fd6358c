"""A real Chromium freezes, and is killed, while it drives: the robot stops in time, and the demo says so."""

import asyncio
import contextlib
import os
import signal
from collections.abc import Iterator
from pathlib import Path

from teleop import load_demo
from teleop.demo_stops import stops_of
from tests.executor.test_serve_page import Visit, pytestmark, visit
from tests.teleop.lost_input import check_stops

__all__ = ["pytestmark"]
SILENT, GONE = "the page is silent", "the page that held control is gone"


def processes_below(root: int) -> Iterator[int]:
    """The processes that a process started, and those that they started, and so on."""
    children = Path(f"/proc/{root}/task/{root}/children")
    with contextlib.suppress(OSError):  # it has ended
        for child in map(int, children.read_text().split()):
            yield child
            yield from processes_below(child)


def browser_processes() -> list[int]:
    """Those of the browser that this process started, its main process first."""
    names = {each: Path(f"/proc/{each}/comm") for each in processes_below(os.getpid())}
    return [each for each, name in names.items() if name.exists() and name.read_text().startswith("chrom")]


def send_all(processes: list[int], number: signal.Signals) -> None:
    for each in processes:
        with contextlib.suppress(ProcessLookupError):
            os.kill(each, number)


async def drive(page: Visit, key: str) -> None:
    """Press a key until the arm is at its speed; once more if the browser was slow, which stops the robot too."""
    code = f"Key{key.upper()}"
    while True:
        await page.until(lambda: page.status["state"] == "ok" and not page.status["moving"])
        await page.tab.key("keyDown", key, code)
        await page.until(lambda: page.status["state"] == "stopped" or page.status["executed"] > 0.2)
        if page.status["state"] != "stopped":
            return
        await page.tab.key("keyUp", key, code)


def test_a_browser_that_freezes_and_one_that_is_killed_stop_the_robot(tmp_path: Path) -> None:
    async def test() -> None:
        async with visit("board", tmp_path) as page:
            await page.ready()
            await page.tab.click("#record")
            await page.in_mode("recording")
            browser = browser_processes()
            await drive(page, "d")
            send_all(browser, signal.SIGSTOP)
            await page.until(lambda: page.status["reason"] == SILENT)
            await page.rests()
            send_all(browser, signal.SIGCONT)
            await page.tab.key("keyUp", "d", "KeyD")
            await drive(page, "a")
            os.kill(browser[0], signal.SIGSTOP)  # the page itself lives on, but hears of no key any more
            await page.until(lambda: page.status["reason"] == SILENT)
            await page.rests()
            os.kill(browser[0], signal.SIGCONT)
            await page.tab.key("keyUp", "a", "KeyA")
            await drive(page, "d")
            os.kill(browser[0], signal.SIGKILL)  # the others then end by themselves
            await page.until(lambda: page.status["reason"] in (SILENT, GONE))
            await page.rests()
            await page.until(lambda: page.status["reason"] == GONE)

    asyncio.run(test())
    (path,) = tmp_path.glob("*.mcap")
    killed = stops_of(load_demo(path))[-1].reason
    assert killed in (SILENT, GONE)  # its socket may be closed a little later
    check_stops(path, [SILENT, SILENT, killed])
