"""A page that talks, in a real headless Chromium, and somebody who drives the robot on it with a gamepad."""

import asyncio
import os
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import numpy as np

from executor.browser import Browser, Tab
from executor.talk.serving import talk_files, talking
from teleop.gamepad import BUTTONS
from teleop.loop_process import LoopSettings
from teleop.server import PageServer
from teleop.stick_shape import shape as speed_of
from twin.board import cell_centre

PAD = """
window.stick = [0, 0, 0, 0];
window.pressed = Array(17).fill(0);
navigator.getGamepads = () => [{
  id: "Stubbed pad", index: 0, connected: true, mapping: "standard", timestamp: performance.now(),
  axes: window.stick, buttons: window.pressed.map(value => ({pressed: value > 0.5, touched: value > 0, value})),
}];
"""
"""JavaScript that stands for a gamepad: its sticks are `window.stick`, its buttons `window.pressed`."""
GAIN = 2.5
"""Speed towards a place, per distance to it [1/s]."""
PATIENCE = 6.0
"""Time that a busy machine may take for a second of the robot's [s]."""
GRIPPING, SETTLING = 0.9, 0.3
"""Simulated time that the fingers need, and that they are left alone then [s]."""
TRIES = 4
"""How often a button is pressed on a busy machine."""
NEAR = 0.004
"""Near enough to a place [m]."""


class Visit:
    """A page of one server in a browser, with the clicks counted that a person would need."""

    def __init__(self, server: PageServer, tab: Tab) -> None:
        self.server, self.tab = server, tab
        self.clicks = 0

    @property
    def status(self) -> dict[str, Any]:
        return self.server.status

    @property
    def loop_pid(self) -> int:
        """Id of the control loop's process."""
        assert self.server._process is not None
        return self.server._process.pid

    async def until(self, test: Callable[[], Any], seconds: float = 15.0) -> None:
        deadline = asyncio.get_running_loop().time() + seconds
        while not test():
            assert asyncio.get_running_loop().time() < deadline, f"did not happen: {self.status}, {self.tab.complaints}"
            await asyncio.sleep(0.02)

    async def click(self, selector: str) -> None:
        """Click on an element as soon as it can be used."""
        self.clicks += 1
        await self.tab.until(
            f"(e => e && !e.disabled && e.ariaDisabled !== 'true')(document.querySelector('{selector}'))"
        )
        await self.tab.click(selector)

    async def enter(self) -> None:
        for kind in ("keyDown", "keyUp"):
            await self.tab.send(
                "Input.dispatchKeyEvent", type=kind, key="Enter", code="Enter", windowsVirtualKeyCode=13, text="\r"
            )

    async def in_mode(self, mode: str) -> None:
        await self.until(lambda: self.status["deck"]["mode"] == mode)
        await self.tab.until(f"document.getElementById('deck').dataset.mode === '{mode}'")

    async def answered(self, kind: str, seconds: float = 30.0) -> str:
        """Wait for a kind of answer; gives its text."""
        deadline = asyncio.get_running_loop().time() + seconds
        while await self.tab.value("document.getElementById('answer').dataset.kind") != kind:
            told = await self.tab.value("document.getElementById('answer').textContent")
            assert asyncio.get_running_loop().time() < deadline, f"not {kind}: {told}, {self.status}"
            await asyncio.sleep(0.03)
        return str(await self.tab.value("document.getElementById('answer').textContent"))

    async def learned(self, seconds: float = 30.0) -> None:
        await self.tab.until("document.getElementById('lesson').dataset.tone === 'good'", seconds)


class Driver:
    """Somebody who drives an arm on the page by looking where its hand is."""

    def __init__(self, page: Visit, arm: str, top_speed: float) -> None:
        self.page, self.arm, self.top = page, arm, top_speed
        travel = np.linspace(0.0, 1.0, 201)
        self._travel, self._speed = travel, np.array([speed_of(float(each), 0.08, 0.4) for each in travel])

    @property
    def place(self) -> np.ndarray:
        return np.array(self.page.status["tools"][self.arm]["position"])

    async def go(self, target: Sequence[float], seconds: float = 40.0, near: float = NEAR) -> None:
        """Move the tool to a place in the world [m] along the sticks' axes, within so much of the robot's own time."""
        until, deadline = self.page.status["time"] + seconds, asyncio.get_running_loop().time() + PATIENCE * seconds
        while True:
            off = np.asarray(target) - self.place
            if np.linalg.norm(off) < near:
                break
            late = self.page.status["time"] > until or asyncio.get_running_loop().time() > deadline
            assert not late, f"not there: {off}, {self.page.status['reason']}"
            if self.page.status["state"] == "stopped":  # a busy machine: the page was silent, and sticks must be let go
                await self._push(0.0, 0.0, 0.0)
                await asyncio.sleep(0.25)
                continue
            await self._push(*(self._deflection(each) for each in off))
            await asyncio.sleep(0.04)
        await self._push(0.0, 0.0, 0.0)
        await asyncio.sleep(0.1)
        await self.page.until(lambda: not self.page.status["moving"])

    async def grip(self, closed: bool) -> None:
        button = "a" if closed else "b"
        for _ in range(TRIES):
            await self._press(button, 1.0)
            await self._simulated(GRIPPING)
            stopped = self.page.status["state"] == "stopped"  # a busy machine: what was pressed then counts for nothing
            await self._press(button, 0.0)
            await self._simulated(SETTLING)
            if not stopped:
                break

    async def _simulated(self, seconds: float) -> None:
        """Wait for the robot's own time, which falls behind on a busy machine."""
        until = self.page.status["time"] + seconds
        await self.page.until(lambda: self.page.status["time"] >= until, 60.0)

    def _deflection(self, off: float) -> float:
        wanted = min(1.0, GAIN * abs(off) / self.top)
        return float(np.sign(off) * np.interp(wanted, self._speed, self._travel)) if wanted > 0.01 else 0.0

    async def _push(self, x: float, y: float, z: float) -> None:
        up, down = BUTTONS.index("right_trigger"), BUTTONS.index("left_trigger")
        await self.page.tab.value(
            f"void (window.stick = [{-y:.4f}, {-x:.4f}, 0, 0], window.pressed[{up}] = {max(z, 0.0):.4f},"
            f" window.pressed[{down}] = {max(-z, 0.0):.4f})"
        )

    async def _press(self, button: str, value: float) -> None:
        await self.page.tab.value(f"void (window.pressed[{BUTTONS.index(button)}] = {value})")


def pictures_in(folder: Path, name: str) -> Path:
    """Folder for what a test saw: `SHOWTELL_PICTURES` keeps it for people to look at."""
    place = Path(os.environ.get("SHOWTELL_PICTURES", folder)) / name
    place.mkdir(parents=True, exist_ok=True)
    return place


def board_scene(folder: Path, *blocks: tuple[tuple[int, int, int], str, str]) -> Path:
    """Write a scene of blocks, each a cell, a colour and a shape; ids count from 0."""
    lines = ['name = "board"', 'kind = "board"', 'robot = "three_dof"']
    for number, (cell, colour, shape) in enumerate(blocks):
        where = cell_centre(*cell).tolist()
        lines += ["[[objects]]", f"id = {number}", f'shape = "{shape}"', f'colour = "{colour}"', f"position = {where}"]
    path = folder / "scene.toml"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


@asynccontextmanager
async def visit(
    scene: Path | str,
    folder: Path,
    knowledge: Path | None = None,
    *,
    size: tuple[int, int] = (1280, 720),
    seed: int = 3,
) -> AsyncIterator[Visit]:
    """Serve the page as `showtell serve` does and open it."""
    settings = LoopSettings(str(scene), None, seed, folder)
    server = PageServer(talking(settings, knowledge or folder / "knowledge.json"), files=talk_files())
    async with served(server, size, PAD) as tab:
        await tab.until("!document.getElementById('dock').hidden")
        page = Visit(server, tab)
        await page.until(lambda: page.status["state"] == "ok")
        yield page


@asynccontextmanager
async def served(server: PageServer, size: tuple[int, int], first: str) -> AsyncIterator[Tab]:
    """Serve a page and open it, with a script that runs first; wait until the browser may drive and sees the robot."""
    ready: asyncio.Future[str] = asyncio.get_running_loop().create_future()
    serving = asyncio.create_task(server.run(ready.set_result))
    try:
        async with Browser() as browser:
            await asyncio.wait((ready, serving), return_when=asyncio.FIRST_COMPLETED)
            if serving.done():
                serving.result()
            tab = await browser.tab()
            await tab.start(*size, phone=size[0] < 600, first=first)
            await tab.open(ready.result())
            await tab.until("document.body?.dataset.control === 'yours' && Number(document.body.dataset.pictures) > 0")
            yield tab
    finally:
        serving.cancel()
        await asyncio.gather(serving, return_exceptions=True)
