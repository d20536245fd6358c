"""One program at a time changes a knowledge file: what another has written meanwhile is not lost."""

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from learning import Knowledge


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """Keep other programs from changing a knowledge file while the body runs; waits until they are done.

    The lock is a file beside it, held by the operating system: it is free again when the program ends, however it ends.
    Readers need no lock, as a file is always replaced as a whole.
    """
    lock = path.with_name(f".{path.name}.lock")
    handle = os.open(lock, os.O_CREAT | os.O_RDWR, 0o644)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)


@contextmanager
def changing(path: Path) -> Iterator[Knowledge]:
    """Give the knowledge of a file as it is now, and save it when the body succeeds; nobody else changes it meanwhile.

    Raises:
        KnowledgeError: The file is no knowledge.
    """
    with locked(path):
        knowledge = Knowledge.load(path)
        yield knowledge
        knowledge.save(path)
