"""Starting the control loop in a process of its own, and ending it.

The loop's libraries load in that process alone.
"""

import gc
import os
import select
import socket
import subprocess
import sys
from dataclasses import asdict, dataclass, field
from pathlib import Path

import orjson

from robots.errors import ShowtellError
from twin.quiet import load_physics

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
        extension: `module:name` of what makes a `LoopExtension` in the loop's process, or None.
        options: What it is made with, as plain values.
    """

    scene: str
    robot: str | None
    seed: int
    folder: Path
    extension: str | None = None
    options: dict[str, str] = field(default_factory=dict)


def start_loop(settings: LoopSettings) -> tuple[subprocess.Popen[bytes], Channel]:
    """Start the control loop in a process of its own; its first message says whether it runs.

    The process ends when the channel is closed, or when we are gone.
    """
    ours, theirs = Channel.pair()
    number = theirs.fileno()
    process = subprocess.Popen(
        [sys.executable, "-m", "teleop.loop_process", str(number)],
        pass_fds=[number],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,  # PyBullet greets there
        env={**os.environ, "PYTHONPATH": os.pathsep.join(path or os.getcwd() for path in sys.path)},
        start_new_session=True,  # Ctrl-C in the terminal is for the server, which ends us in order
    )
    theirs.close()
    ours.send_surely(orjson.dumps({**asdict(settings), "folder": str(settings.folder)}))
    return process, ours


def main(number: int) -> None:
    """Run until the server goes away (the process's entry point).

    Args:
        number: Descriptor of the socket.
    """
    channel = Channel(socket.socket(fileno=number))
    try:
        run_loop(channel)
    except ChannelClosedError:
        pass  # the usual end
    finally:
        channel.close()


def run_loop(channel: Channel) -> None:
    """Set up what the first message says, and run.

    Raises:
        ChannelClosedError: The server went away.
    """
    while not (messages := channel.receive()):
        select.select([channel], [], [])
    settings = orjson.loads(messages[0])
    load_physics()
    from .loop import ControlLoop
    from .loop_deck import Deck
    from .loop_extension import load_extension

    try:
        deck = Deck(settings["scene"], settings["robot"], settings["seed"], Path(settings["folder"]))
    except (ShowtellError, OSError) as error:
        channel.send(b"J" + orjson.dumps({"type": "failed", "message": str(error)}))
        return
    try:
        make = None if settings["extension"] is None else load_extension(settings["extension"], settings["options"])
        loop = ControlLoop(deck, channel, make)
    except ShowtellError as error:
        deck.close()
        if isinstance(error, ChannelClosedError):
            raise
        channel.send(b"J" + orjson.dumps({"type": "failed", "message": str(error)}))
        return
    try:
        gc.collect()
        gc.freeze()  # what is here stays: later collections need not look at it
        loop.run()
    finally:
        gc.unfreeze()
        loop.close()
        deck.close()


def check_started(message: bytes) -> None:
    """Look at the loop's first message.

    Raises:
        TeleopError: It could not start; says why.
    """
    if message[:1] == b"J" and (told := orjson.loads(message[1:]))["type"] == "failed":
        raise TeleopError(told["message"])


if __name__ == "__main__":
    main(int(sys.argv[1]))
