"""Telling a robot at a table through the control loop, in physics and without a browser: stops, lessons, new scenes."""

import contextlib
import select
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import orjson
import pytest

from executor import Executor
from executor.execution.answer import Answer
from executor.tables.table_doer import TableDoer
from executor.talk.talk import LISTEN_EVERY, REST, Talk
from learning import Knowledge
from teleop.loop import ControlLoop
from teleop.loop_channel import Channel, ChannelClosedError
from teleop.loop_deck import Deck
from teleop.loop_extension import Desk
from tests.executor.table_cases import knowledge_of
from twin import WorldState

FAR = """
name = "ordering"
kind = "table"
robot = "mico_segway"
objects = [{id = 0, model = "small_blue_carton", position = [0.60, 0.45, 0.05]}]
"""
"""Where the arm reaches only after the base has rolled."""
ROLLING = 0.05
"""A base that is so fast rolls [m/s]."""
STANDS = 0.002
"""One that is no faster stands [m/s]."""


class Table:
    """A Mico at its counter, its control loop, and what a page would send."""

    def __init__(self, folder: Path) -> None:
        scene = folder / "scene.toml"
        scene.write_text(FAR, encoding="utf-8")
        self.page, ours = Channel.pair()
        self._reader = threading.Thread(target=self._read)
        self._reader.start()
        self.deck = Deck(str(scene), None, 3, folder / "demos")
        made: list[Talk] = []

        def make(desk: Desk) -> Talk:
            made.append(Talk(desk, knowledge_of("mico_segway"), 0))
            return made[0]

        self.loop = ControlLoop(self.deck, Channel(ours), make)
        (self.talk,) = made
        self.on_lent_step: Callable[[], None] = lambda: None
        step = self.loop._lent_step

        def lent_step() -> None:
            self.on_lent_step()
            step()

        vars(self.loop)["_lent_step"] = lent_step

    def close(self) -> None:
        self.loop.close()
        self.deck.close()
        self.loop._channel.close()  # the reader ends with it
        self._reader.join()
        self.page.close()

    def _read(self) -> None:
        """What a page does with all that it is told, here: nothing."""
        with contextlib.suppress(ChannelClosedError):
            while True:
                select.select([self.page], [], [])
                self.page.receive()

    def say(self, **message: object) -> None:
        assert self.page.send(orjson.dumps(message))

    def tell(self, action: str, text: str = "") -> None:
        """Say something to the robot, and give it the time that it takes."""
        self.say(type="talk", action=action, text=text, choice=None, demo="")
        self.go_on(2)

    def go_on(self, steps: int) -> None:
        """Let the loop go on."""
        for _ in range(steps):
            self.loop.step()

    @property
    def state(self) -> WorldState:
        return self.deck.world.state()

    @property
    def place(self) -> np.ndarray:
        return np.array(self.deck.world.base_pose.position)


@pytest.fixture
def table(tmp_path: Path) -> Iterator[Table]:
    made = Table(tmp_path)
    try:
        yield made
    finally:
        made.close()


def test_a_base_that_is_stopped_as_it_rolls_stands_soon_and_the_next_command_is_done(table: Table) -> None:
    world = table.deck.world
    start, carton = table.place, table.state.objects[0].pose_object_in_world.position
    places: list[np.ndarray] = [start]
    pressed: list[float] = []

    def press() -> None:
        places.append(table.place)
        if not pressed and np.linalg.norm(places[-1] - places[-2]) / world.DT > ROLLING:
            pressed.append(world.time)
            table.say(type="stop")

    table.on_lent_step = press
    table.tell("do", "lift the carton")
    assert pressed, "the base never rolled"
    answer = table.talk.state.answer
    assert answer is not None and answer.kind == "stopped"
    assert world.time < pressed[0] + 0.05
    speeds = [float(np.linalg.norm(places[-1] - places[-2]) / world.DT)]
    for _ in range(240):
        before = table.place
        table.go_on(1)
        speeds.append(float(np.linalg.norm(table.place - before) / world.DT))
    assert max(speeds[120:]) < STANDS, "half a second is enough"
    drive = world.robot.drive
    assert drive is not None
    assert max(a - b for a, b in zip(speeds, speeds[1:], strict=False)) / world.DT < 3 * drive.acceleration
    assert np.linalg.norm(table.place - start) > 0.002
    assert np.abs(table.state.dq).max() < 0.01 and table.state.held is None
    assert np.linalg.norm(table.state.objects[0].pose_object_in_world.position - carton) < 0.002

    table.on_lent_step = lambda: None
    table.say(type="release")
    table.go_on(2)
    table.tell("do", "lift the carton")
    answer = table.talk.state.answer
    assert answer is not None and answer.kind == "done", answer
    assert table.state.held == 0
    table.tell("undo")  # to before the second command,
    assert table.state.held is None and np.linalg.norm(table.place - start) > 0.002
    table.tell("undo")  # and before the first
    assert np.linalg.norm(table.place - start) < 0.002


def test_a_scene_is_looked_at_before_the_first_command_and_whenever_it_is_another(table: Table) -> None:
    def eye() -> object:
        assert table.talk._executor is not None
        doer = table.talk._executor.doer
        assert isinstance(doer, TableDoer)
        return doer._eye

    first = eye()
    assert first is not None and table.deck.world.time == 0.0
    table.say(type="do", action="reset", text="", demo="")
    table.go_on(LISTEN_EVERY)
    assert eye() is None  # another world: nothing of the old one holds,
    table.go_on((REST + 2) * LISTEN_EVERY)
    second = eye()
    assert second is not None and second is not first  # and it is looked at while nobody drives


def test_who_knows_more_goes_on_with_what_was_seen(table: Table) -> None:
    before = table.talk._executor
    assert before is not None
    table.tell("read", "lift the carton")
    seen, numbers = before.doer.look(), before.doer.look().numbers
    after = Executor(table.deck.world, Knowledge.load(knowledge_of("mico_segway")))
    after.go_on_from(before)
    assert after.history is before.history
    assert after.doer.look() is seen and after.doer.look().numbers == numbers
    report = after.preview("lift the carton")
    assert report.answer is Answer.PLANNED and report.goals[0].object_id in numbers
    after.doer.close()
