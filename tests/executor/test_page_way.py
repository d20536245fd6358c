"""The newcomer's whole way on the page, in a real browser: show, tell, learn, command, watch; and other ways."""

import asyncio
import contextlib
import os
import shutil
import signal
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from executor.execution.knowledge_lock import locked
from learning import Knowledge
from learning.concept_id import Concept
from teleop import TeleopError, check_replay, load_demo
from tests.executor.accessibility import problems
from tests.executor.page_visit import Driver, Visit, board_scene, pictures_in, visit
from twin.board import cell_centre

pytestmark = pytest.mark.skipif(
    not any(map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))),
    reason="needs a browser: apt-get install -y chromium",
)

MOST_CLICKS = 8
UP = np.array([0.0, 0.0, 0.10])


async def rings(page: Visit) -> list[tuple[str, str, list[float]]]:
    """Role, label and middle of every ring that is seen in the picture."""
    found = await page.tab.value(
        "[...document.querySelectorAll('.mark:not([hidden])')].map(e => { const b = e.getBoundingClientRect();"
        " return [e.dataset.role, e.textContent, [b.x + b.width / 2, b.y + b.height / 2]]; })"
    )
    return [(role, label, middle) for role, label, middle in found]


async def ringed(page: Visit, role: str, count: int) -> None:
    """Wait until so many rings of a role are seen: the picture is drawn when there is time."""
    await page.tab.until(f"document.querySelectorAll('.mark[data-role={role}]:not([hidden])').length === {count}")


def colour_at(path: Path, middle: list[float]) -> np.ndarray:
    """Mean colour of the picture around a place, (3,)."""
    x, y = (round(value) for value in middle)
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB").crop((x - 4, y - 4, x + 4, y + 4)), dtype=float).mean(axis=(0, 1))


def test_a_newcomer_shows_tells_and_has_a_command_done_in_eight_clicks(tmp_path: Path) -> None:
    async def test() -> None:
        scene = board_scene(
            tmp_path, ((3, 3, 0), "red", "cube"), ((4, 2, 0), "blue", "cube"), ((6, 6, 0), "green", "prism")
        )
        pictures = pictures_in(tmp_path, "board")
        async with visit(scene, tmp_path / "demos") as page:
            tab, driver = page.tab, Driver(page, "arm", 0.3)
            assert await tab.value("document.querySelector('#guide [aria-current=step]').textContent") != ""
            assert await problems(tab) == []
            await page.click("#record")
            await page.in_mode("recording")
            start, goal = cell_centre(3, 3, 0), cell_centre(4, 2, 1)
            await driver.go(start + UP, near=0.006)
            await driver.go(start)
            await driver.grip(True)
            assert page.status["held"] == 0
            await driver.go(start + UP, near=0.02)
            await driver.go(goal + UP, near=0.006)
            await driver.go(goal + [0.0, 0.0, 0.003])
            await driver.grip(False)
            await driver.go(goal + UP, near=0.02)
            await page.click("#stop-deck")
            await page.in_mode("review")
            assert await problems(tab) == []
            await page.click("#sentence")
            await tab.type("put the red cube on the blue cube")
            await tab.screenshot(pictures / "tell.png")
            await page.click("#learn")  # what was typed is told, the demo kept and learned
            await page.learned()
            assert await tab.value("document.getElementById('guide').dataset.step") == "4"

            await page.click("#command")
            await tab.type("put red on blue")
            await page.enter()
            await page.answered("planned")
            assert await tab.value("document.getElementById('guide').dataset.step") == "5"
            said = await tab.value(
                "[...document.querySelectorAll('#said .word')].map(e => [e.querySelector('b').textContent,"
                " e.querySelector('small').textContent, getComputedStyle(e.querySelector('b')).borderBottomStyle])"
            )
            assert [word for word, *_ in said] == ["put", "red", "on", "blue"]
            assert all(label and line != "none" for _, label, line in said)  # never by colour alone
            plan = await tab.value("[...document.querySelectorAll('#plan li')].map(e => e.textContent)")
            assert "close the gripper" in plan and plan[0].startswith("action_1")
            await ringed(page, "goal", 1)
            assert await problems(tab) == []
            await tab.screenshot(pictures / "planned.png")
            before = page.status["time"]
            await page.enter()
            await tab.until("document.body.dataset.lent === 'yes'")
            await tab.until("document.getElementById('answer').dataset.kind === 'moving'")
            assert await tab.value("document.getElementById('record').disabled")  # driving and recording are locked
            await tab.until("document.querySelectorAll('#plan li[data-state=past]').length > 3")
            await tab.screenshot(pictures / "moving.png")
            await page.answered("done")
            assert page.status["time"] > before + 1.0
            assert page.clicks <= MOST_CLICKS
            assert tab.complaints == []

            await page.click("#look")  # what was learned can be looked through
            await tab.until("document.getElementById('knowledge').open")
            assert "cube" in await tab.value("document.getElementById('learned').textContent")
            await page.click("#tab-actions")
            assert await tab.value("document.querySelectorAll('#learned svg').length") == 1
            assert await problems(tab) == []
            await tab.screenshot(pictures / "knowledge.png")
            await page.click("#close-knowledge")
            assert tab.complaints == []

    asyncio.run(test())
    (path,) = (tmp_path / "demos").glob("*.mcap")
    assert load_demo(path).utterances == ("put the red cube on the blue cube",)
    assert check_replay(path).max_error == 0.0
    assert Knowledge.load(tmp_path / "demos" / "knowledge.json").demos == 1


def test_a_demo_is_learned_once_however_often_that_is_asked(tmp_path: Path) -> None:
    twice = "(e => { e.click(); e.click(); })(document.getElementById('%s'))"

    async def lessons() -> None:
        scene = board_scene(tmp_path, ((3, 3, 0), "red", "cube"), ((4, 2, 0), "blue", "cube"))
        async with visit(scene, tmp_path / "demos") as page:
            tab, driver = page.tab, Driver(page, "arm", 0.3)
            await page.click("#record")
            await page.in_mode("recording")
            start = cell_centre(3, 3, 0)
            await driver.go(start + UP, near=0.006)
            await driver.go(start)
            await driver.grip(True)
            await driver.go(start + UP, near=0.02)
            await page.click("#stop-deck")
            await page.in_mode("review")
            await page.click("#sentence")
            await tab.type("take the red cube")
            await tab.value(twice % "learn")
            await page.learned()
            assert await tab.value("document.getElementById('answer').hidden")  # nobody is told off for a double click
            await tab.value("location.reload()")  # and again after a reload
            await tab.until("document.body?.dataset.control === 'yours' && !document.getElementById('dock').hidden")
            await page.click("#learn-demo")
            await tab.until("document.getElementById('lesson').textContent.includes('was learned before')")
            assert tab.complaints == []

    asyncio.run(lessons())
    assert Knowledge.load(tmp_path / "demos" / "knowledge.json").demos == 1


def test_what_is_mistyped_is_taken_asked_or_shown(tmp_path: Path, knowledge_file: str) -> None:
    async def test() -> None:
        scene = board_scene(tmp_path, ((2, 2, 0), "red", "cube"), ((6, 6, 0), "blue", "cube"))
        known = Knowledge.load(knowledge_file)
        known.language.grounding.add("glue", Concept("shape", 1), 50.0)
        path = tmp_path / "known.json"
        known.save(path)
        async with visit(scene, tmp_path / "demos", path) as page:
            tab = page.tab
            await command(page, "take the bleu cube")
            assert "I take “bleu” as “blue”. Enter" in await page.answered("planned")
            words = "[...document.querySelectorAll('#said .word')].map(e => [e.firstChild.textContent, e.dataset.kind])"
            assert ["bleu", "colour"] in await tab.value(words)
            await tab.screenshot(pictures_in(tmp_path, "mistyped") / "taken.png")

            await page.click("#control")  # given back: who says something takes it again
            await tab.until("document.body.dataset.control === 'watching'")
            await command(page, "take the clue cube")
            assert "perhaps you mean “blue” or “glue”" in await page.answered("unknown-word")
            assert await problems(tab) == []
            await tab.screenshot(pictures_in(tmp_path, "mistyped") / "asked.png")
            await page.click("#spelling-1")
            await page.answered("planned")
            assert await tab.value("document.getElementById('command').value") == "take the blue cube"
            await page.click("#command")
            await page.enter()
            await page.answered("done")
            assert page.status["held"] == 1
            assert tab.complaints == []

    asyncio.run(test())


def test_referents_are_ringed_questions_answered_and_deeds_stopped_undone_and_marked(
    tmp_path: Path, knowledge_file: str
) -> None:
    async def test() -> None:
        scene = board_scene(
            tmp_path, ((2, 2, 0), "red", "cube"), ((5, 3, 0), "red", "cube"), ((6, 6, 0), "blue", "cube")
        )
        known = tmp_path / "known.json"
        shutil.copy(knowledge_file, known)
        async with visit(scene, tmp_path / "demos", known) as page:
            tab = page.tab
            await command(page, "take the blue cube")
            await page.answered("planned")
            await ringed(page, "entity", 1)
            picture = tmp_path / "ring.png"
            await tab.screenshot(picture)
            ((_, label, middle),) = await rings(page)
            assert label == "blue cube"
            red, green, blue = colour_at(picture, middle)
            assert blue > 1.5 * max(red, green)  # the ring is around the blue cube in the picture
            kinds = await tab.value("[...document.querySelectorAll('#said .word')].map(e => e.dataset.kind)")
            assert kinds == ["action", "function", "colour", "shape"]

            await command(page, "take the red cube")
            asked = await page.answered("ambiguous")
            assert "which one" in asked
            await ringed(page, "option", 2)
            assert await problems(tab) == []
            await page.click("#option-2")
            await page.answered("planned")
            await page.click("#go")
            await page.answered("done")
            assert page.status["held"] == 1
            await page.click("#undo")
            await page.answered("undone")
            await page.until(lambda: page.status["held"] is None)

            await command(page, "put the blue cube on the turquoise cube")
            assert "turquoise" in await page.answered("unknown-word")
            await page.click("#show-it")  # opens a recording with that sentence
            await page.in_mode("recording")
            assert page.status["deck"]["sentences"] == 1
            await page.click("#discard")
            await page.in_mode("idle")

            await command(page, "take the blue cube")
            await page.answered("planned")
            await page.enter()
            await page.answered("moving")
            await page.until(lambda: page.status["asked"] is not None and page.status["lent"])
            await asyncio.sleep(0.8)
            await page.click("#halt")
            assert "stopped" in await page.answered("stopped")
            await page.until(lambda: not page.status["moving"])
            still = page.status["tools"]["arm"]["position"]
            await asyncio.sleep(0.5)
            assert np.allclose(page.status["tools"]["arm"]["position"], still, atol=1e-4)
            assert page.status["stopped"] and await problems(tab) == []
            await asyncio.sleep(0.8)  # a stop that is pressed twice is not released by that
            place = "(e => [e.getBoundingClientRect().x, e.getBoundingClientRect().y])(document.querySelector('#undo'))"
            before = await tab.value(place)
            await page.click("#go-on")
            await page.until(lambda: not page.status["stopped"])
            await tab.until("!document.querySelector('#go-on')")
            assert await tab.value(place) == before  # a second click there presses nothing
            await page.click("#undo")
            await page.answered("undone")

            await command(page, "take the blue cube")
            await page.answered("planned")
            await page.enter()
            await page.answered("done")
            await page.click("#wrong")
            assert "trust these words less" in await page.answered("undone")
            await page.until(lambda: page.status["held"] is None)
            assert tab.complaints == []

    asyncio.run(test())


async def command(page: Visit, text: str) -> None:
    """Type a command and press Enter, with the keyboard alone."""
    await page.tab.value("document.getElementById('view').focus()")
    for kind in ("keyDown", "keyUp"):
        await page.tab.key(kind, "/", "Slash")
    await page.tab.until("document.activeElement.id === 'command'")
    await page.tab.value("document.getElementById('command').value = ''")
    await page.tab.type(text)
    await page.enter()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_fits_a_phone_and_has_no_serious_problem_there(tmp_path: Path, knowledge_file: str, scheme: str) -> None:
    async def test() -> None:
        scene = board_scene(tmp_path, ((2, 2, 0), "red", "cube"), ((6, 6, 0), "blue", "cube"))
        async with visit(scene, tmp_path / "demos", Path(knowledge_file), size=(390, 844)) as page:
            tab = page.tab
            features = [
                {"name": "prefers-color-scheme", "value": scheme},
                {"name": "prefers-reduced-motion", "value": "reduce"},
            ]
            await tab.send("Emulation.setEmulatedMedia", features=features)
            await command(page, "put the red cube on the blue cube")
            await page.answered("planned")
            assert await tab.value("document.documentElement.scrollWidth <= innerWidth")
            assert await tab.value("document.getAnimations().length") == 0
            middle = "(b => document.elementFromPoint(b.x + b.width / 2, b.y + b.height / 2).id)"
            box = "(document.getElementById('command').getBoundingClientRect())"
            assert await tab.value(middle + box) == "command"  # the picture does not cover what is typed
            assert await problems(tab) == []
            await tab.screenshot(pictures_in(tmp_path, "phone") / f"{scheme}.png")
            await page.click("#record")
            await page.in_mode("recording")
            await page.click("#end-here")  # below the picture, where it is seen while the sticks are held
            await page.in_mode("review")
            assert await tab.value("document.getElementById('learn-here').offsetParent !== null")
            assert await problems(tab) == []
            await tab.screenshot(pictures_in(tmp_path, "phone") / f"review-{scheme}.png")
            await page.click("#discard")
            await page.in_mode("idle")
            await tab.value("document.getElementById('look').click()")
            await tab.until("document.getElementById('knowledge').open")
            assert await tab.value("document.documentElement.scrollWidth <= innerWidth")
            assert await problems(tab) == []
            assert tab.complaints == []

    asyncio.run(test())


def test_what_is_killed_on_the_way_loses_no_demo_and_no_knowledge(tmp_path: Path, knowledge_file: str) -> None:
    known = tmp_path / "known.json"
    shutil.copy(knowledge_file, known)
    before = known.read_bytes()

    async def test() -> None:
        scene = board_scene(tmp_path, ((2, 2, 0), "red", "cube"), ((6, 6, 0), "blue", "cube"))
        async with visit(scene, tmp_path / "demos", known) as page:
            tab, driver = page.tab, Driver(page, "arm", 0.3)
            await page.click("#record")
            await page.in_mode("recording")
            await driver.go(driver.place + [0.05, 0.0, 0.0], near=0.02)
            await page.click("#stop-deck")
            await page.in_mode("review")
            await page.click("#keep")
            await page.in_mode("idle")
            await command(page, "take the blue cube")
            await page.answered("planned")
            await page.enter()
            await page.answered("moving")
            os.kill(page.loop_pid, signal.SIGKILL)
            await tab.until("document.getElementById('link').dataset.tone === 'bad'")

    with contextlib.suppress(TeleopError):  # the server ends with its loop, and says so
        asyncio.run(test())
    assert known.read_bytes() == before
    (demo,) = (tmp_path / "demos").glob("*.mcap")
    assert check_replay(demo).max_error == 0.0
    with locked(known):  # no lock is left behind
        assert Knowledge.load(known).demos == 50
