import shutil
import subprocess
from http import HTTPStatus
from pathlib import Path

import pytest
from websockets.datastructures import Headers
from websockets.http11 import Request

from teleop.errors import TeleopError
from teleop.server_door import Door, check_exposure, is_loopback, make_door, tls_context


def asked(door: Door, *headers: tuple[str, str]) -> HTTPStatus | None:
    given = Headers()
    for name, value in headers:
        given[name] = value
    refusal = door.refusal(Request("/", given))
    return None if refusal is None else refusal.status


def test_names_that_a_loopback_server_answers_to() -> None:
    door = make_door("127.0.0.1", 8765)
    for host in ("127.0.0.1:8765", "localhost:8765", "[::1]:8765", "LOCALHOST:8765"):
        assert asked(door, ("Host", host)) is None
    for host in (
        "localhost",
        "localhost:80",
        "localhost.evil.example:8765",
        "127.0.0.1:8765.evil.example",
        "0.0.0.0:8765",
    ):
        assert asked(door, ("Host", host)) == HTTPStatus.MISDIRECTED_REQUEST
    assert asked(door, ("Host", "localhost:8765"), ("Host", "localhost:8765")) == HTTPStatus.MISDIRECTED_REQUEST


def test_the_origin_must_be_the_address_that_was_asked() -> None:
    door = make_door("127.0.0.1", 8765)
    host = ("Host", "localhost:8765")
    assert asked(door, host, ("Origin", "http://localhost:8765")) is None
    for origin in ("http://127.0.0.1:8765", "https://localhost:8765", "http://localhost", "null", ""):
        assert asked(door, host, ("Origin", origin)) == HTTPStatus.FORBIDDEN
    assert asked(door, host, ("Upgrade", "websocket")) == HTTPStatus.FORBIDDEN  # without any


def test_an_exposed_server_answers_to_its_names_only() -> None:
    with pytest.raises(TeleopError, match="--host 0.0.0.0 is every address: name it with --name"):
        make_door("0.0.0.0", 443, tls=True)
    door = make_door("0.0.0.0", 443, names=["robot.lan"], tls=True)
    assert asked(door, ("Host", "robot.lan"), ("Origin", "https://robot.lan")) is None
    assert asked(door, ("Host", "robot.lan:443")) is None
    assert asked(door, ("Host", "0.0.0.0:443")) == HTTPStatus.MISDIRECTED_REQUEST


def test_each_server_has_a_token_of_its_own() -> None:
    tokens = {make_door("127.0.0.1", 1).token for _ in range(20)}
    assert len(tokens) == 20
    assert all(len(token) >= 43 for token in tokens)  # 256 bits


@pytest.mark.parametrize(
    ("host", "own"),
    [("127.0.0.1", True), ("127.8.8.8", True), ("::1", True), ("localhost", True), ("0.0.0.0", False), ("::", False),
     ("192.168.1.2", False), ("robot.lan", False), ("", False)],
)  # fmt: skip
def test_nothing_is_exposed_by_accident(host: str, own: bool, tmp_path: Path) -> None:
    assert is_loopback(host) is own
    if own:
        check_exposure(host, False, None)
        return
    with pytest.raises(TeleopError, match="can be reached from other machines: use 127.0.0.1, or add --expose"):
        check_exposure(host, False, None)
    with pytest.raises(TeleopError, match="--expose needs TLS"):
        check_exposure(host, True, None)


def test_tls_needs_a_certificate_and_its_key(tmp_path: Path) -> None:
    assert tls_context(None, None) is None
    with pytest.raises(TeleopError, match="TLS needs both --cert and --key"):
        tls_context(tmp_path / "cert.pem", None)
    with pytest.raises(TeleopError, match="cannot be used: .*No such file"):
        tls_context(tmp_path / "cert.pem", tmp_path / "key.pem")


@pytest.mark.skipif(shutil.which("openssl") is None, reason="openssl makes the certificate")
def test_a_certificate_with_its_key_is_taken(tmp_path: Path) -> None:
    cert, key = tmp_path / "cert.pem", tmp_path / "key.pem"
    making = "openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -subj /CN=robot.lan -days 1"
    subprocess.run([*making.split(), "-out", str(cert), "-keyout", str(key)], check=True, capture_output=True)
    context = tls_context(cert, key)
    check_exposure("0.0.0.0", True, context)
    assert context is not None
