"""Starting the control loop in a process of its own, and ending it.

The loop's libraries load in that process alone.
"""

import gc
import multiprocessing
import os
import signal
import socket
from dataclasses import dataclass
from multiprocessing.process import BaseProcess
from pathlib import Path

import orjson

from robots.errors import ShowtellError

from .errors import TeleopError
from .loop_channel import Channel, ChannelClosedError


@dataclass(frozen=True, slots=True)
class LoopSettings:
    """What a control loop is started with.

    Attributes:
        scene: Name of a scene or path of a TOML file.
        robot: Robot instead of the scene's own, or None.
        seed: Decides a random scene.
        folder: Where demos are.
    """

    scene: str
    robot: str | None
    seed: int
    folder: Path


def start_loop(settings: LoopSettings) -> tuple[BaseProcess, Channel]:
    """Start the control loop in a process of its own; its first message says whether it runs.

    The process ends when the channel is closed.
    """
    ours, theirs = Channel.pair()
    context = multiprocessing.get_context("spawn")
    process = context.Process(target=run_loop, args=(settings, theirs), name="showtell-control", daemon=True)
    process.start()
    theirs.close()
    return process, ours


def run_loop(settings: LoopSettings, sock: socket.socket) -> None:
    """Run until the server goes away (the process's entry point)."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the server, which ends us in order
    channel = Channel(sock)
    _load_physics()
    from .loop import ControlLoop
    from .loop_deck import Deck

    try:
        deck = Deck(settings.scene, settings.robot, settings.seed, settings.folder)
    except (ShowtellError, OSError) as error:
        channel.send(b"J" + orjson.dumps({"type": "failed", "message": str(error)}))
        return
    loop = ControlLoop(deck, channel)
    gc.collect()
    gc.freeze()  # what is here stays: later collections need not look at it
    try:
        loop.run()
    except ChannelClosedError:
        pass
    finally:
        deck.close()
        channel.close()
        gc.unfreeze()


def check_started(message: bytes) -> None:
    """Look at the loop's first message.

    Raises:
        TeleopError: It could not start; says why.
    """
    if message[:1] == b"J" and (told := orjson.loads(message[1:]))["type"] == "failed":
        raise TeleopError(told["message"])


def _load_physics() -> None:
    """Load PyBullet without the line that it prints from C; stdout is left to the server from here on."""
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 1)
        os.dup2(nowhere, 2)
        import twin.world  # noqa: F401
    finally:
        os.dup2(kept, 2)
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)
