"""Makes the pictures of the page: `python -m tests.pictures KNOWLEDGE`, with what `make demo` learned.

A word that nobody has said yet is typed, shown by driving, learned, and done: as a moving picture and a still one.
"""

import asyncio
import shutil
import sys
import tempfile
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import numpy as np
from PIL import Image

from tests.executor.page_visit import Driver, Visit, board_scene, visit
from twin.board import cell_centre

DOCS = Path(__file__).resolve().parent.parent / "docs"
SIZE = (800, 450)
"""Of the moving picture [pixel]."""
EVERY, SHOWN = 0.6, 160
"""Time between two frames when they are taken [s], and how long each is shown [ms]."""
PIECE = 0.03
"""How far is driven between two frames [m]."""
REST = 1400
"""How long the last frame of a part is shown [ms]."""
COLOURS = 160
UP = np.array([0.0, 0.0, 0.10])
WORD = "stack"


class Film:
    """Frames of a page with how long each is shown."""

    def __init__(self, page: Visit, folder: Path) -> None:
        self.page, self.folder = page, folder
        self.frames: list[Image.Image] = []
        self.times: list[int] = []

    async def take(self, shown: int = SHOWN) -> None:
        path = self.folder / "frame.png"
        await self.page.tab.screenshot(path)
        with Image.open(path) as image:
            self.frames.append(image.convert("RGB").resize(SIZE, Image.Resampling.LANCZOS))
        self.times.append(shown)

    @asynccontextmanager
    async def rolling(self) -> AsyncIterator[None]:
        """Take frames while the body runs, and hold the last one."""

        async def roll() -> None:
            while True:
                await self.take()
                await asyncio.sleep(EVERY)

        task = asyncio.create_task(roll())
        try:
            yield
        finally:
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)
        await self.take(REST)

    async def driven(self, driver: Driver, target: np.ndarray, last: float = 0.008) -> None:
        """Drive straight to a place, with a stop for every frame: a page that is looked at too often is silent."""
        start = driver.place
        count = max(1, round(float(np.linalg.norm(target - start)) / PIECE))
        for number in range(1, count + 1):
            end = number == count
            await driver.go(start + number / count * (target - start), near=last if end else 0.012)
            await self.take()

    async def typed(self, text: str, piece: int = 6) -> None:
        """Type, a few letters a frame."""
        for start in range(0, len(text), piece):
            await self.page.tab.type(text[start : start + piece])
            await self.take()

    def save(self, path: Path) -> None:
        # Small bright things would get no colour of their own among so much table: they count more.
        pixels = np.concatenate([np.asarray(each)[::3, ::3].reshape(-1, 3) for each in self.frames])
        bright = pixels[np.ptp(pixels.astype(int), axis=1) > 90]
        pixels = np.concatenate((pixels[::4], *[bright] * 4))
        rows = len(pixels) // 1000
        palette = Image.fromarray(np.ascontiguousarray(pixels[: rows * 1000].reshape(rows, 1000, 3))).quantize(COLOURS)
        frames = [each.quantize(palette=palette, dither=Image.Dither.NONE) for each in self.frames]
        frames[0].save(path, save_all=True, append_images=frames[1:], duration=self.times, loop=0, optimize=True)


async def make(knowledge: Path, folder: Path) -> None:
    """Go the whole way and save both pictures."""
    scene = board_scene(
        folder,
        ((3, 3, 0), "red", "cube"),
        ((4, 1, 0), "blue", "cube"),
        ((6, 5, 0), "green", "cube"),
        ((2, 6, 0), "yellow", "prism"),
    )
    known = folder / "known.json"
    shutil.copy(knowledge, known)
    async with visit(scene, folder / "demos", known) as page:
        tab, driver, film = page.tab, Driver(page, "arm", 0.3), Film(page, folder)
        await tab.value("document.getElementById('view').focus()")
        await film.take(REST)
        await page.click("#command")
        await film.typed(f"{WORD} the red cube on the blue cube")
        await page.enter()
        await page.answered("unknown-word")
        await film.take(REST)
        await page.click("#show-it")
        await page.in_mode("recording")
        start, goal = cell_centre(3, 3, 0), cell_centre(4, 1, 1)
        await film.driven(driver, start + UP)
        await film.driven(driver, start, last=0.004)
        await driver.grip(True)
        await film.take()
        await film.driven(driver, start + UP)
        await film.driven(driver, goal + UP)
        await film.driven(driver, goal + [0.0, 0.0, 0.003], last=0.004)
        await driver.grip(False)
        await film.take()
        await film.driven(driver, goal + UP)
        await page.click("#stop-deck")
        await page.in_mode("review")
        await film.take(REST)
        await page.click("#learn")
        await film.take()
        await page.learned(60.0)
        await film.take(REST)
        await page.click("#command")
        await tab.value("document.getElementById('command').value = ''")
        await film.typed(f"{WORD} the yellow prism on the green cube")
        await page.enter()
        print(await page.answered("planned"))
        await asyncio.sleep(0.6)
        await film.take(REST)
        await tab.screenshot(DOCS / "page.png")
        await page.enter()
        async with film.rolling():
            print(await page.answered("done", 60.0))
            await asyncio.sleep(0.5)
        film.times[-1] = 2 * REST
    film.save(DOCS / "showtell.gif")
    print(f"{len(film.frames)} frames, {(DOCS / 'showtell.gif').stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place:
        asyncio.run(make(Path(sys.argv[1]), Path(place)))
