"""Who may come in: Host, Origin and token, looked at for every request.

The Host check answers DNS rebinding (another name that points at this machine), the Origin check other sites that are
open in the same browser, the token other users of the machine.
"""

import hmac
import ipaddress
import secrets
import ssl
from collections.abc import Collection
from dataclasses import dataclass
from http import HTTPStatus
from pathlib import Path

from websockets.datastructures import Headers, MultipleValuesError
from websockets.http11 import Request

from .errors import TeleopError

SUBPROTOCOL = "showtell.v1"
"""What page and server speak."""
TOKEN_PREFIX = "showtell.token."
"""A browser cannot set headers of a WebSocket, but its subprotocols: the token comes as one that starts with this."""
_LOOPBACK = ("127.0.0.1", "localhost", "[::1]")
_STANDARD = {"http": 80, "https": 443}


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why a request is not answered.

    Attributes:
        status: Of the HTTP answer.
        reason: One line for people.
    """

    status: HTTPStatus
    reason: str


@dataclass(frozen=True, slots=True)
class Door:
    """What is checked of every request.

    Attributes:
        scheme: `http`, or `https` where TLS is on.
        hosts: What a Host header may say, lower case.
        token: Secret that opens the WebSocket.
    """

    scheme: str
    hosts: frozenset[str]
    token: str

    def refusal(self, request: Request) -> Refusal | None:
        """Why a request is refused; None when it may pass."""
        headers = request.headers
        host = _only(headers, "Host")
        if host is None or host.lower() not in self.hosts:
            return Refusal(HTTPStatus.MISDIRECTED_REQUEST, "this server is not called by that name")
        origin = _only(headers, "Origin")
        upgrade = is_upgrade(request)
        if "Origin" in headers or upgrade:
            own = origin is not None and origin.lower() == f"{self.scheme}://{host.lower()}"
            if not own:
                return Refusal(HTTPStatus.FORBIDDEN, "requests from other sites, or from none, are refused")
        if upgrade and not self._knows_token(headers):
            return Refusal(HTTPStatus.UNAUTHORIZED, "the token is missing or wrong: open the address as printed")
        return None

    def _knows_token(self, headers: Headers) -> bool:
        """Whether one of the subprotocols carries the token; each is compared in constant time."""
        known = False
        for line in headers.get_all("Sec-WebSocket-Protocol"):
            for offered in line.split(","):
                offer = offered.strip()
                if offer.startswith(TOKEN_PREFIX):
                    given = offer.removeprefix(TOKEN_PREFIX).encode("utf-8", "surrogateescape")
                    known |= hmac.compare_digest(given, self.token.encode())
        return known


def is_upgrade(request: Request) -> bool:
    """Whether a request asks for a WebSocket."""
    return any("websocket" in value.lower() for value in request.headers.get_all("Upgrade"))


def new_token() -> str:
    """A secret of 256 random bits."""
    return secrets.token_urlsafe(32)


def make_door(host: str, port: int, *, names: Collection[str] = (), tls: bool = False) -> Door:
    """Make the checks for a server that listens at an address.

    Args:
        host: Address it is bound to.
        port: Port it is bound to.
        names: Other names under which it is reached.
        tls: Whether it speaks TLS.

    Raises:
        TeleopError: It is bound to all addresses and no name is given.
    """
    scheme = "https" if tls else "http"
    bound = set(names)
    if host in ("", "0.0.0.0", "::"):
        if not names:
            raise TeleopError(f"--host {host or repr(host)} is every address: name it with --name as it is reached")
    else:
        bound.add(f"[{host}]" if ":" in host else host)
    bound.update(_LOOPBACK)
    hosts = {f"{name}:{port}".lower() for name in bound}
    if port == _STANDARD[scheme]:
        hosts |= {name.lower() for name in bound}
    return Door(scheme, frozenset(hosts), new_token())


def is_loopback(host: str) -> bool:
    """Whether an address is this machine's own."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def tls_context(certificate: Path | None, key: Path | None) -> ssl.SSLContext | None:
    """Read a certificate and its key; None for neither.

    Raises:
        TeleopError: Only one is given, or they cannot be read or do not belong together.
    """
    if certificate is None and key is None:
        return None
    if certificate is None or key is None:
        raise TeleopError("TLS needs both --cert and --key")
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    try:
        context.load_cert_chain(certificate, key)
    except OSError as error:  # ssl.SSLError is one
        raise TeleopError(f"the certificate {certificate} with key {key} cannot be used: {error}") from error
    return context


def check_exposure(host: str, expose: bool, context: ssl.SSLContext | None) -> None:
    """Let nobody open the server to a network by accident.

    Raises:
        TeleopError: The address is not this machine's own, and `--expose` with TLS was not asked for.
    """
    if is_loopback(host):
        return
    if not expose:
        raise TeleopError(
            f"--host {host} can be reached from other machines: use 127.0.0.1, or add --expose with --cert and --key"
        )
    if context is None:
        raise TeleopError(f"--expose needs TLS, or the token is read on the way to {host}: add --cert and --key")


def _only(headers: Headers, name: str) -> str | None:
    """A header that must be there once; None when it is missing or repeated."""
    try:
        return headers.get(name)
    except MultipleValuesError:
        return None
