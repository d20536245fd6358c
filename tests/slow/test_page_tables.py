"""The newcomer's whole way on the page with Baxter and with the Mico: a new word is shown by driving, and done."""

import asyncio
import os
import shutil
from pathlib import Path

import numpy as np
import pytest

from executor.tables.learned import from_table_collection
from learning import Knowledge
from teleop import check_replay
from tests.executor.accessibility import problems
from tests.executor.page_visit import Driver, pictures_in, visit
from tests.executor.table_cases import CASES, Case

MOST_CLICKS = 8


async def way(case: Case, folder: Path, knowledge: Path, pictures: Path) -> None:
    """Ask in a word of one's own, be told that it is new, show it by driving, and ask again."""
    scene = case.write(folder)
    sentence = f"fetch the {case.word}"
    async with visit(scene, folder / "demos", knowledge) as page:
        tab, driver = page.tab, Driver(page, case.arm, case.top_speed)
        await page.click("#command")
        await tab.type(sentence)
        await page.enter()
        assert "fetch" in await page.answered("unknown-word")
        await tab.screenshot(pictures / "new.png")
        assert await problems(tab) == []
        await page.click("#show-it")
        await page.in_mode("recording")
        grasp = np.array(case.grasp)
        await driver.go([*grasp[:2], driver.place[2]], near=0.01)
        await driver.go(grasp, near=0.006)
        await driver.grip(True)
        assert page.status["held"] == 0
        await driver.go(grasp + [0.0, 0.0, 0.12], near=0.02)
        await asyncio.sleep(0.5)
        await tab.screenshot(pictures / "shown.png")
        await page.click("#stop-deck")
        await page.in_mode("review")
        await page.click("#learn")
        await page.learned(180.0)
        await page.click("#reset")  # the scene as it was
        await page.until(lambda: page.status["held"] is None)
        await page.click("#command")
        await page.enter()  # the sentence still stands there
        await page.answered("planned")
        await tab.until("document.querySelector('.mark[data-role=entity]:not([hidden])') !== null")
        await tab.screenshot(pictures / "planned.png")
        assert await problems(tab) == []
        await page.enter()
        await page.answered("moving")
        await tab.until("document.querySelectorAll('#plan li[data-state=past]').length > 1")
        await tab.screenshot(pictures / "moving.png")
        await page.answered("done", 60.0)
        await tab.screenshot(pictures / "done.png")
        assert page.status["held"] == 0
        assert page.clicks <= MOST_CLICKS
        assert tab.complaints == []


@pytest.mark.slow
@pytest.mark.parametrize("robot", list(CASES))
def test_a_word_that_is_shown_by_driving_is_done(robot: str, tmp_path: Path) -> None:
    """`SHOWTELL_KNOWLEDGE_<ROBOT>` names knowledge to start from; without it a collection is recorded and learned."""
    case = CASES[robot]
    given = os.environ.get(f"SHOWTELL_KNOWLEDGE_{robot.upper()}")
    learned = Path(given) if given else from_table_collection(robot, tmp_path, case.demos, 0, 0, lambda: None).path
    known = tmp_path / "known.json"
    shutil.copy(learned, known)
    before = Knowledge.load(known).demos
    asyncio.run(way(case, tmp_path, known, pictures_in(tmp_path, robot)))
    assert Knowledge.load(known).demos == before + 1
    (demo,) = (tmp_path / "demos").glob("*.mcap")
    assert check_replay(demo).max_error == 0.0
