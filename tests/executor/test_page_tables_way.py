"""The page of Baxter and of the Mico, in a real browser, with what is known: a command of one's own wording is done."""

import asyncio
import shutil
from pathlib import Path

import pytest

from learning import Knowledge
from tests.executor.accessibility import problems
from tests.executor.page_visit import pictures_in, visit
from tests.executor.table_cases import CASES, knowledge_of

pytestmark = pytest.mark.skipif(
    not any(map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))),
    reason="needs a browser: apt-get install -y chromium",
)

MOST_CLICKS = 8
SENTENCES = {"baxter": "please grab teh orange aplle", "mico_segway": "lift teh small bleu carton"}
"""As somebody types who is in a hurry."""
TAKEN = {"baxter": "I take “aplle” as “apple”", "mico_segway": "I take “bleu” as “blue”"}


@pytest.mark.parametrize("robot", list(CASES))
def test_a_command_of_ones_own_wording_is_previewed_watched_and_done(robot: str, tmp_path: Path) -> None:
    known = tmp_path / "known.json"
    shutil.copy(knowledge_of(robot), known)
    before = known.read_bytes()
    pictures = pictures_in(tmp_path, robot)

    async def test() -> None:
        async with visit(CASES[robot].write(tmp_path), tmp_path / "demos", known) as page:
            tab = page.tab
            await tab.until("document.getElementById('guide').dataset.step === '4'")  # showing and learning are over
            assert await problems(tab) == []
            await page.click("#command")
            await tab.type(SENTENCES[robot])
            await page.enter()
            assert TAKEN[robot] in await page.answered("planned")
            time = page.status["time"]
            await tab.until("document.querySelector('.mark[data-role=entity]:not([hidden])') !== null")
            words = "[...document.querySelectorAll('#said .word')].map(e => e.dataset.kind)"
            assert {"action", "colour", "shape"} <= set(await tab.value(words))
            assert await problems(tab) == []
            await tab.screenshot(pictures / "planned.png")
            await page.enter()
            await page.answered("moving")
            await tab.until("document.querySelectorAll('#plan li[data-state=past]').length > 1")
            await tab.screenshot(pictures / "moving.png")
            await page.answered("done", 120.0)
            await tab.screenshot(pictures / "done.png")
            assert page.status["held"] == 0 and page.status["time"] > time + 1.0
            assert await problems(tab) == []
            assert page.clicks <= MOST_CLICKS
            assert tab.complaints == []

    asyncio.run(test())
    assert known.read_bytes() == before


@pytest.mark.parametrize("robot", list(CASES))
def test_what_is_known_of_a_table_was_learned_from_as_many_demos_as_is_said(robot: str) -> None:
    assert Knowledge.load(knowledge_of(robot)).demos == CASES[robot].demos
    assert knowledge_of(robot).stat().st_size < 100_000
