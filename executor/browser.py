"""A headless Chromium, driven over its DevTools protocol: for tests of the page and for measuring it."""

import asyncio
import base64
import contextlib
import itertools
import shutil
import tempfile
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import orjson
from websockets.asyncio.client import ClientConnection, connect

from executor.errors import ExecutorError

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
_FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-dev-shm-usage",
    "--disable-extensions",
    "--disable-sync",
    "--no-first-run",
    "--no-default-browser-check",
    "--mute-audio",
    "--remote-debugging-port=0",
)
_START = 30.0
_ANSWER = 30.0


class BrowserError(ExecutorError):
    """There is no Chromium, it does not start, or what it was told failed."""


def find_chromium() -> str | None:
    """Path of a Chromium, or None."""
    return next((found for name in NAMES if (found := shutil.which(name))), None)


class Tab:
    """One tab of a browser.

    Attributes:
        complaints: Errors of its console, exceptions that nothing caught, and requests that failed.
    """

    def __init__(self, connection: ClientConnection) -> None:
        """Take a connection to a tab."""
        self.complaints: list[str] = []
        self._connection = connection
        self._numbers = itertools.count(1)
        self._waiting: dict[int, asyncio.Future[dict[str, Any]]] = {}
        self._reader = asyncio.create_task(self._read())

    async def send(self, method: str, **parameters: object) -> dict[str, Any]:
        """Tell the browser something and wait for its answer.

        Raises:
            BrowserError: It says that this failed.
        """
        number = next(self._numbers)
        self._waiting[number] = asyncio.get_running_loop().create_future()
        await self._connection.send(orjson.dumps({"id": number, "method": method, "params": parameters}).decode())
        answer = await asyncio.wait_for(self._waiting[number], _ANSWER)
        if "error" in answer:
            raise BrowserError(f"{method}: {answer['error'].get('message', answer['error'])}")
        result: dict[str, Any] = answer["result"]
        return result

    async def start(self, width: int, height: int, *, phone: bool = False, first: str = "") -> None:
        """Set the size, and listen to complaints.

        Args:
            width: Of the window [pixel].
            height: Of the window [pixel].
            phone: Whether it has a touch screen.
            first: JavaScript to run in every page before its own.
        """
        for domain in ("Page", "Runtime", "Log", "Network"):
            await self.send(f"{domain}.enable")
        await self.resize(width, height, phone=phone)
        if first:
            await self.send("Page.addScriptToEvaluateOnNewDocument", source=first)

    async def resize(self, width: int, height: int, *, phone: bool = False) -> None:
        """Change the size of the window."""
        await self.send(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=phone
        )
        await self.send("Emulation.setTouchEmulationEnabled", enabled=phone)

    async def open(self, url: str) -> None:
        """Go to an address."""
        await self.send("Page.navigate", url=url)

    async def value(self, expression: str) -> Any:
        """Value of a JavaScript expression; a promise is waited for.

        Raises:
            BrowserError: It throws.
        """
        answer = await self.send("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise BrowserError(f"{expression}: {details.get('exception', {}).get('description', details['text'])}")
        return answer["result"].get("value")

    async def until(self, expression: str, seconds: float = 20.0) -> Any:
        """Wait until an expression is true, and return its value.

        Raises:
            BrowserError: It does not become true in time.
        """
        deadline = asyncio.get_running_loop().time() + seconds
        while not (value := await self.value(expression)):
            if asyncio.get_running_loop().time() > deadline:
                raise BrowserError(f"{expression} did not become true within {seconds:g} s; console: {self.complaints}")
            await asyncio.sleep(0.03)
        return value

    async def click(self, selector: str) -> None:
        """Click into the middle of an element with the mouse.

        Raises:
            BrowserError: There is none, or it is not to be seen.
        """
        where = await self.value(
            f"(() => {{ const e = document.querySelector({orjson.dumps(selector).decode()}); if (!e) return null;"
            "e.scrollIntoView({block: 'center'}); const b = e.getBoundingClientRect();"
            "return b.width ? [b.x + b.width / 2, b.y + b.height / 2] : null; })()"
        )
        if where is None:
            raise BrowserError(f"there is nothing to click at {selector}")
        for kind in ("mousePressed", "mouseReleased"):
            await self.send("Input.dispatchMouseEvent", type=kind, x=where[0], y=where[1], button="left", clickCount=1)

    async def key(self, kind: str, key: str, code: str) -> None:
        """Press (`keyDown`) or release (`keyUp`) a key."""
        await self.send("Input.dispatchKeyEvent", type=kind, key=key, code=code)

    async def type(self, text: str) -> None:
        """Type into what has the focus."""
        await self.send("Input.insertText", text=text)

    async def screenshot(self, path: Path) -> None:
        """Write what is seen into a PNG file."""
        answer = await self.send("Page.captureScreenshot", format="png")
        path.write_bytes(base64.b64decode(answer["data"]))

    async def close(self) -> None:
        """Let go of the tab."""
        self._reader.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await self._reader
        await self._connection.close()

    async def _read(self) -> None:
        async for data in self._connection:
            message = orjson.loads(data)
            if waiting := self._waiting.pop(message.get("id", 0), None):
                if not waiting.done():
                    waiting.set_result(message)
            elif complaint := _complaint(message.get("method", ""), message.get("params", {})):
                self.complaints.append(complaint)


class Browser:
    """A running headless Chromium; use it with `async with`."""

    def __init__(self, program: str | None = None) -> None:
        """Choose the program.

        Args:
            program: Path of a Chromium; None takes the one that is installed.

        Raises:
            BrowserError: None is installed.
        """
        found = program or find_chromium()
        if found is None:
            raise BrowserError(f"no browser was found ({', '.join(NAMES)}): on Debian run apt-get install -y chromium")
        self._program = found
        self._process: asyncio.subprocess.Process | None = None
        self._tabs: list[Tab] = []
        self._home = ""
        self._port = 0

    async def __aenter__(self) -> Self:
        """Start it with a profile of its own.

        Raises:
            BrowserError: It does not start.
        """
        self._home = tempfile.mkdtemp(prefix="showtell-browser-")
        quiet = asyncio.subprocess.DEVNULL
        self._process = await asyncio.create_subprocess_exec(
            self._program, *_FLAGS, f"--user-data-dir={self._home}", "about:blank", stdout=quiet, stderr=quiet
        )
        told = Path(self._home) / "DevToolsActivePort"
        for _ in range(int(_START / 0.05)):
            if told.is_file() and (lines := told.read_text().split()):
                self._port = int(lines[0])
                return self
            if self._process.returncode is not None:
                break
            await asyncio.sleep(0.05)
        await self.__aexit__(None, None, None)
        raise BrowserError(f"{self._program} did not start")

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End it and remove its profile."""
        for tab in self._tabs:
            with contextlib.suppress(Exception):
                await tab.close()
        if self._process is not None and self._process.returncode is None:
            self._process.terminate()
            try:
                await asyncio.wait_for(self._process.wait(), 5.0)
            except TimeoutError:
                self._process.kill()
                await self._process.wait()
        shutil.rmtree(self._home, ignore_errors=True)

    async def tab(self) -> Tab:
        """Open a new tab."""
        target = orjson.loads(await self._http("PUT", "/json/new?about:blank"))
        tab = Tab(await connect(target["webSocketDebuggerUrl"], max_size=None, compression=None))
        self._tabs.append(tab)
        return tab

    async def _http(self, method: str, path: str) -> bytes:
        reader, writer = await asyncio.open_connection("127.0.0.1", self._port)
        writer.write(f"{method} {path} HTTP/1.1\r\nHost: 127.0.0.1:{self._port}\r\nConnection: close\r\n\r\n".encode())
        await writer.drain()
        head = await reader.readuntil(b"\r\n\r\n")
        sizes = [line for line in head.split(b"\r\n") if line.lower().startswith(b"content-length:")]
        body = await reader.readexactly(int(sizes[0].split(b":")[1])) if sizes else await reader.read()
        writer.close()
        return body


def _complaint(method: str, parameters: dict[str, Any]) -> str:
    """What an event complains of; empty for others."""
    if method == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "assert"):
        return " ".join(str(each.get("value", each.get("description", ""))) for each in parameters["args"])
    if method == "Runtime.exceptionThrown":
        details = parameters["exceptionDetails"]
        return str(details.get("exception", {}).get("description", details["text"]))
    if method == "Log.entryAdded" and parameters["entry"]["level"] == "error":
        return str(parameters["entry"]["text"])
    if method == "Network.loadingFailed" and not parameters.get("canceled"):
        return f"a request failed: {parameters['errorText']}"
    return ""
