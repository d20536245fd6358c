"""The page's server: files and one WebSocket a page, behind a door; the control loop is another process.

One page holds control, the others watch. What a page sends is checked here and passed on; what the loop tells goes to
every page. Nothing here can delay the loop: it hears nothing when it does not want to, and says what it has to say
whether or not somebody listens.
"""

import asyncio
import contextlib
import logging
import ssl
import subprocess
import time
from collections import deque
from collections.abc import Callable, Collection
from http import HTTPStatus
from typing import Any

import orjson
from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response
from websockets.typing import Subprotocol

from .errors import TeleopError
from .loop_channel import Channel, ChannelClosedError
from .loop_extension import TEXT_KINDS
from .loop_process import LoopSettings, check_started, start_loop
from .server_client import Client, Lateness
from .server_door import SUBPROTOCOL, Door, check_exposure, is_upgrade, make_door
from .server_files import PageFiles, file_response, page_files, plain
from .server_protocol import LONGEST_MESSAGE, Control, Input, Message, ProtocolError, Release, Stop, read_message

_LOG = logging.getLogger(__name__)

MOST_PAGES = 24
"""Pages that may be connected at once."""
GIVEN_UP_AFTER = 2.0
"""A page that holds control and says nothing for this long loses it [s]."""
START_TIMEOUT = 180.0
"""How long the control loop may take to start [s]: the first time a robot's meshes are decimated and kernels
compiled, on a busy machine perhaps beside other work."""
END_TIMEOUT = 35.0
"""How long it may take to finish a recording [s]; a disk is waited for 30 s."""
_BAD_DATA, _POLICY = 1007, 1008
_POLL = 0.02


class PageServer:
    """Serves the page and runs the control loop.

    Attributes:
        url: Address of the page with its token; known once `run` has called back.
        door: What is checked of every request; known then, too.
    """

    def __init__(
        self,
        settings: LoopSettings,
        *,
        host: str = "127.0.0.1",
        port: int = 0,
        names: Collection[str] = (),
        context: ssl.SSLContext | None = None,
        files: PageFiles | None = None,
    ) -> None:
        """Keep the settings; nothing is started.

        Args:
            settings: Scene and folder of the control loop.
            host: Address to listen at; see `server_door.check_exposure`.
            port: Port to listen at; 0 takes a free one.
            names: Other names under which the server is reached.
            context: TLS, or None.
            files: More files of the page, for what the settings' extension adds to it.

        Raises:
            TeleopError: Other machines could reach the address, and there is no TLS.
        """
        check_exposure(host, True, context)
        self._settings = settings
        self._host, self._port, self._names, self._context = host, port, names, context
        self._files = {**page_files(), **(files or {})}
        self.url = ""
        self.door: Door | None = None
        self._clients: dict[ServerConnection, Client] = {}
        self._numbers = 0
        self._operator: Client | None = None
        self._heard = 0.0
        self._process: subprocess.Popen[bytes] | None = None
        self._channel: Channel | None = None
        self._latest: dict[str, str | bytes] = {}
        self._waiting: deque[bytes] = deque()
        """What must reach the loop, whatever else does not fit: stops, releases and lost control, in order."""
        self._ended: asyncio.Future[None] | None = None

    @property
    def status(self) -> dict[str, Any]:
        """What the control loop told last, as every page gets it; empty before it runs."""
        told = self._latest.get("J")
        status: dict[str, Any] = {} if told is None else orjson.loads(told)
        return status

    async def run(self, started: Callable[[str], None]) -> None:
        """Serve until cancelled.

        Args:
            started: Called with the page's address once everything runs.

        Raises:
            TeleopError: The control loop cannot start, or ended; the address cannot be listened at.
        """
        self._process, self._channel = start_loop(self._settings)
        try:
            await self._first_words()
            await self._serve(started)
        finally:
            self._channel.close()
            try:
                await asyncio.to_thread(self._process.wait, END_TIMEOUT)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()

    async def _serve(self, started: Callable[[str], None]) -> None:
        loop = asyncio.get_running_loop()
        self._ended = loop.create_future()
        channel = self._loop_channel()
        try:
            listening = await serve(
                self._page,
                self._host,
                self._port,
                ssl=self._context,
                process_request=self._request,
                subprotocols=[Subprotocol(SUBPROTOCOL)],
                compression=None,
                max_size=LONGEST_MESSAGE,
                max_queue=32,
                open_timeout=5.0,
                ping_interval=4.0,
                ping_timeout=4.0,
                close_timeout=1.0,
                server_header=None,
            )
        except OSError as error:
            raise TeleopError(f"cannot listen at {self._host} port {self._port}: {error.strerror or error}") from error
        async with listening:
            port = next(iter(listening.sockets)).getsockname()[1]
            self.door = make_door(self._host, port, names=self._names, tls=self._context is not None)
            name = next(iter(self._names), self._host)
            shown = f"[{name}]" if ":" in name else name
            self.url = f"{self.door.scheme}://{shown}:{port}/#token={self.door.token}"
            loop.add_reader(channel.fileno(), self._hear)
            try:
                started(self.url)
                await self._ended
            finally:
                loop.remove_reader(channel.fileno())

    async def _first_words(self) -> None:
        """Wait until the control loop runs.

        Raises:
            TeleopError: It does not start, or says why it cannot.
        """
        until = time.monotonic() + START_TIMEOUT
        while time.monotonic() < until:
            try:
                messages = self._loop_channel().receive()
            except ChannelClosedError as error:
                raise TeleopError("the control loop ended while it started: see the messages above") from error
            for message in messages:
                check_started(message)
                self._pass_on(message)
            if messages:
                return
            await asyncio.sleep(_POLL)
        raise TeleopError(f"the control loop did not start within {START_TIMEOUT:.0f} s")

    # Requests

    def _request(self, connection: ServerConnection, request: Request) -> Response | None:
        """Answer a request for a file, refuse one that may not pass, or let a WebSocket through."""
        if self.door is None:
            return plain(HTTPStatus.SERVICE_UNAVAILABLE, "starting")
        refused = self.door.refusal(request)
        if refused is not None:
            _LOG.warning("refused a request of %s: %s", connection.remote_address, refused.reason)
            return plain(refused.status, refused.reason)
        if not is_upgrade(request):
            return file_response(request.method, request.path, request.headers["Host"], self.door.scheme, self._files)
        if request.path != "/socket":
            return plain(HTTPStatus.NOT_FOUND, "the WebSocket is at /socket")
        if len(self._clients) >= MOST_PAGES:
            return plain(HTTPStatus.SERVICE_UNAVAILABLE, f"{MOST_PAGES} pages are open already")
        return None

    async def _page(self, connection: ServerConnection) -> None:
        """Serve one page from its opening to its end."""
        if connection.subprotocol != SUBPROTOCOL:
            await connection.close(_POLICY, f"this server speaks {SUBPROTOCOL}")
            return
        self._numbers += 1
        client = Client(connection, self._numbers)
        self._clients[connection] = client
        for kind, message in self._latest.items():
            client.show(kind, message)
        self._tell_control()
        pump = asyncio.create_task(client.pump())
        try:
            await self._listen(client)
        except ConnectionClosed:
            pass
        finally:
            pump.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await pump
            del self._clients[connection]
            if self._operator is client:
                self._let_go("the page that held control is gone")
            self._tell_control()

    async def _listen(self, client: Client) -> None:
        async for data in client.connection:
            now = time.monotonic()
            if not client.allowance.take(now):
                _LOG.warning("page %d sends too much: closed", client.number)
                await client.connection.close(_POLICY, "too many messages")
                return
            try:
                message = read_message(data)
            except ProtocolError as error:
                _LOG.warning("page %d: %s: closed", client.number, error)
                await client.connection.close(_BAD_DATA, f"not understood: {error}"[:110])
                return
            self._obey(client, message, now)

    # What pages say

    def _obey(self, client: Client, message: Message, now: float) -> None:
        if isinstance(message, Stop):  # anyone may stop it
            self._send_surely({"type": "stop"})
        elif isinstance(message, Control):
            self._control(client, message, now)
        elif client is not self._operator:
            if not isinstance(message, Input):  # inputs that were under way when control changed are let go by
                self._refuse(client, "you are watching: take control first")
        elif isinstance(message, Input):
            self._heard = now
            stamp = message.at / 1000
            self._send(
                {
                    "type": "input",
                    "axes": message.axes,
                    "buttons": message.buttons,
                    "enabled": message.enabled,
                    "camera": message.camera,
                    "received": now,
                    "late": client.lateness.of(stamp, now) + message.silence / 1000,
                    "stamp": stamp,
                },
                None,
            )
        elif isinstance(message, Release):
            self._send_surely({"type": "release"})
        else:
            self._send(message.model_dump(), client)

    def _control(self, client: Client, message: Control, now: float) -> None:
        if message.action == "release":
            if self._operator is client:
                self._let_go("control was given back")
        elif self._operator is None:
            self._operator, self._heard = client, now
            client.lateness = Lateness()
        elif self._operator is not client:
            self._refuse(client, "another page holds control: it has to give it back first")
        self._tell_control()

    def _let_go(self, reason: str) -> None:
        self._operator = None
        self._send_surely({"type": "lost", "reason": reason})

    def _tell_control(self) -> None:
        """Tell every page who holds control."""
        for client in self._clients.values():
            told = {
                "type": "control",
                "yours": client is self._operator,
                "free": self._operator is None,
                "pages": len(self._clients),
            }
            client.show("control", orjson.dumps(told).decode())

    def _refuse(self, client: Client, reason: str) -> None:
        client.tell(orjson.dumps({"type": "refused", "reason": reason}).decode())

    # The control loop

    def _send(self, message: dict[str, object], client: Client | None) -> None:
        """Pass a message to the loop; a page whose wish does not fit is told so."""
        try:
            sent = self._send_waiting() and self._loop_channel().send(orjson.dumps(message))
        except ChannelClosedError:
            return  # `_hear` sees that it ended, and ends the server
        if not sent and client is not None:
            self._refuse(client, "the control loop is busy: try again")

    def _send_surely(self, message: dict[str, object]) -> None:
        """Pass a message to the loop, now or as soon as it has room: a stop that is pressed is never lost."""
        told = orjson.dumps(message)
        if not self._waiting or self._waiting[-1] != told:  # once more says nothing new
            self._waiting.append(told)
        with contextlib.suppress(ChannelClosedError):
            self._send_waiting()

    def _send_waiting(self) -> bool:
        """Pass on what waits, in order; says whether nothing waits any more."""
        while self._waiting:
            if not self._loop_channel().send(self._waiting[0]):
                return False
            self._waiting.popleft()
        return True

    def _hear(self) -> None:
        """Pass on what the loop tells; ten times a second or more, so silence of a page is noticed here, too."""
        if self._operator is not None and time.monotonic() - self._heard > GIVEN_UP_AFTER:
            self._let_go("the page that held control is silent")
            self._tell_control()
        try:
            self._send_waiting()
            for message in self._loop_channel().receive():
                self._pass_on(message)
        except ChannelClosedError:
            if self._ended is not None and not self._ended.done():
                self._ended.set_exception(TeleopError("the control loop ended by itself: see the messages above"))

    def _pass_on(self, message: bytes) -> None:
        kind = message[:1].decode()
        told: str | bytes = message[1:].decode() if kind in TEXT_KINDS else message
        self._latest[kind] = told
        for client in self._clients.values():
            client.show(kind, told)

    def _loop_channel(self) -> Channel:
        if self._channel is None:
            raise TeleopError("the control loop does not run: call run() first")
        return self._channel
