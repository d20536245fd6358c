"""The control loop: 240 steps a second in a process of its own, so that no page, picture or network delays it.

It takes input and wishes from the server through a `Channel`, and gives states and poses back without ever waiting.
Input that gets older than `MAX_AGE`, by the clock or in simulated time, is not followed: the robot brakes, and moves
again only after the sticks were let go.
"""

import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal

import orjson

from robots.errors import ShowtellError
from twin.world import World

from .drive_command import MAX_AGE
from .errors import TeleopError
from .gamepad import RESTING, GamepadState
from .input_age import InputAge
from .loop_channel import PIECE, Channel, ChannelClosedError
from .loop_deck import Deck
from .loop_driver import DriveReport, OperatorInput, controls_of
from .loop_extension import LentStopError, LoopExtension, MakeExtension
from .loop_pace import Pace
from .loop_view import SceneStream
from .mapping_file import read_mapping_file

POSES_EVERY = 8
"""Control steps between two views of the world: 30 Hz."""
STATUS_EVERY = 24
"""Control steps between two states of affairs, at the latest: 10 Hz."""
NO_OPERATOR = "nobody holds control"
SILENT = "the page is silent"
_KEPT_NOTICES = 6
_KEPT_LATENCIES = 4000


class ControlLoop:
    """Steps a deck in real time and talks to the server. Satisfies `Desk`.

    Attributes:
        deck: What is driven, recorded and replayed.
    """

    def __init__(self, deck: Deck, channel: Channel, make_extension: MakeExtension | None = None) -> None:
        """Send the geometry; nothing moves yet."""
        self.deck = deck
        self._channel = channel
        self._pace = Pace(deck.world.DT)
        self._age = InputAge(deck.world.DT)
        self._steps = 0
        self._input: dict[str, Any] | None = None
        self._gamepad = RESTING
        self._fresh = False
        self._lost = NO_OPERATOR
        self._notices: deque[tuple[int, str, str]] = deque(maxlen=_KEPT_NOTICES)
        self._noticed = 0
        self._latencies: deque[float] = deque(maxlen=_KEPT_LATENCIES)
        self._shown: tuple[object, ...] = ()
        self._report = DriveReport("stopped", self._lost)
        self._mode, self._demos = deck.mode, deck.demos()
        self._lent = ""
        self._stop_lent = ""
        self._extension: LoopExtension | None = None if make_extension is None else make_extension(self)
        self._show_world()

    def run(self) -> None:
        """Go on until the server goes away.

        Raises:
            ChannelClosedError: It went away.
        """
        self._pace.restart()
        while True:
            self.step()
            self._pace.wait()

    def step(self) -> None:
        """One control step: read, move, tell."""
        while messages := self._channel.receive():  # again after a scene was set up: what came meanwhile is newer
            for message in messages:
                self._take(orjson.loads(message))
        wish = self._wish(time.monotonic())
        try:
            self._report, told = self.deck.step(wish)
        except ShowtellError as error:
            self._notice("error", str(error))
        else:
            if self._fresh and self._input is not None:
                self._latencies.append(time.time() - self._input["stamp"])
            if told:
                self._deck_changed("info", told)
            for event in self.deck.driver.mapping.take_events():
                self._button(event.name)
        self._fresh = False
        self._show()
        if self._extension is not None:
            try:
                self._extension.step()
            except ChannelClosedError:
                raise
            except (ShowtellError, OSError) as error:
                self._notice("error", str(error))

    def close(self) -> None:
        """End what was added to the loop."""
        if self._extension is not None:
            self._extension.close()

    # What an extension may ask for

    @contextmanager
    def lend(self, why: str) -> Iterator[World]:
        """Give the world away; see `Desk`."""
        deck = self.deck
        if deck.mode != "idle":
            raise TeleopError(f"not now: {'keep or discard the demo first' if deck.mode == 'review' else deck.mode}")
        if deck.driver.mapping.state.stopped:
            raise TeleopError("the robot is stopped: release the stop first")
        world = deck.world
        self._lent, self._stop_lent = why, ""
        self._report = DriveReport("ok", why, moving=True)
        self._show(at_once=True)
        self._pace.restart()
        world.on_step = self._lent_step
        try:
            yield world
        finally:
            world.on_step = None
            self._lent = ""
            deck.driver.take_over()
            self._pace.restart()

    def tell(self, kind: Literal["T", "K"], message: Mapping[str, object]) -> bool:
        """Tell all pages something; see `Desk`."""
        told = kind.encode() + orjson.dumps(message)
        if kind == "T" and len(told) < PIECE:
            return self._channel.send(told)
        self._channel.send_surely(told)
        return True

    def notice(self, level: Literal["info", "warning", "error"], text: str) -> None:
        """Add a line to what happened."""
        self._notice(level, text)

    def keep(self) -> Path:
        """Keep the demo that waits; see `Desk`."""
        path, told = self.deck.last, self.deck.keep()
        assert path is not None  # a demo that is kept has a file
        self._deck_changed("info", told)
        return path

    def _lent_step(self) -> None:
        """What goes on before every step that somebody else makes of the world."""
        for data in self._channel.receive():
            message = orjson.loads(data)
            if message["type"] in ("do", "talk"):
                self._notice("warning", f"{self._lent}: stop it first")
            elif message["type"] != "release":
                self._take(message)
            if message["type"] in ("stop", "lost"):
                self._stop_lent = message.get("reason", "it was stopped")
        self._fresh = False
        if self._stop_lent:
            raise LentStopError(self._stop_lent)
        self._show()
        self._pace.wait()

    def _show(self, *, at_once: bool = False) -> None:
        """Tell how things stand, as often as that makes sense."""
        self._steps += 1
        if self._steps % POSES_EVERY == 0:
            self._channel.send(self._stream.poses())
        shown = (
            self._report.state,
            self._report.reason,
            self.deck.mode,
            self._noticed,
            self.deck.driver.mapping.state.stopped,
            self._lent,
        )
        if at_once or self._steps % STATUS_EVERY == 0 or shown != self._shown:
            self._shown = shown
            self._channel.send(b"J" + orjson.dumps(self._status()))

    def _take(self, message: dict[str, Any]) -> None:
        """Do what a message of the server says."""
        kind = message["type"]
        if kind == "input":
            self._gamepad = GamepadState(tuple(message["axes"]), tuple(message["buttons"]))
            self._input, self._fresh, self._lost = message, True, ""
        elif kind == "lost":
            if self._input is not None:
                self._notice("warning", f"{message['reason']}: the robot stops")
            self._lost, self._input, self._gamepad = message["reason"], None, RESTING
        elif kind in ("stop", "release"):
            mapping = self.deck.driver.mapping
            mapping.stop() if kind == "stop" else mapping.release()
        elif kind == "set":
            self._set(message)
        elif kind == "do":
            self._do(message)
        elif kind == "talk":
            if self._extension is None:
                self._notice("error", "nobody listens here: this page only drives, records and replays")
            else:
                self._extension.hear(message)

    def _wish(self, now: float) -> OperatorInput:
        """What the operator wants, or why that is not known."""
        last = self._input
        if last is None:
            return OperatorInput(fault=self._lost or NO_OPERATOR, arrived=False)
        age, arrived = self._age.of(last["received"] - last["late"], now)
        fault = ""
        if self._age.is_lost(age):
            fault = SILENT
            if self._lost != SILENT:
                self._lost = SILENT
                self._notice("warning", f"{SILENT} for {1000 * MAX_AGE:.0f} ms: the robot stops")
        camera = last.get("camera")
        return OperatorInput(
            self._gamepad, last["enabled"], age, fault, arrived, None if camera is None else tuple(camera)
        )

    def _set(self, message: dict[str, Any]) -> None:
        """Choose an arm or a speed."""
        driver = self.deck.driver
        try:
            if message["arm"] is not None:
                driver.choose(message["arm"])
            if message["speed"] is not None:
                driver.mapping.set_speed(message["speed"])
        except ShowtellError as error:
            self._notice("error", str(error))

    def _do(self, message: dict[str, Any]) -> None:
        """A button of the deck."""
        deck = self.deck
        actions: dict[str, Callable[[], str]] = {
            "record": deck.record,
            "stop": deck.stop,
            "keep": deck.keep,
            "success": lambda: deck.label("success"),
            "failure": lambda: deck.label("failure"),
            "discard": deck.discard,
            "redo": deck.redo,
            "describe": lambda: deck.describe(message["text"]),
            "replay": lambda: deck.replay(message["demo"]),
            "reset": lambda: deck.renew(another=False),
            "another": lambda: deck.renew(another=True),
        }
        self._try(actions[message["action"]])

    def _try(self, action: Callable[[], str]) -> None:
        """Do something with the deck and tell how it went."""
        try:
            level, told = "info", action()
        except (ShowtellError, OSError) as error:
            level, told = "error", str(error)
        if told:
            self._deck_changed(level, told)

    def _button(self, event: str) -> None:
        """A button of the gamepad that is meant for the deck: what it does depends on what is on."""
        self._try(lambda: self.deck.press(event))

    def _deck_changed(self, level: str, told: str) -> None:
        if self.deck.mode != self._mode:  # only then the list may be another one, and to look takes time
            self._mode, self._demos = self.deck.mode, self.deck.demos()
        self._notice(level, told)
        if self.deck.changes != self._stream.number:
            self._report = DriveReport("stopped", "the scene starts")
            self._show_world()
            self._pace.restart()

    def _show_world(self) -> None:
        """Send the geometry of the world that is on now."""
        self._stream = SceneStream(self.deck.world, self.deck.changes)
        self._channel.send_surely(b"J" + orjson.dumps(self._status()))
        self._channel.send_surely(b"S" + orjson.dumps(self._setup()))
        self._channel.send_surely(self._stream.geometry())
        self._channel.send(self._stream.poses())

    def _notice(self, level: str, text: str) -> None:
        self._noticed += 1
        self._notices.append((self._noticed, level, " ".join(text.split())[:400]))

    def _setup(self) -> dict[str, Any]:
        """What stays the same as long as the world is on."""
        driver, keyboard = self.deck.driver, read_mapping_file().keyboard
        return {
            "type": "setup",
            "robot": self.deck.world.robot.name,
            "choices": driver.choices,
            "controls": controls_of(driver.mapping),
            "keys": keyboard.keys,
            "slow": keyboard.slow,
            "talks": self._extension is not None,
        }

    def _status(self) -> dict[str, Any]:
        """The state of affairs, whole: one that is lost on the way is made good by the next."""
        report, deck, driver, world = self._report, self.deck, self.deck.driver, self.deck.world
        state = world.state()
        typical, latest = self._pace.lateness()
        return {
            "type": "status",
            "time": state.time,
            "chosen": driver.chosen,
            "speed": driver.mapping.state.speed_ratio,
            "manner": driver.manner,
            "state": report.state,
            "reason": report.reason,
            "asked": report.asked,
            "executed": report.executed,
            "moving": report.moving,
            "stopped": driver.mapping.state.stopped,
            "tools": {
                name: {"position": each.pose_tool_in_world.position.tolist(), "opening": each.gripper_opening}
                for name, each in zip(world.robot.arms, state.arms, strict=True)
            },
            "q": state.q.tolist(),
            "held": state.held,
            "deck": deck.progress(),
            "demos": self._demos,
            "lent": self._lent,
            "notices": list(self._notices),
            "latency": _quantiles(self._latencies),
            "late_ms": [1000 * typical, 1000 * latest],
            "given_up": self._pace.given_up,
            "world": self._stream.number,
        }


def _quantiles(values: deque[float]) -> dict[str, float] | None:
    """Median and 99th percentile of latencies [ms]; None before there are any."""
    if not values:
        return None
    ordered = sorted(values)
    at = [ordered[min(int(share * len(ordered)), len(ordered) - 1)] for share in (0.5, 0.99)]
    return {"median_ms": 1000 * at[0], "p99_ms": 1000 * at[1], "count": len(ordered)}
