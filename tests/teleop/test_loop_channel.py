import socket
import threading
import time

import pytest

from teleop.errors import TeleopError
from teleop.loop_channel import PIECE, Channel, ChannelClosedError
from teleop.loop_pace import MOST_BEHIND, Pace


@pytest.fixture
def ends() -> tuple[Channel, Channel]:
    ours, theirs = Channel.pair()
    return ours, Channel(theirs)


def test_messages_arrive_whole_and_in_order(ends: tuple[Channel, Channel]) -> None:
    ours, theirs = ends
    assert theirs.receive() == []
    for message in (b"one", b"", b"two" * 1000):
        assert ours.send(message)
    assert theirs.receive() == [b"one", b"", b"two" * 1000]
    assert theirs.send(b"back")
    assert ours.receive() == [b"back"]


def test_a_long_message_waits_for_its_reader(ends: tuple[Channel, Channel]) -> None:
    ours, theirs = ends
    long = bytes(range(256)) * 8000  # far more than the socket holds
    sending = threading.Thread(target=ours.send_surely, args=(long,))
    sending.start()
    got: list[bytes] = []
    deadline = time.monotonic() + 5
    while not got and time.monotonic() < deadline:
        got = theirs.receive()
    sending.join()
    assert got == [long]


def test_a_sender_that_is_not_heard_drops_and_does_not_wait(ends: tuple[Channel, Channel]) -> None:
    ours, theirs = ends
    started = time.monotonic()
    sent = sum(ours.send(b"x" * 1000) for _ in range(5000))
    assert 0 < sent < 5000
    assert time.monotonic() - started < 2.0  # 5000 waits of any length would be longer
    assert len(theirs.receive()) == sent
    assert ours.send(b"heard again")
    with pytest.raises(TeleopError, match=f"{PIECE + 1} bytes cannot be sent at once"):
        ours.send(b"x" * (PIECE + 1))
    with pytest.raises(ChannelClosedError, match="has read nothing for 0.1 s"):
        ours.send_surely(b"x" * 2_000_000, timeout=0.1)


def test_the_end_of_the_other_process_is_told_after_its_last_words(ends: tuple[Channel, Channel]) -> None:
    ours, theirs = ends
    theirs.send(b"last")
    theirs.close()
    assert ours.receive() == [b"last"]
    with pytest.raises(ChannelClosedError, match="the other process is gone"):
        ours.receive()
    with pytest.raises(ChannelClosedError, match="the other process is gone"):
        ours.send(b"anybody")
    assert isinstance(Channel.pair()[1], socket.socket)


class Clock:
    """Time that passes only when somebody sleeps or works."""

    def __init__(self) -> None:
        self.now = 50.0

    def monotonic(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds


def test_a_late_step_is_made_up_but_a_long_pause_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock()
    monkeypatch.setattr("teleop.loop_pace.time", clock)
    pace = Pace(0.004)
    for _ in range(10):
        pace.wait()
    assert clock.now == pytest.approx(50.040)
    clock.now += 0.030  # a hiccup: the next steps follow at once, until the schedule is met
    for _ in range(10):
        pace.wait()
    assert clock.now == pytest.approx(50.080)
    assert pace.given_up == 0.0
    clock.now += 10 * MOST_BEHIND
    for _ in range(3):
        pace.wait()
    assert pace.given_up == pytest.approx(10 * MOST_BEHIND - 0.004)
    assert clock.now == pytest.approx(50.080 + 10 * MOST_BEHIND + 2 * 0.004)
    typical, latest = pace.lateness()
    assert (typical, latest) == (pytest.approx(0.0, abs=0.03), pytest.approx(pace.given_up))
