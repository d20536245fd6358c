"""The page on a network: over TLS, with a certificate of one's own, and not otherwise."""

import asyncio
import shutil
import ssl
import subprocess
from pathlib import Path

import pytest
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import InvalidMessage, InvalidStatus

from teleop.errors import TeleopError
from teleop.loop_process import LoopSettings
from teleop.server import PageServer
from teleop.server_door import SUBPROTOCOL, TOKEN_PREFIX, tls_context
from tests.teleop.test_server import AWAY, STILL, Page

NAME = "robot.test"
EVERY_ADDRESS = "0.0.0.0"


@pytest.fixture(scope="module")
def certificate(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A certificate for `NAME`, signed by itself, and its key."""
    if shutil.which("openssl") is None:
        pytest.skip("openssl makes the certificate: apt-get install -y openssl")
    folder = tmp_path_factory.mktemp("tls")
    cert, key = folder / "cert.pem", folder / "key.pem"
    making = (
        f"openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -subj /CN={NAME} "
        f"-addext subjectAltName=DNS:{NAME} -days 2"
    )
    subprocess.run([*making.split(), "-out", str(cert), "-keyout", str(key)], check=True, capture_output=True)
    return cert, key


class Visitor:
    """Another machine that knows the server by its name; only how the name is found is ours."""

    def __init__(self, url: str, cert: Path) -> None:
        self.address, self.token = url.split("/#token=")
        self.port = int(self.address.rsplit(":", 1)[1])
        self.trust = ssl.create_default_context(cafile=str(cert))

    async def connect(
        self, scheme: str = "wss", origin: str = "", trust: ssl.SSLContext | None = None
    ) -> ClientConnection:
        return await connect(
            f"{scheme}://{NAME}:{self.port}/socket",
            host="127.0.0.1",
            port=self.port,
            origin=origin or self.address,
            subprotocols=[SUBPROTOCOL, TOKEN_PREFIX + self.token],
            ssl=(trust or self.trust) if scheme == "wss" else None,
            compression=None,
        )

    async def get(self, *, tls: bool) -> bytes:
        """What is answered to a request for the page; empty where there is no answer."""
        how = {"ssl": self.trust, "server_hostname": NAME} if tls else {}
        reader, writer = await asyncio.open_connection("127.0.0.1", self.port, **how)
        writer.write(f"GET / HTTP/1.1\r\nHost: {NAME}:{self.port}\r\n\r\n".encode())
        try:
            return await asyncio.wait_for(reader.read(), 5)
        except ConnectionError:
            return b""
        finally:
            writer.close()


def test_a_page_drives_over_tls_and_nothing_else_gets_in(certificate: tuple[Path, Path], tmp_path: Path) -> None:
    async def test(visitor: Visitor) -> None:
        assert visitor.address == f"https://{NAME}:{visitor.port}"
        page_file = await visitor.get(tls=True)
        assert page_file.startswith(b"HTTP/1.1 200")
        assert f"connect-src 'self' wss://{NAME}:{visitor.port};".encode() in page_file
        assert b"HTTP" not in await visitor.get(tls=False)  # no answer, not even a refusal that could be read
        with pytest.raises((InvalidMessage, ConnectionError, EOFError)):
            await visitor.connect("ws", origin=f"http://{NAME}:{visitor.port}")
        with pytest.raises(ssl.SSLCertVerificationError):
            await visitor.connect(trust=ssl.create_default_context())  # who does not know the certificate does not talk
        with pytest.raises(InvalidStatus, match="403"):
            await visitor.connect(origin=f"http://{NAME}:{visitor.port}")  # a page that came without TLS
        connection = await visitor.connect()
        try:
            page = Page(connection)
            await page.until(lambda page: page.status and page.geometry)
            await page.take()
            await page.until(lambda page: page.status["state"] == "ok", saying=STILL)
            start = page.tool
            await page.until(lambda page: page.tool[0] > start[0] + 0.01, saying=AWAY)
        finally:
            await connection.close()

    async def run() -> None:
        context = tls_context(*certificate)
        server = PageServer(
            LoopSettings("board", None, 3, tmp_path), host=EVERY_ADDRESS, names=(NAME,), context=context
        )
        ready: asyncio.Future[str] = asyncio.get_running_loop().create_future()
        serving = asyncio.create_task(server.run(ready.set_result))
        try:
            await asyncio.wait((ready, serving), return_when=asyncio.FIRST_COMPLETED)
            if serving.done():
                serving.result()
            await asyncio.wait_for(test(Visitor(ready.result(), certificate[0])), 30)
        finally:
            serving.cancel()
            await asyncio.gather(serving, return_exceptions=True)

    asyncio.run(run())


@pytest.mark.parametrize("host", [EVERY_ADDRESS, "::", "192.168.1.2", NAME])
def test_a_server_for_others_without_tls_is_not_even_made(host: str, tmp_path: Path) -> None:
    with pytest.raises(TeleopError, match=f"--expose needs TLS, or the token is read on the way to {host}"):
        PageServer(LoopSettings("board", None, 3, tmp_path), host=host, names=(NAME,))
