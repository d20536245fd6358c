"""What a process holds free goes back to the system."""

import ctypes
import sys

import numpy as np
import pytest

from executor.execution.evaluation.endurance import resident
from executor.free_memory import give_back_free_memory


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="/proc tells the memory of a process on Linux alone")
def test_memory_that_was_freed_between_pieces_that_stay_is_given_back() -> None:
    if not hasattr(ctypes.CDLL(None), "malloc_trim"):
        pytest.skip("this C library cannot give back")
    freed, stays = [], []
    for number in range(20_000):  # 80 MB in pieces too small for pages of their own
        freed.append(np.ones(500))
        if number % 2_000 == 0:
            stays.append(np.ones(100))
    full = resident()
    freed.clear()
    give_back_free_memory()
    assert resident() < full - 60.0  # most of the 80 MB: what else runs in this process may have taken some
    assert all(float(each.sum()) == 100.0 for each in stays)
