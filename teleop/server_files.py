"""The page's own files, with headers that let nothing else in."""

from collections.abc import Mapping
from functools import cache
from http import HTTPStatus
from importlib.resources import files

from websockets.datastructures import Headers
from websockets.http11 import Response

_KINDS = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
}


PageFiles = Mapping[str, tuple[str, bytes]]
"""Path to content type and bytes."""


@cache
def page_files() -> PageFiles:
    """Files of the page that drives and records."""
    found = folder_files("teleop", "page")
    return {**found, "/": found["/index.html"]}


def folder_files(package: str, folder: str) -> PageFiles:
    """What a page may load of a folder in a package."""
    found = {}
    for each in files(package).joinpath(folder).iterdir():
        suffix = each.name[each.name.rfind(".") :]
        if suffix in _KINDS:
            found[f"/{each.name}"] = (_KINDS[suffix], each.read_bytes())
    return found


def file_response(method: str, path: str, host: str, scheme: str, known_files: PageFiles | None = None) -> Response:
    """Answer a request for a file.

    Args:
        method: Of the request.
        path: Of the request; what follows a `?` is ignored.
        host: The request's Host header, checked.
        scheme: `http` or `https`.
        known_files: All files that there are; those of the page that drives and records if left out.
    """
    if method not in ("GET", "HEAD"):
        return plain(HTTPStatus.METHOD_NOT_ALLOWED, "only GET is answered")
    known = (page_files() if known_files is None else known_files).get(path.split("?", 1)[0])
    if known is None:
        return plain(HTTPStatus.NOT_FOUND, "there is no such file")
    kind, body = known
    socket = f"{'wss' if scheme == 'https' else 'ws'}://{host}"  # some browsers do not take 'self' for WebSockets
    policy = (
        f"default-src 'self'; connect-src 'self' {socket}; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'none'; object-src 'none'"
    )
    return _response(HTTPStatus.OK, kind, body, method == "HEAD", policy)


def plain(status: HTTPStatus, text: str) -> Response:
    """Answer with a line of text."""
    return _response(status, "text/plain; charset=utf-8", f"{text}\n".encode(), False, "default-src 'none'")


def _response(status: HTTPStatus, kind: str, body: bytes, empty: bool, policy: str) -> Response:
    headers = Headers()
    for name, value in (
        ("Content-Type", kind),
        ("Content-Length", str(len(body))),
        ("Content-Security-Policy", policy),
        ("X-Frame-Options", "DENY"),
        ("X-Content-Type-Options", "nosniff"),
        ("Referrer-Policy", "no-referrer"),
        ("Cross-Origin-Opener-Policy", "same-origin"),
        ("Cross-Origin-Embedder-Policy", "require-corp"),
        ("Cross-Origin-Resource-Policy", "same-origin"),
        ("Permissions-Policy", "gamepad=(self), camera=(), microphone=(), geolocation=()"),
        ("Cache-Control", "no-cache"),
        ("Connection", "close"),
    ):
        headers[name] = value
    return Response(status.value, status.phrase, headers, b"" if empty else body)
