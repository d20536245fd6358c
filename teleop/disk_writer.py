"""A file that is written by a thread of its own, so that whoever records never waits for the disk."""

import contextlib
import errno
import os
from pathlib import Path
from queue import SimpleQueue
from threading import Event, Lock, Thread

WAITING_MOST = 32 << 20
"""If more bytes than this wait for the disk, it is too slow and writing ends [bytes]: minutes of a demo."""
_NO_SYNC = (errno.EINVAL, errno.ENOTSUP, errno.EROFS)
"""What `fsync` says of files that cannot be synchronised, such as pipes; they are written all the same."""


class DiskWriter:
    """What an MCAP writer writes to: `write` and `flush` return at once, a thread does the work.

    What lies between two `flush` is written in one piece and synchronised, so that it survives the process, and the
    machine's power too. When the disk fails, what is whole stays, `failed` says why, and later calls do nothing.

    Attributes:
        path: The file.
        failed: Why writing ended; empty while all is well.
    """

    def __init__(self, path: Path, *, exclusive: bool = False) -> None:
        """Open the file.

        Args:
            path: The file; one that exists is replaced.
            exclusive: Refuse one that exists.

        Raises:
            OSError: It cannot be opened.
        """
        self.path = path
        self.failed = ""
        self._file = os.open(path, os.O_WRONLY | os.O_CREAT | (os.O_EXCL if exclusive else os.O_TRUNC), 0o666)
        self._position = 0
        self._whole = 0
        self._blocks: list[bytes] = []
        self._queue: SimpleQueue[bytes | None] = SimpleQueue()
        self._lock = Lock()
        self._waiting = 0
        self._ended = False
        self._idle = Event()
        self._idle.set()
        self._closed = Event()
        Thread(target=self._work, name=f"writes {path.name}", daemon=True).start()

    def write(self, data: bytes) -> int:
        """Take bytes; they go to the disk with the next `flush`."""
        if data and not self.failed:
            self._blocks.append(bytes(data))
        self._position += len(data)
        return len(data)

    def tell(self) -> int:
        """Bytes taken so far."""
        return self._position

    def flush(self) -> None:
        """Hand what was taken to the thread; returns at once."""
        block = b"".join(self._blocks)
        self._blocks.clear()
        if not block or self.failed or self._ended:
            return
        with self._lock:
            self._waiting += len(block)
            too_much = self._waiting > WAITING_MOST
            if not too_much:
                self._idle.clear()
        if too_much:
            self.failed = f"the disk is too slow: {WAITING_MOST >> 20} MB wait to be written"
        else:
            self._queue.put(block)

    def end(self) -> None:
        """Hand over what is left and close the file when it is written; returns at once."""
        if not self._ended:
            self.flush()
            self._ended = True
            self._queue.put(None)

    @property
    def whole(self) -> int:
        """Bytes of the whole blocks that the file holds."""
        return self._whole

    @property
    def closed(self) -> bool:
        """Whether everything is written, or writing failed, and the file is closed."""
        return self._closed.is_set()

    def wait_written(self, timeout: float | None = None) -> bool:
        """Wait until all that was flushed is on the disk, or writing failed; False after `timeout` [s]."""
        return self._idle.wait(timeout)

    def wait_closed(self, timeout: float | None = None) -> bool:
        """After `end`: wait until the file is closed; False after `timeout` [s]."""
        return self._closed.wait(timeout)

    def _work(self) -> None:
        """Write block after block until the end."""
        while (block := self._queue.get()) is not None:
            if not self.failed:
                try:
                    self._put(block)
                except OSError as error:
                    self.failed = error.strerror or str(error)
                    with contextlib.suppress(OSError):  # half a block helps nobody
                        os.ftruncate(self._file, self._whole)
            with self._lock:
                self._waiting -= len(block)
                if self._waiting == 0 or self.failed:
                    self._idle.set()
        try:
            if not self.failed:
                self._sync()
        except OSError as error:
            self.failed = error.strerror or str(error)
        with contextlib.suppress(OSError):
            os.close(self._file)
        self._idle.set()
        self._closed.set()

    def _put(self, block: bytes) -> None:
        left = memoryview(block)
        while left:
            left = left[os.write(self._file, left) :]
        self._whole += len(block)
        if self._queue.empty():  # what waits is written first: it then survives the process, if not yet the machine
            self._sync()

    def _sync(self) -> None:
        try:
            os.fsync(self._file)
        except OSError as error:
            if error.errno not in _NO_SYNC:
                raise
