"""A control loop that lends its world: driving is locked, stopping works at every step, what moves is braked."""

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import orjson
import pytest

from teleop.errors import TeleopError
from teleop.gamepad import BUTTONS
from teleop.loop import ControlLoop
from teleop.loop_channel import Channel
from teleop.loop_deck import Deck
from teleop.loop_extension import Desk, LentStopError, load_extension
from twin.state import JointCommand
from twin.world import World

FAST = 0.4
"""Speed of the turning joint [rad/s]."""


class Turner:
    """Turns the first joint when somebody talks to it."""

    def __init__(self, desk: Desk, options: dict[str, str]) -> None:
        self.desk, self.steps = desk, int(options["steps"])
        self.talked: list[dict[str, Any]] = []
        self.stopped = ""
        self.half_way: Callable[[], None] = lambda: None
        self.turned: World | None = None

    def hear(self, message: dict[str, Any]) -> None:
        self.talked.append(message)

    def step(self) -> None:
        if not self.talked:
            return
        self.talked.pop()
        try:
            with self.desk.lend("turning") as world:
                self.turned = world
                velocity = np.zeros(3)
                for number in range(self.steps):
                    if number == self.steps // 2:
                        self.half_way()
                    velocity[0] = min(FAST, 0.02 * number)  # within its acceleration
                    world.step(JointCommand(velocity, world.commanded_openings[0]))
        except LentStopError as stop:
            self.stopped = str(stop)

    def close(self) -> None:
        self.desk.notice("info", "closed")


class Server:
    """The other end of the loop's channel."""

    def __init__(self, channel: Channel) -> None:
        self.channel = channel

    def say(self, **message: object) -> None:
        assert self.channel.send(orjson.dumps(message))

    def statuses(self) -> list[dict[str, Any]]:
        told = [message for message in self.channel.receive() if message[:1] == b"J"]
        return [orjson.loads(message[1:]) for message in told]


@pytest.fixture
def desk(tmp_path: Path) -> Iterator[tuple[ControlLoop, Turner, Server]]:
    theirs, ours = Channel.pair()
    deck = Deck("board", None, 3, tmp_path)
    made: list[Turner] = []

    def make(desk: Desk) -> Turner:
        made.append(Turner(desk, {"steps": "60"}))
        return made[0]

    loop = ControlLoop(deck, Channel(ours), make)
    try:
        yield loop, made[0], Server(theirs)
    finally:
        deck.close()
        theirs.close()


def pushed(server: Server) -> None:
    now = time.monotonic()
    server.say(
        type="input",
        axes=[0.0, -1.0, 0.0, 0.0],
        buttons=[0.0] * len(BUTTONS),
        enabled=True,
        camera=None,
        received=now,
        late=0.0,
        stamp=time.time(),
    )


def test_who_borrows_the_world_moves_the_robot_and_driving_is_locked(
    desk: tuple[ControlLoop, Turner, Server],
) -> None:
    loop, turner, server = desk
    server.say(type="talk", action="do", text="turn", choice=None, demo="")
    before = loop.deck.world.joint_positions[0]
    loop.step()
    assert turner.turned is loop.deck.world and not turner.stopped
    assert loop.deck.world.joint_positions[0] - before > 0.05
    assert any(status["lent"] == "turning" for status in server.statuses())

    def interfere() -> None:
        pushed(server)  # the sticks say nothing meanwhile,
        server.say(type="do", action="record", text="", demo="")  # and nothing is recorded

    turner.half_way = interfere
    turner.talked.append({})
    tool = loop.deck.world.state().pose_tool_in_world.position[2]
    loop.step()
    assert loop.deck.mode == "idle"
    assert abs(loop.deck.world.state().pose_tool_in_world.position[2] - tool) < 0.002
    loop.step()
    notices = server.statuses()[-1]["notices"]
    assert any("turning: stop it first" in text for _, _, text in notices)


def test_a_stop_ends_what_moves_and_it_is_braked_within_limits(desk: tuple[ControlLoop, Turner, Server]) -> None:
    loop, turner, server = desk
    turner.talked.append({})
    world = loop.deck.world
    turner.half_way = lambda: server.say(type="stop")
    loop.step()
    assert turner.stopped == "it was stopped"
    assert loop.deck.driver.mapping.state.stopped
    assert world.on_step is None
    rates = [world.commanded_positions]
    for _ in range(240):
        loop.step()
        rates.append(world.commanded_positions)
    speed = np.diff(np.array(rates), axis=0) / world.DT
    assert abs(speed[0, 0]) > 0.5 * FAST  # it does not stand at once,
    limits = world.robot.acceleration * world.DT
    assert (np.abs(np.diff(speed, axis=0)) <= 1.05 * limits + 1e-9).all()  # is braked as the robot may be,
    assert np.abs(speed[-1]).max() < 1e-6  # and stands in the end
    server.say(type="talk", action="do", text="", choice=None, demo="")
    loop.step()
    assert any("release the stop first" in text for _, _, text in _notices(loop, server))


def _notices(loop: ControlLoop, server: Server) -> list[tuple[int, str, str]]:
    loop.step()
    return list(server.statuses()[-1]["notices"])


def test_nothing_is_lent_while_a_demo_is_recorded(desk: tuple[ControlLoop, Turner, Server]) -> None:
    loop, turner, server = desk
    loop.deck.record()
    with pytest.raises(TeleopError, match="not now: recording"), loop.lend("turning"):
        pass
    loop.deck.discard()


def test_an_extension_that_does_not_exist_is_named() -> None:
    with pytest.raises(TeleopError, match="the extension 'teleop.nothing:make' cannot be loaded: .*give `module:name`"):
        load_extension("teleop.nothing:make", {})
    with pytest.raises(TeleopError, match="cannot be loaded: .*has no attribute 'nothing'"):
        load_extension("teleop.errors:nothing", {})
