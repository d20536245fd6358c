"""Worker processes end with the process that started them, also when that one is killed."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

POOL = """
import sys, time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from robots.workers import end_with_parent

def work(folder):
    import os
    Path(folder, str(os.getpid())).touch()
    time.sleep(120.0)

if __name__ == "__main__":
    with ProcessPoolExecutor(2, get_context("spawn"), initializer=end_with_parent) as pool:
        list(pool.map(work, [sys.argv[1]] * 2))
"""
LIMIT = 60.0
"""Processes start and end long before this [s], also on a busy machine."""


def runs(process: int) -> bool:
    """Whether a process is there and is no zombie that nobody waits for."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGKILL], ids=["terminated", "killed"])
def test_workers_end_when_their_parent_does(tmp_path: Path, how: signal.Signals) -> None:
    script, begun = tmp_path / "pool.py", tmp_path / "begun"
    script.write_text(POOL)
    begun.mkdir()
    parent = subprocess.Popen([sys.executable, str(script), str(begun)])
    until = time.monotonic() + LIMIT
    while len(list(begun.iterdir())) < 2:
        assert time.monotonic() < until and parent.poll() is None, "the workers do not start"
        time.sleep(0.05)
    workers = [int(each.name) for each in begun.iterdir()]
    assert all(map(runs, workers))
    parent.send_signal(how)
    parent.wait(LIMIT)
    while any(map(runs, workers)):
        assert time.monotonic() < until, "the workers go on without their parent"
        time.sleep(0.05)
