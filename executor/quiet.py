"""Keeping what libraries print from C out of the way: stdout is for results, stderr for progress and errors."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager


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
