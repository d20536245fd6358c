"""The page's server and its control loop, talked to by clients that are not always polite."""

import asyncio
import contextlib
import json
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from pathlib import Path
from typing import Any

import orjson
import pytest
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect as connect_in_thread
from websockets.typing import Origin, Subprotocol

from teleop.errors import TeleopError
from teleop.gamepad import AXES, BUTTONS
from teleop.loop_channel import Channel
from teleop.loop_process import LoopSettings
from teleop.server import PageServer
from teleop.server_door import SUBPROTOCOL, TOKEN_PREFIX

STILL = {"axes": [0.0] * len(AXES), "buttons": [0.0] * len(BUTTONS), "enabled": True}
AWAY = STILL | {"axes": [0.0, -1.0, 0.0, 0.0]}
SIDEWAYS = STILL | {"axes": [-1.0, 0.0, 0.0, 0.0]}


class Page:
    """What a page is to the server, without the page."""

    def __init__(self, connection: ClientConnection) -> None:
        self.connection = connection
        self.latest: dict[str, Any] = {}
        self.geometry = b""
        self.poses = b""
        self.refusals: list[str] = []
        self.statuses: list[dict[str, Any]] = []
        self._reader = asyncio.create_task(self._read())
        self._seq = 0

    async def say(self, **message: object) -> None:
        await self.connection.send(json.dumps(message))

    async def input(self, state: dict[str, Any]) -> None:
        self._seq += 1
        await self.say(type="input", seq=self._seq, at=1000 * time.time(), **state)

    async def hold(self, state: dict[str, Any], seconds: float) -> None:
        """Say the same sixty times a second."""
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            await self.input(state)
            await asyncio.sleep(1 / 60)

    async def until(
        self, test: Callable[["Page"], Any], seconds: float = 6.0, saying: dict[str, Any] | None = None
    ) -> Any:
        deadline = time.monotonic() + seconds
        while not (value := test(self)):
            assert time.monotonic() < deadline, f"did not happen: {self.status}, refused: {self.refusals}"
            if saying is not None:
                await self.input(saying)
            await asyncio.sleep(1 / 60)
        return value

    @property
    def status(self) -> dict[str, Any]:
        return self.latest.get("status", {})

    @property
    def yours(self) -> bool:
        return bool(self.latest.get("control", {}).get("yours"))

    @property
    def tool(self) -> list[float]:
        (tool,) = self.status["tools"].values()
        return list(tool["position"])

    async def take(self) -> None:
        await self.say(type="control", action="take")
        await self.until(lambda page: page.yours)

    async def start_anew(self) -> None:
        """Put the scene back to its start, let go of everything, and be ready to drive."""
        number = self.status["world"]
        await self.say(type="release")
        await self.say(type="do", action="reset")
        await self.until(lambda page: page.status["world"] > number, saying=STILL)
        await self.until(lambda page: page.status["state"] == "ok", saying=STILL)

    async def _read(self) -> None:
        with contextlib.suppress(ConnectionClosed):
            async for data in self.connection:
                if isinstance(data, bytes):
                    self.geometry, self.poses = (data, self.poses) if data[:1] == b"G" else (self.geometry, data)
                    continue
                message = orjson.loads(data)
                if message["type"] == "refused":
                    self.refusals.append(message["reason"])
                if message["type"] == "status":
                    self.statuses.append(message)
                self.latest[message["type"]] = message


class Visitors:
    """Opens pages of one server."""

    def __init__(self, server: PageServer) -> None:
        self.server = server
        address, self.token = server.url.split("/#token=")
        self.host = address.removeprefix("http://")

    async def connect(self, token: str | None = None, origin: str | None = "own", **more: Any) -> ClientConnection:
        subprotocols = [SUBPROTOCOL, *([] if token == "" else [TOKEN_PREFIX + (token or self.token)])]
        given = f"http://{self.host}" if origin == "own" else origin
        return await connect(
            f"ws://{self.host}/socket", origin=given, subprotocols=subprotocols, compression=None, **more
        )

    @contextlib.asynccontextmanager
    async def page(self, **more: Any) -> AsyncIterator[Page]:
        connection = await self.connect(**more)
        try:
            page = Page(connection)
            await page.until(lambda page: page.status and page.geometry)
            yield page
        finally:
            await connection.close()

    def flood(self, count: int) -> int | None:
        """Send messages as fast as they go, and say how the server ended that; runs in a thread."""
        protocols = [Subprotocol(SUBPROTOCOL), Subprotocol(TOKEN_PREFIX + self.token)]
        message = json.dumps({"type": "input", "seq": 1, "at": 0.0, **SIDEWAYS})
        with connect_in_thread(
            f"ws://{self.host}/socket", origin=Origin(f"http://{self.host}"), subprotocols=protocols, compression=None
        ) as connection:
            with contextlib.suppress(ConnectionClosed):
                for _ in range(count):
                    connection.send(message)
                while True:
                    connection.recv(timeout=5)
            return connection.close_code

    async def get(self, path: str = "/", *, method: str = "GET", **headers: str) -> tuple[int, str]:
        """Status and whole answer of a request with exactly these headers."""
        host, port = self.host.split(":")
        reader, writer = await asyncio.open_connection(host, int(port))
        lines = "".join(f"{name.replace('_', '-')}: {value}\r\n" for name, value in headers.items())
        writer.write(f"{method} {path} HTTP/1.1\r\n{lines}\r\n".encode())
        await writer.drain()
        answer = (await asyncio.wait_for(reader.read(), 5)).decode("utf-8", "replace")
        writer.close()
        return int(answer.split(" ")[1]), answer


def visited(test: Callable[[Visitors], Awaitable[None]], folder: Path, scene: str = "board") -> None:
    """Run a test with a server and its own control loop."""

    async def run() -> None:
        server = PageServer(LoopSettings(scene, None, 3, folder))
        ready: asyncio.Future[str] = asyncio.get_running_loop().create_future()
        serving = asyncio.create_task(server.run(ready.set_result))
        try:
            await asyncio.wait((ready, serving), return_when=asyncio.FIRST_COMPLETED)
            if serving.done():
                serving.result()
            await asyncio.wait_for(test(Visitors(server)), 60)
        finally:
            serving.cancel()
            await asyncio.gather(serving, return_exceptions=True)

    asyncio.run(run())


def test_only_our_own_page_with_the_token_gets_in(server_of_module: "Shared") -> None:
    async def test(visitors: Visitors) -> None:
        own = f"http://{visitors.host}"
        for token in ("", "wrong", visitors.token[:-1], visitors.token + "x"):
            with pytest.raises(InvalidStatus, match="401"):
                await visitors.connect(token)
        port = visitors.host.split(":")[1]
        for origin in (None, "null", "http://evil.example", f"https://{visitors.host}", f"http://localhost:{port}"):
            with pytest.raises(InvalidStatus, match="403"):
                await visitors.connect(origin=origin)
        status, answer = await visitors.get(Host=visitors.host)
        assert status == 200
        assert "Content-Security-Policy: default-src 'self'" in answer
        assert "X-Frame-Options: DENY" in answer
        assert visitors.token not in answer
        for host in ("evil.example", f"evil.example:{port}", "127.0.0.1", "127.0.0.1:1", ""):  # DNS rebinding
            assert (await visitors.get(Host=host))[0] == 421
        assert (await visitors.get())[0] == 421
        assert (await visitors.get(Host=visitors.host, Origin="http://evil.example"))[0] == 403
        assert (await visitors.get(Host=visitors.host, Origin=own))[0] == 200
        for path in ("/../server.py", "/%2e%2e/server.py", "//etc/passwd", "/page", "/socket2", "/index.html/"):
            assert (await visitors.get(path, Host=visitors.host))[0] == 404
        assert (await visitors.get(method="POST", Host=visitors.host))[0] == 405
        upgrade = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec_WebSocket_Version": "13"}
        key = {"Sec_WebSocket_Key": "dGhlIHNhbXBsZSBub25jZQ=="}
        protocols = {"Sec_WebSocket_Protocol": f"{SUBPROTOCOL}, {TOKEN_PREFIX}{visitors.token}"}
        good = {"Host": visitors.host, "Origin": own, **upgrade, **key, **protocols}
        assert (await visitors.get("/", **good))[0] == 404  # a WebSocket elsewhere
        assert (await visitors.get("/socket", **good | {"Host": f"evil.example:{port}"}))[0] == 421
        async with visitors.page() as page:
            assert page.connection.subprotocol == SUBPROTOCOL
            assert not page.yours

    server_of_module.run(test)


@pytest.mark.parametrize(
    ("message", "code"),
    [
        ("not json", 1007),
        ("[]", 1007),
        ("{}", 1007),
        ('{"type": "input"}', 1007),
        ('{"type": "fly"}', 1007),
        (json.dumps({"type": "input", "seq": 1, "at": 0, **STILL, "axes": [0.0] * 3}), 1007),
        (json.dumps({"type": "input", "seq": 1, "at": 0, **STILL, "axes": ["0"] * 4}), 1007),
        (json.dumps({"type": "input", "seq": -1, "at": 0, **STILL}), 1007),
        (json.dumps({"type": "input", "seq": 1, "at": 0, **STILL, "more": 1}), 1007),
        (json.dumps({"type": "do", "action": "describe", "text": "x" * 501}), 1007),
        (json.dumps({"type": "do", "action": "replay", "demo": 7}), 1007),
        (json.dumps({"type": "set", "speed": 1.5}), 1007),
        (json.dumps({"type": "do", "action": "__class__"}), 1007),
        ("[" * 60_000, 1007),
        (b"\x00binary", 1007),
        ("x" * 70_000, 1009),
    ],
)
def test_what_no_page_says_ends_the_connection(server_of_module: "Shared", message: str | bytes, code: int) -> None:
    async def test(visitors: Visitors) -> None:
        connection = await visitors.connect()
        await connection.send(message)
        await asyncio.wait_for(connection.wait_closed(), 5)
        assert connection.close_code == code

    server_of_module.run(test)


def test_a_flood_is_cut_off_and_disturbs_nobody(server_of_module: "Shared") -> None:
    async def test(visitors: Visitors) -> None:
        async with visitors.page() as driver:
            await driver.take()
            await driver.start_anew()
            driver.statuses.clear()
            given_up = driver.status["given_up"]
            driving = asyncio.create_task(driver.hold(AWAY, 1.0))
            assert await asyncio.to_thread(visitors.flood, 10_000) == 1008
            await driving
            moved = [each for each in driver.statuses if each["moving"]]
            assert moved
            assert {each["state"] for each in moved} <= {"ok", "slowed"}
            # The loop goes on; what other processes of a busy machine take from it within this second is not ours.
            assert driver.status["given_up"] - given_up < 0.5

    server_of_module.run(test)


def test_one_page_holds_control_until_it_gives_it_back_or_is_lost(server_of_module: "Shared") -> None:
    async def test(visitors: Visitors) -> None:
        async with visitors.page() as first, visitors.page() as second:
            await first.take()
            await first.start_anew()
            await second.say(type="control", action="take")
            refused = await second.until(lambda page: page.refusals)
            assert "another page holds control" in refused[0]
            await first.hold(STILL, 0.1)
            before = first.tool
            for _ in range(10):
                await second.input(AWAY)
            await second.say(type="do", action="record")
            await second.until(lambda page: len(page.refusals) > 1)
            assert "you are watching" in second.refusals[1]
            await first.hold(STILL, 0.2)
            assert first.tool == pytest.approx(before, abs=1e-6)  # a robot at rest in physics
            assert second.status["deck"]["mode"] == "idle"
            await first.say(type="control", action="release")
            await first.until(lambda page: not page.yours)
            await second.take()
            await second.hold(STILL, 0.1)
            await second.until(lambda page: page.tool[0] > before[0] + 0.01, saying=AWAY)
            await second.say(type="stop")
            await second.until(lambda page: page.status["stopped"], saying=STILL)
            await second.say(type="release")
            await second.until(lambda page: not page.status["stopped"], saying=STILL)
            await second.connection.close()
            await first.until(lambda page: page.latest["control"]["free"])
            assert first.status["reason"]
            await first.take()
            await first.say(type="stop")
            await first.until(lambda page: page.status["stopped"], saying=STILL)

    server_of_module.run(test)


def test_a_silent_page_that_holds_control_can_be_relieved(
    server_of_module: "Shared", monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("teleop.server.GIVEN_UP_AFTER", 0.3)

    async def test(visitors: Visitors) -> None:
        async with visitors.page() as first, visitors.page() as second:
            await first.take()
            await first.hold(STILL, 0.1)
            await asyncio.sleep(0.4)
            await second.take()
            await first.until(lambda page: not page.yours)

    server_of_module.run(test)


def test_the_emergency_stop_outlives_every_page(server_of_module: "Shared") -> None:
    async def test(visitors: Visitors) -> None:
        async with visitors.page() as watcher:
            async with visitors.page() as first:
                await first.take()
                await first.start_anew()
                await first.until(lambda page: page.status["executed"] > 0.1, saying=SIDEWAYS)
                await first.say(type="stop")
                await first.until(lambda page: page.status["stopped"], saying=SIDEWAYS)
                first.connection.transport.abort()
            await watcher.until(lambda page: page.latest["control"]["free"] and not page.status["moving"])
            await watcher.say(type="release")  # it does not hold control
            assert "take control first" in (await watcher.until(lambda page: page.refusals))[0]
            async with visitors.page() as second:
                await second.take()
                start = STILL | {"buttons": [float(name == "start") for name in BUTTONS]}
                await second.hold(start, 0.2)  # the gamepad's release, down already when this page takes control
                await second.hold(SIDEWAYS, 0.2)
                assert second.status["stopped"] and not second.status["moving"]
                assert second.status["reason"].startswith("emergency stop")
                await second.hold(start, 0.1)  # pressed anew, it is meant
                await second.until(lambda page: not page.status["stopped"], saying=SIDEWAYS)
                assert not second.status["moving"]  # the stick is still held
                await second.until(lambda page: page.status["state"] == "ok", saying=STILL)

    server_of_module.run(test)


def test_a_stop_reaches_a_loop_that_is_busy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """While a scene is set up nobody reads the channel: inputs are dropped when it is full, a stop waits."""
    server = PageServer(LoopSettings("board", None, 3, tmp_path))
    ours, theirs = Channel.pair()
    monkeypatch.setattr(server, "_channel", ours)
    loop = Channel(theirs)
    number = 0
    while ours.send(b"input"):
        number += 1
    for _ in range(3):  # once is enough
        server._send_surely({"type": "stop"})
    server._send_surely({"type": "lost", "reason": "gone"})
    server._send({"type": "input"}, None)  # nothing overtakes
    assert loop.receive() == [b"input"] * number
    server._hear()
    assert [orjson.loads(each) for each in loop.receive()] == [{"type": "stop"}, {"type": "lost", "reason": "gone"}]


def test_a_demo_is_recorded_described_kept_and_replayed_exactly(server_of_module: "Shared") -> None:
    async def test(visitors: Visitors) -> None:
        async with visitors.page() as page:
            await page.take()
            await page.start_anew()
            await page.say(type="do", action="record")
            await page.until(lambda page: page.status["deck"]["mode"] == "recording", saying=STILL)
            number = page.status["world"]
            await page.until(lambda page: int.from_bytes(page.geometry[4:8], "little") == number, saying=STILL)
            await page.hold(STILL, 0.1)
            await page.hold(AWAY, 0.5)
            await page.hold(STILL | {"buttons": [1.0] + [0.0] * 16}, 0.2)
            await page.say(type="do", action="describe", text="reach  away")
            await page.say(type="do", action="stop")
            await page.until(lambda page: page.status["deck"]["mode"] == "review", saying=STILL)
            assert page.status["deck"]["sentences"] == 1
            await page.say(type="do", action="describe", text="then close the gripper")
            await page.say(type="do", action="success")
            await page.say(type="do", action="keep")
            await page.until(lambda page: page.status["demos"], saying=STILL)
            (name,) = page.status["demos"]
            await page.say(type="do", action="replay", demo="../other.mcap")
            await page.until(lambda page: "there is no demo" in page.status["notices"][-1][2], saying=STILL)
            await page.say(type="do", action="replay", demo=name)
            await page.until(lambda page: page.status["deck"]["mode"] == "replaying", saying=STILL)
            await page.until(lambda page: page.status["deck"]["mode"] == "idle", saying=STILL)
            assert "largest difference from the recording 0 " in page.status["notices"][-1][2]

    server_of_module.run(test)
    from teleop import check_replay, load_demo

    (path,) = server_of_module.folder.glob("*.mcap")
    demo = load_demo(path)
    assert demo.utterances == ("reach away", "then close the gripper")
    assert demo.outcome.outcome == "success"
    assert check_replay(demo).max_error == 0.0


def test_a_recording_outlives_the_server(tmp_path: Path) -> None:
    async def test(visitors: Visitors) -> None:
        async with visitors.page() as page:
            await page.take()
            await page.say(type="do", action="record")
            await page.until(lambda page: page.status["deck"]["seconds"] > 0.3, saying=STILL)

    visited(test, tmp_path)
    from teleop import check_replay

    (path,) = tmp_path.glob("*.mcap")
    assert check_replay(path).success


def test_a_scene_that_cannot_be_says_so(tmp_path: Path) -> None:
    server = PageServer(LoopSettings("bord", None, 0, tmp_path))
    with pytest.raises(TeleopError, match="scene 'bord' is unknown"):
        asyncio.run(server.run(lambda url: None))


class Shared:
    """A server that the tests of this module share; each opens its own pages."""

    def __init__(self, visitors: Visitors, runner: asyncio.Runner, folder: Path) -> None:
        self.folder = folder
        self._visitors, self._runner = visitors, runner

    def run(self, test: Callable[[Visitors], Awaitable[None]]) -> None:
        async def limited() -> None:
            await asyncio.wait_for(test(self._visitors), 30)

        self._runner.run(limited())


@pytest.fixture(scope="module")
def server_of_module(tmp_path_factory: pytest.TempPathFactory) -> Any:
    folder = tmp_path_factory.mktemp("demos")
    server = PageServer(LoopSettings("board", None, 3, folder))
    with asyncio.Runner() as runner:
        serving: list[asyncio.Task[None]] = []

        async def start() -> None:
            ready: asyncio.Future[str] = asyncio.get_running_loop().create_future()
            serving.append(asyncio.create_task(server.run(ready.set_result)))
            await asyncio.wait((ready, serving[0]), return_when=asyncio.FIRST_COMPLETED)

        async def end() -> None:
            serving[0].cancel()
            await asyncio.gather(*serving, return_exceptions=True)

        runner.run(start())
        yield Shared(Visitors(server), runner, folder)
        runner.run(end())
