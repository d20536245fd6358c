"""Loading PyBullet without the line that it prints from C: stderr is for progress and one-line errors."""

import os
import sys


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
