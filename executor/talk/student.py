"""Learning in a process of its own: a demo takes up to a few seconds, in which driving must go on.

The knowledge file is the only thing that both sides share. It is locked while a demo is learned, and replaced as a
whole, so that a process that is killed meanwhile loses nothing that was learned before.
"""

import os
import select
import socket
import subprocess
import sys
import traceback
from hashlib import sha256
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import orjson

from robots.errors import ShowtellError
from teleop.loop_channel import Channel, ChannelClosedError

if TYPE_CHECKING:
    from learning import Knowledge
    from learning.learner import Lesson

FINGERPRINT = 12
"""Hexadecimal digits by which a demo is known again."""
POLITENESS = 2
"""How much the process gives way to the control loop (nice)."""
_EARLY = (
    "executor.demo_files",
    "executor.talk.told_knowledge",
    "learning.learner",
    "learning.perception.camera_observation",
    "teleop.demo_reader",
)
"""What takes long to load is loaded before the first demo comes."""


class Student:
    """The other process, as seen from the control loop."""

    def __init__(self, knowledge: Path, seed: int) -> None:
        """Start it; it gets ready while others go on.

        Args:
            knowledge: File to learn into; it need not exist yet.
            seed: Seed of the noise of perception.
        """
        self._channel, theirs = Channel.pair()
        self._process = subprocess.Popen(
            [sys.executable, "-m", "executor.talk.student", str(theirs.fileno()), str(knowledge), str(seed)],
            pass_fds=[theirs.fileno()],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,  # PyBullet greets there
            env={**os.environ, "PYTHONPATH": os.pathsep.join(path or os.getcwd() for path in sys.path)},
        )
        theirs.close()

    @property
    def pid(self) -> int:
        """Id of the process."""
        return self._process.pid

    def learn(self, demo: Path) -> None:
        """Have a demo learned; `answers` brings what came of it."""
        self._channel.send_surely(orjson.dumps({"learn": str(demo)}))

    def tell(self) -> None:
        """Have what is known told; `answers` brings it."""
        self._channel.send_surely(orjson.dumps({}))

    def answers(self) -> list[dict[str, Any]]:
        """What it has answered since this was last asked.

        Raises:
            ChannelClosedError: It ended by itself.
        """
        return [orjson.loads(message) for message in self._channel.receive()]

    def close(self) -> None:
        """End it; a demo that is just being learned is learned to its end."""
        self._channel.close()
        try:
            self._process.wait(20.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


def learn_demo(demo: Path, path: Path, seed: int) -> tuple["Knowledge", "Lesson | None"]:
    """Learn one demo into a knowledge file, once; nobody else changes it meanwhile.

    Args:
        demo: The demo.
        path: The file; made if it does not exist.
        seed: Seed of the noise of perception.

    Returns:
        What is known then, and what was learned: None where the same demo was learned before.

    Raises:
        ShowtellError: The demo or the knowledge cannot be read, or nothing can be learned from it; says why.
    """
    from executor.demo_files import open_demo
    from executor.execution.knowledge_lock import locked
    from learning import Knowledge, Learner

    path.parent.mkdir(parents=True, exist_ok=True)
    with locked(path):
        learner = Learner(Knowledge.load(path) if path.exists() else None, seed=seed)
        fingerprint = sha256(demo.read_bytes()).hexdigest()[:FINGERPRINT]
        if fingerprint in learner.knowledge.lessons:
            return learner.knowledge, None
        lesson = learner.observe(open_demo(demo))
        learner.settle()
        learner.knowledge.lessons.append(fingerprint)
        learner.knowledge.save(path)
    return learner.knowledge, lesson


def main(number: int, path: Path, seed: int) -> None:
    """Answer requests until the control loop goes away (the process's entry point).

    Args:
        number: Descriptor of the socket.
        path: Knowledge file.
        seed: Seed of the noise of perception.
    """
    os.nice(POLITENESS)
    channel = Channel(socket.socket(fileno=number))
    for name in _EARLY:
        import_module(name)
    from learning import Knowledge

    try:
        while True:
            select.select([channel], [], [])
            for message in channel.receive():
                channel.send_surely(orjson.dumps(_answer(orjson.loads(message), path, seed, Knowledge)))
    except ChannelClosedError:
        pass  # the usual end


def _answer(request: dict[str, str], path: Path, seed: int, kind: "type[Knowledge]") -> dict[str, object]:
    from executor.talk.told_knowledge import told_knowledge

    demo = request.get("learn")
    answer: dict[str, object] = {"demo": "" if demo is None else Path(demo).name}
    try:
        if demo is None:
            return answer | {"knowledge": told_knowledge(kind.load(path))}
        knowledge, lesson = learn_demo(Path(demo), path, seed)
        told = answer | {"knowledge": told_knowledge(knowledge)}
        return told | ({"before": True} if lesson is None else {"sentences": lesson.sentences})
    except (ShowtellError, OSError) as error:
        return answer | {"error": str(error)}
    except Exception as error:  # whatever is wrong with one demo, the next can be learned
        traceback.print_exc()
        return answer | {"error": f"{type(error).__name__}: {error}"}


if __name__ == "__main__":
    main(int(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3]))
