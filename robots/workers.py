"""Worker processes: how many, and that they do not outlive the process that started them."""

import multiprocessing
import os
import threading
import time

LOOK_EVERY = 0.25
"""Between two looks whether the parent still lives [s]."""
_watch: threading.Thread | None = None


def worker_count(asked: int) -> int:
    """As many processes as were asked for; where that is 0, one for each core that may be used."""
    return asked or len(os.sched_getaffinity(0))


def end_with_parent() -> None:
    """End this worker process once its parent is gone, however that ended; for the parent itself it does nothing.

    A pool's workers are told to end by their parent, and one that was killed tells nothing: they would work on to the
    end. Calling it again changes nothing.
    """
    global _watch
    parent = multiprocessing.parent_process()
    if parent is None or parent.pid is None or _watch is not None:
        return
    _watch = threading.Thread(target=_end_after, args=(parent.pid,), daemon=True)
    _watch.start()


def _end_after(parent: int) -> None:
    """Wait until an orphan, which gets another parent, then end without ado: nobody takes what was worked out."""
    while os.getppid() == parent:
        time.sleep(LOOK_EVERY)
    os._exit(1)
