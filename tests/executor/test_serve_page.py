"""A real headless Chromium drives each robot through the page."""

import asyncio
import json
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import typer
from PIL import Image
from typer.testing import CliRunner

from executor.bench.page import STUB
from executor.browser import Tab
from teleop import TeleopError, check_replay, load_demo
from teleop.loop_process import LoopSettings
from teleop.server import PageServer
from tests.executor.page_visit import served

pytestmark = pytest.mark.skipif(
    not any(map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))),
    reason="needs a browser: apt-get install -y chromium",
)

ARM = {"board": "arm", "tabletop": "left", "ordering": "arm"}
MOVED = 0.004
"""Far beyond what a robot at rest gives way [m]."""


class Visit:
    """A page of one server in a browser."""

    def __init__(self, server: PageServer, tab: Tab, arm: str) -> None:
        self.server, self.tab, self.arm = server, tab, arm

    @property
    def status(self) -> dict[str, Any]:
        return self.server.status

    @property
    def tool(self) -> np.ndarray:
        return np.array(self.status["tools"][self.arm]["position"])

    async def until(self, test: Callable[[], Any], seconds: float = 10.0) -> None:
        deadline = asyncio.get_running_loop().time() + seconds
        while not test():
            assert asyncio.get_running_loop().time() < deadline, f"did not happen: {self.status}"
            await asyncio.sleep(0.02)

    def moved(self, axis: int, sign: int) -> Callable[[], bool]:
        """Whether the tool has moved one way from where it is now."""
        start = self.tool
        return lambda: bool(sign * (self.tool - start)[axis] > MOVED)

    async def moves(self, axis: int, sign: int) -> None:
        """Wait until the tool has moved one way from where it is."""
        await self.until(self.moved(axis, sign))

    async def key(self, letter: str, test: Callable[[], bool], *, lets_go: bool = True) -> None:
        """Hold a key until something is so, and let go of it then."""
        code = f"Key{letter.upper()}"
        press, release = (partial(self.tab.key, kind, letter, code) for kind in ("keyDown", "keyUp"))
        await self._hold(press, release, test, lets_go)

    async def stick(self, axes: list[float], test: Callable[[], bool]) -> None:
        """Hold a stick until something is so."""
        press, release = (partial(self.tab.value, f"void (window.stick = {each})") for each in (axes, [0] * len(axes)))
        await self._hold(press, release, test)

    async def _hold(
        self,
        press: Callable[[], Awaitable[Any]],
        release: Callable[[], Awaitable[Any]],
        test: Callable[[], bool],
        lets_go: bool = True,
    ) -> None:
        """Press until something is so, and let go.

        A page that was silent for a moment, as on a busy machine, has to be let go of before it drives on.
        """
        deadline = asyncio.get_running_loop().time() + 30.0
        await press()
        while not test():
            assert asyncio.get_running_loop().time() < deadline, f"did not happen: {self.status}"
            if self.status["reason"].startswith("let go of the sticks"):
                await release()
                await self.ready()
                await press()
            await asyncio.sleep(0.02)
        if lets_go:
            await release()
            await self.rests()

    async def rests(self) -> None:
        await self.until(lambda: not self.status["moving"])

    async def ready(self) -> None:
        await self.until(lambda: self.status["state"] == "ok")

    async def in_mode(self, mode: str) -> None:
        await self.until(lambda: self.status["deck"]["mode"] == mode)
        await self.tab.until(f"document.getElementById('deck').dataset.mode === '{mode}'")


@asynccontextmanager
async def visit(scene: str, folder: Path, *, width: int = 1280, height: int = 800) -> AsyncIterator[Visit]:
    server = PageServer(LoopSettings(scene, None, 3, folder))
    async with served(server, (width, height), STUB) as tab:
        yield Visit(server, tab, ARM[scene])


@pytest.mark.parametrize("scene", list(ARM))
def test_a_browser_drives_records_describes_and_replays(scene: str, tmp_path: Path) -> None:
    async def test() -> None:
        async with visit(scene, tmp_path) as page:
            tab = page.tab
            await page.ready()
            await page.stick([0.6, 0, 0, 0], page.moved(1, -1))  # right is -y
            await page.key("e", page.moved(2, 1))

            await tab.click("#record")
            await page.in_mode("recording")
            await page.ready()
            await page.key("d", page.moved(1, -1))
            await page.key("c", lambda: page.status["tools"][page.arm]["opening"] < 0.03)
            await tab.click("#sentence")
            await tab.type("reach to the right and close")
            await tab.click("#describe")
            await page.until(lambda: page.status["deck"]["sentences"] == 1)
            await tab.click("#stop-deck")
            await page.in_mode("review")
            await tab.click("#success")
            await page.until(lambda: page.status["deck"]["outcome"] == "success")
            await tab.click("#keep")
            await page.in_mode("idle")
            await tab.until("document.getElementById('demos').options.length === 1")
            await tab.click("#replay")
            await page.in_mode("replaying")
            await page.until(lambda: page.status["deck"]["mode"] == "idle", 20)
            assert "largest difference from the recording 0 " in page.status["notices"][-1][2]
            assert page.status["latency"]["median_ms"] < 50  # 4 ms where nothing else runs
            print(f"{scene}: input to command {page.status['latency']}")
            assert tab.complaints == []

    asyncio.run(test())
    (path,) = tmp_path.glob("*.mcap")
    demo = load_demo(path)
    assert demo.utterances == ("reach to the right and close",)
    assert demo.outcome.outcome == "success"
    assert check_replay(demo).max_error == 0.0


def test_a_page_that_freezes_or_is_closed_stops_the_robot(tmp_path: Path) -> None:
    async def test() -> None:
        async with visit("board", tmp_path) as page:
            tab = page.tab
            await page.ready()
            await page.key("d", page.moved(1, -1), lets_go=False)
            await tab.send("Debugger.enable")
            await tab.send("Debugger.pause")
            await page.until(lambda: page.status["reason"] == "the page is silent")
            await page.rests()
            await tab.send("Debugger.resume")
            await page.until(lambda: page.status["reason"].startswith("let go of the sticks"))  # D is still held
            await tab.until("document.getElementById('notices').textContent.includes('the page is silent')")
            await tab.key("keyUp", "d", "KeyD")
            await page.ready()

            await page.key("d", page.moved(1, -1), lets_go=False)
            await tab.key("keyDown", "Escape", "Escape")  # the emergency stop, from the keyboard
            await page.until(lambda: page.status["stopped"])
            await page.rests()
            await tab.key("keyUp", "d", "KeyD")
            await tab.until("document.getElementById('stop').getAttribute('aria-pressed') === 'true'")
            await tab.click("#stop")  # pressed once more at once it stops, and releases nothing
            await tab.until("document.getElementById('stop').textContent.startsWith('Release')")
            assert page.status["stopped"]
            await tab.click("#stop")
            await page.ready()

            await tab.click("#hold")  # nothing moves unless F is held
            await tab.key("keyDown", "a", "KeyA")
            await page.until(lambda: page.status["reason"] == "not enabled (hold the enabling button to move)")
            await tab.key("keyDown", "f", "KeyF")
            await page.moves(1, 1)
            assert tab.complaints == []
            await tab.send("Page.close")
            await page.until(lambda: page.status["reason"] == "the page that held control is gone")
            await page.rests()

    asyncio.run(test())


async def seen(page: Visit, path: Path) -> int:
    """How many colours the middle of the picture has; waits for the first picture."""
    for _ in range(40):
        await page.tab.screenshot(path)
        with Image.open(path) as image:
            width, height = image.size
            middle = np.asarray(image.convert("RGB").crop((width // 8, height // 5, width // 2, height // 2)))
        if (colours := len(np.unique(middle.reshape(-1, 3), axis=0))) > 200:
            return colours
        await asyncio.sleep(0.1)
    return colours


def box_of(element: str) -> str:
    return f"(b => [b.left, b.top, b.right, b.bottom])(document.getElementById('{element}').getBoundingClientRect())"


async def check_layout(page: Visit, width: int, height: int, path: Path) -> None:
    tab = page.tab
    assert await seen(page, path) > 200  # a shaded scene, not an empty canvas
    assert await tab.value("[innerWidth, innerHeight]") == [width, height]
    assert await tab.value("document.documentElement.scrollWidth <= innerWidth")
    await tab.value("scrollTo(0, 1e6)")
    box = await tab.value(box_of("stop"))
    assert 0 <= box[0] < box[2] <= width  # always in sight
    assert 0 <= box[1] < box[3] <= height
    await tab.value("scrollTo(0, 0)")
    roles = {"button", "slider", "textbox", "checkbox", "combobox", "radio", "radiogroup", "link"}
    tree = await tab.send("Accessibility.getFullAXTree")
    unnamed = [
        node
        for node in tree["nodes"]
        if node.get("role", {}).get("value") in roles and not node.get("name", {}).get("value")
    ]
    assert unnamed == []


def test_the_page_is_whole_at_desktop_and_phone_size(tmp_path: Path) -> None:
    async def test() -> None:
        async with visit("ordering", tmp_path) as page:
            tab = page.tab
            await page.ready()
            await check_layout(page, 1280, 800, tmp_path / "desktop.png")
            await tab.value("document.querySelector('#help summary').click()")
            assert await tab.value("document.getElementById('legend').rows.length") > 12
            await tab.value("document.querySelector('#help summary').click()")
            await tab.value("[...document.querySelectorAll('#views button')].at(-1).click()")
            await tab.until("[...document.querySelectorAll('#views button')].at(-1).ariaChecked === 'true'")
            for choice in ("wheels", "arm"):
                await tab.value(f"document.querySelector('#arms [data-arm={choice}]').click()")
                await page.until(lambda choice=choice: page.status["chosen"] == choice)
            assert await tab.value("location.hash + location.search") == ""  # the token is out of sight
            await tab.resize(390, 844, phone=True)
            await tab.open(page.server.url.split("#")[0] + "?again")  # this tab knows the token still
            await tab.until("location.search && document.body?.dataset.control === 'yours'")
            await page.ready()
            await check_layout(page, 390, 844, tmp_path / "phone.png")
            left, top, right, bottom = await tab.value(box_of("stick-left"))
            x, y = (left + right) / 2, (top + bottom) / 2
            await tab.send("Input.dispatchTouchEvent", type="touchStart", touchPoints=[{"x": x, "y": y}])
            await tab.send("Input.dispatchTouchEvent", type="touchMove", touchPoints=[{"x": x, "y": y + 40}])
            await page.moves(0, -1)
            await tab.send("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
            await page.rests()
            assert tab.complaints == []
            await tab.value("sessionStorage.clear()")
            await tab.open(page.server.url.split("#")[0])
            await tab.until("document.getElementById('safety-reason')?.textContent.includes('carries the token')")

    asyncio.run(test())


COMMAND = """
import typer
from executor.commands import serve
app = typer.Typer()
serve.add_to(app)
app()
"""


def test_the_command_prints_an_address_and_ends_in_order(tmp_path: Path) -> None:
    arguments = ["--json", "--port", "0", "-o", str(tmp_path / "demos")]
    with subprocess.Popen(
        [sys.executable, "-c", COMMAND, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        told = json.loads(process.stdout.readline())
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/#token=[\w-]{43}", told["url"])
        assert (tmp_path / "demos").is_dir()
        process.send_signal(signal.SIGTERM)
        out, err = process.communicate(timeout=20)
    assert process.returncode == 0
    assert out == ""
    assert err.splitlines()[-1] == "ended"


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--host", "0.0.0.0"], "--host 0.0.0.0 can be reached from other machines"),
        (["--host", "0.0.0.0", "--expose"], "--expose needs TLS"),
        (["--cert", "cert.pem"], "TLS needs both --cert and --key"),
    ],
)
def test_wrong_arguments_are_refused_before_anything_starts(arguments: list[str], told: str) -> None:
    from executor.commands.serve import serve

    app = typer.Typer()
    app.command()(serve)
    with pytest.raises(TeleopError, match=re.escape(told)):
        CliRunner().invoke(app, arguments, catch_exceptions=False)


def test_axes_of_the_camera_are_those_of_the_picture_on_the_page(tmp_path: Path) -> None:
    async def test() -> None:
        async with visit("board", tmp_path) as page:
            tab = page.tab
            await page.ready()
            await tab.key("keyDown", "t", "KeyT")
            await asyncio.sleep(0.3)  # long enough for the loop to see it
            await tab.key("keyUp", "t", "KeyT")
            await page.until(lambda: page.status["manner"] == "arm, axes of the camera")
            await tab.click("#record")
            await page.in_mode("recording")
            # From the front, opposite to the robot, its left is on the right; from behind, where it looks, on the left.
            for view, left_of_the_robot in (("front", 1), ("behind", -1)):
                await tab.value(
                    f"[...document.querySelectorAll('#views button')].find(b => b.textContent === '{view}').click()"
                )
                await asyncio.sleep(1.5)  # the view flies there
                await page.ready()
                await page.stick([0.6, 0, 0, 0], page.moved(1, left_of_the_robot))
            await tab.click("#stop-deck")
            await page.in_mode("review")
            await tab.click("#keep")
            await page.in_mode("idle")
            assert tab.complaints == []

    asyncio.run(test())
    (path,) = tmp_path.glob("*.mcap")
    demo = load_demo(path)
    assert demo.drive is not None
    seen = {command.camera_xyzw for command in demo.drive.commands if command.camera_xyzw is not None}
    assert len(seen) > 1
    assert check_replay(demo).max_error == 0.0
