"""Recording a demo: an operator, a gamepad, a world, a file."""

import logging
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

from twin.scene_spec import SceneSpec
from twin.state import WorldState
from twin.world import World

from .demo import Demo
from .demo_reader import load_demo
from .errors import TeleopError
from .gamepad import GamepadState
from .gamepad_mapping import GamepadMapping
from .recorder import Recorder
from .session import Session
from .truth import truth_path, write_truth

_LOG = logging.getLogger(__name__)

INPUT_EVERY = 4
"""Control steps between two looks at the gamepad: 60 Hz, as most devices report."""
STATE_EVERY = 8
"""Control steps between two recorded states: 30 Hz."""
LONGEST = 90.0
"""A demo that takes longer is ended [s]."""


class Operator(Protocol):
    """Whoever holds the gamepad."""

    @property
    def done(self) -> bool:
        """Whether the gamepad has been put down."""

    def act(self, state: WorldState, spec: SceneSpec) -> GamepadState:
        """Look at the world and say what the gamepad says now; called at 60 Hz."""


@runtime_checkable
class Judge(Protocol):
    """An operator who says how it went."""

    @property
    def success(self) -> bool | None:
        """Whether the task is believed done; None before the end."""

    @property
    def note(self) -> str:
        """What went wrong, in plain words."""


def record_demo(
    world: World,
    operator: Operator,
    path: str | Path,
    *,
    utterances: Iterable[str] = (),
    truth: Mapping[str, Any] | None = None,
    mapping: GamepadMapping | None = None,
    longest: float = LONGEST,
) -> Demo:
    """Record one demo: the operator's gamepad drives the world through mapping and servo until it is put down.

    Args:
        world: A world in which nothing has moved yet, so that the demo can be simulated afresh.
        operator: Whoever holds the gamepad.
        path: The demo to write (`.mcap`); written as it happens.
        utterances: Sentences that describe it.
        truth: What is true of it, for scoring, written to the sidecar; None writes no sidecar and removes an old one.
        mapping: Gamepad to twist; None takes the usual one.
        longest: The demo ends after this simulated time [s] at the latest.

    Returns:
        The demo as read back from the file.

    Raises:
        TeleopError: The world has moved already.
        DemoError: The file cannot be written; what was recorded before a disk failed is kept.
    """
    if world.time != 0.0:
        raise TeleopError(
            f"a demo starts with its scene, but this world is already {world.time:.3f} s old: make a new one"
        )
    path = Path(path)
    session = Session(world, mapping)
    rate = round(1.0 / world.DT)
    with Recorder(path, world.spec, session.mapping, rate, robot=world.robot) as recorder:
        for text in utterances:
            recorder.utterance(text)
        gamepad = GamepadState()
        step, last = 0, round(longest * rate)
        while True:
            if step % INPUT_EVERY == 0:
                state = world.state()
                gamepad = operator.act(state, world.spec)
                if step % STATE_EVERY == 0:
                    recorder.state(step, state)
                    if operator.done or step >= last or recorder.failed:
                        break
            result = session.step(gamepad)
            recorder.control(step, gamepad, result, session.opening)
            step += 1
        if isinstance(operator, Judge) and operator.success is not None:
            recorder.outcome("success" if operator.success else "failure", operator.note)
    if truth is None:
        truth_path(path).unlink(missing_ok=True)
    else:
        write_truth(path, truth)
    _LOG.info("recorded %s: %.1f s", path, world.time)
    return load_demo(path)
