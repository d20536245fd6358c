"""Keeping what libraries print from C out of the way: stdout is for results, stderr for progress and errors."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager


def load_physics() -> None:
    """Import PyBullet, with the process's stderr turned away meanwhile; does nothing when it is imported already."""
    if "pybullet" in sys.modules:
        return
    sys.stderr.flush()
    kept = os.dup(2)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        import pybullet  # noqa: F401
    finally:
        os.dup2(kept, 2)
        os.close(nowhere)
        os.close(kept)


@contextmanager
def words_to_stderr() -> Iterator[None]:
    """Send what anything in this process prints on stdout, from C too, to stderr meanwhile."""
    sys.stdout.flush()
    kept = os.dup(1)
    try:
        os.dup2(2, 1)
        yield
    finally:
        sys.stdout.flush()
        os.dup2(kept, 1)
        os.close(kept)
