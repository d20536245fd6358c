"""How long it takes from a stick on the page to the robot's joints, measured with a real browser."""

import asyncio
import math
import time
from dataclasses import asdict, dataclass

from executor.browser import Browser
from executor.errors import ExecutorError
from teleop.loop_process import LoopSettings
from teleop.server import PageServer

STUB = """
window.stick = [0, 0, 0, 0];
navigator.getGamepads = () => [{
  id: "Stubbed pad", index: 0, connected: true, mapping: "standard", timestamp: performance.now(),
  axes: window.stick, buttons: Array.from({length: 17}, () => ({pressed: false, touched: false, value: 0})),
}];
"""
"""JavaScript that stands for a gamepad whose sticks are `window.stick`."""
_SHARE = 0.5


@dataclass(frozen=True, slots=True)
class PageReport:
    """What was measured.

    Attributes:
        median_ms: From the page's reading of the stick to the command of the joints, median [ms].
        p99_ms: The same, 99th percentile [ms].
        inputs: Number of inputs measured.
        first_picture_s: From opening the address to the first picture [s].
        pictures_per_second: Pictures drawn a second.
        given_up_s: Time that the control loop could not make up [s].
        silences: How often the page was silent for 100 ms and the robot stopped for it.
    """

    median_ms: float
    p99_ms: float
    inputs: int
    first_picture_s: float
    pictures_per_second: float
    given_up_s: float
    silences: int

    def values(self) -> dict[str, object]:
        """For `--json`."""
        return {"figures": {f"page.{name}": value for name, value in asdict(self).items()}, "baselines": {}}

    def rows(self) -> list[tuple[str, str]]:
        """For a table."""
        return [(name, f"{value:.4g}") for name, value in asdict(self).items()]


async def bench_page(settings: LoopSettings, seconds: float) -> PageReport:
    """Serve the page, open it in a headless Chromium, and move a stubbed stick to and fro.

    Raises:
        BrowserError: There is no Chromium, or the page does not work in it.
        TeleopError: The control loop does not start.
    """
    server = PageServer(settings)
    ready: asyncio.Future[str] = asyncio.get_running_loop().create_future()
    serving = asyncio.create_task(server.run(ready.set_result))
    try:
        await asyncio.wait((ready, serving), return_when=asyncio.FIRST_COMPLETED)
        if serving.done():
            serving.result()
        async with Browser() as browser:
            return await _measure(server, browser, ready.result(), seconds)
    finally:
        serving.cancel()
        await asyncio.gather(serving, return_exceptions=True)


async def _measure(server: PageServer, browser: Browser, url: str, seconds: float) -> PageReport:
    tab = await browser.tab()
    await tab.start(1280, 800, first=STUB)
    opened = time.monotonic()
    await tab.open(url)
    await tab.until("document.body?.dataset.control === 'yours' && Number(document.body.dataset.pictures) > 0")
    first = time.monotonic() - opened
    pictures = int(await tab.value("Number(document.body.dataset.pictures)"))
    begun = time.monotonic()
    while (gone := time.monotonic() - begun) < seconds:
        await tab.value(f"void (window.stick = [{_SHARE * math.sin(4 * gone):.3f}, 0, 0, 0])")
        await asyncio.sleep(0.01)
    pictures = int(await tab.value("Number(document.body.dataset.pictures)")) - pictures
    status = server.status
    if tab.complaints:
        raise ExecutorError(f"the page complained: {tab.complaints[0]}")
    silences = sum("silent" in text for _, _, text in status["notices"])
    latency = status["latency"]
    return PageReport(
        latency["median_ms"],
        latency["p99_ms"],
        latency["count"],
        first,
        pictures / seconds,
        status["given_up"],
        silences,
    )
