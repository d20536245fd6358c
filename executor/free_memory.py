"""Memory that the C library holds free goes back to the system between commands.

Each command takes and frees pictures, clouds of points, plans and states of physics of many sizes. What is freed
between pieces that stay is kept by the C library and split up, so that a process which runs for hours would grow though
it holds no more than before.
"""

import ctypes
import functools
from collections.abc import Callable


def give_back_free_memory() -> None:
    """Give pages that nothing is kept in back to the system; does nothing where the C library cannot (macOS, musl)."""
    trim = _malloc_trim()
    if trim is not None:
        trim(0)


@functools.cache
def _malloc_trim() -> Callable[[int], int] | None:
    try:
        trim = ctypes.CDLL(None).malloc_trim
    except (OSError, AttributeError, TypeError):  # TypeError: Windows opens no library without a name
        return None
    trim.argtypes, trim.restype = (ctypes.c_size_t,), ctypes.c_int
    return trim
