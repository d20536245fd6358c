import os
import resource
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Event

import pytest

from teleop import disk_writer
from teleop.disk_writer import DiskWriter


@contextmanager
def files_at_most(size: int) -> Iterator[None]:
    """A full disk: no file of this process grows beyond a size."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_what_is_flushed_arrives_in_order(tmp_path: Path) -> None:
    disk = DiskWriter(tmp_path / "file")
    for number in range(200):
        disk.write(f"{number} ".encode())
        if number % 7 == 0:
            disk.flush()
    disk.end()
    assert disk.wait_closed(5.0) and disk.closed
    assert (tmp_path / "file").read_text().split() == list(map(str, range(200)))
    assert disk.tell() == (tmp_path / "file").stat().st_size


def test_a_full_disk_keeps_whole_blocks_and_says_why(tmp_path: Path) -> None:
    with files_at_most(2500):
        disk = DiskWriter(tmp_path / "file")
        for _ in range(5):
            disk.write(b"x" * 1000)
            disk.flush()
            assert disk.wait_written(5.0)
        disk.end()
        assert disk.wait_closed(5.0)
    assert disk.failed == "File too large"
    assert (tmp_path / "file").stat().st_size == 2000


def test_a_disk_that_hangs_does_not_hold_up_the_caller(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real, answers = os.write, Event()
    finished: list[bytes] = []

    def hangs(file: int, data: bytes) -> int:
        answers.wait()
        finished.append(bytes(data))
        return real(file, data)

    monkeypatch.setattr(disk_writer.os, "write", hangs)
    monkeypatch.setattr(disk_writer, "WAITING_MOST", 2000)
    disk = DiskWriter(tmp_path / "file")
    for _ in range(4):
        disk.write(b"x" * 600)
        disk.flush()
    disk.end()
    # All calls returned while the disk had not taken a byte: a caller that waited for it would still be waiting.
    assert finished == []
    assert disk.failed == "the disk is too slow: 0 MB wait to be written"
    assert not disk.closed
    answers.set()
    assert disk.wait_closed(5.0)


def test_an_existing_file_may_be_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("there")
    with pytest.raises(FileExistsError, match="file"):
        DiskWriter(tmp_path / "file", exclusive=True)
