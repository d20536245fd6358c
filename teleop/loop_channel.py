"""Whole messages between the control loop and the server, two processes; a sender that is not heard never waits."""

import select
import socket
import time

from .errors import TeleopError

PIECE = 60_000
"""Longest packet [byte]; a longer message goes in several."""
_LAST, _MORE = b"\0", b"\1"
_TICK = 0.02


class ChannelClosedError(TeleopError, EOFError):
    """The process at the other end is gone."""


class Channel:
    """One end of a pair of sockets that keep messages apart (Linux's SOCK_SEQPACKET).

    What is waiting is bounded by the socket's buffer: `send` drops a message that does not fit, so that a reader that
    hangs cannot stop control; `send_surely` waits, for what must arrive and is sent while nothing moves.
    """

    def __init__(self, sock: socket.socket) -> None:
        """Take over a socket."""
        sock.setblocking(False)
        self._socket = sock
        self._pieces: list[bytes] = []

    @staticmethod
    def pair() -> tuple["Channel", socket.socket]:
        """One end, and the socket of the other end, to be given to another process."""
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        return Channel(ours), theirs

    def fileno(self) -> int:
        """The descriptor, to wait on."""
        return self._socket.fileno()

    def send(self, message: bytes) -> bool:
        """Send a message of at most `PIECE` bytes if there is room; says whether there was.

        Raises:
            ChannelClosedError: The other end is gone.
        """
        if len(message) > PIECE:
            raise TeleopError(f"a message of {len(message)} bytes cannot be sent at once: at most {PIECE}")
        return self._packet(_LAST + message)

    def send_surely(self, message: bytes, timeout: float = 10.0) -> None:
        """Send a message of any length, waiting for room.

        Raises:
            ChannelClosedError: The other end is gone, or reads nothing for `timeout` seconds.
        """
        until = time.monotonic() + timeout
        for start in range(0, max(len(message), 1), PIECE):
            piece = message[start : start + PIECE]
            packet = (_LAST if start + PIECE >= len(message) else _MORE) + piece
            while not self._packet(packet):
                if time.monotonic() > until:
                    raise ChannelClosedError(f"the other process has read nothing for {timeout} s")
                select.select([], [self._socket], [], _TICK)

    def receive(self) -> list[bytes]:
        """All whole messages that have arrived; does not wait.

        Raises:
            ChannelClosedError: The other end is gone and nothing is left to read.
        """
        messages: list[bytes] = []
        while True:
            try:
                packet = self._socket.recv(PIECE + 1)
            except BlockingIOError:
                return messages
            except OSError as error:
                raise ChannelClosedError(f"the other process is gone: {error.strerror}") from error
            if not packet:
                if messages:
                    return messages  # the next call says that it ended
                raise ChannelClosedError("the other process is gone")
            self._pieces.append(packet[1:])
            if packet[:1] == _LAST:
                messages.append(b"".join(self._pieces))
                self._pieces.clear()

    def close(self) -> None:
        """Close this end."""
        self._socket.close()

    def _packet(self, packet: bytes) -> bool:
        try:
            self._socket.send(packet)
        except BlockingIOError:
            return False
        except OSError as error:
            raise ChannelClosedError(f"the other process is gone: {error.strerror}") from error
        return True
