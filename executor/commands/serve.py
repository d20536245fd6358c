"""`showtell serve`: the page with the live robot."""

from pathlib import Path
from typing import Annotated

import typer

from executor.commands.output import Json, Output, Seed

_BENCH_SECONDS = 8.0


def serve(
    scene: Annotated[str, typer.Option(help="board, board-all, tabletop, ordering, or a scene's TOML file.")] = "board",
    robot: Annotated[str | None, typer.Option(help="Robot to use instead of the scene's own.")] = None,
    demos: Annotated[Path, typer.Option("--output", "-o", help="Folder in which demos are written and found.")] = (
        Path("demos")
    ),
    knowledge: Annotated[
        Path | None,
        typer.Option(help="Knowledge to start from and learn into; knowledge.json in the demos' folder if left out."),
    ] = None,
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port; 0 takes a free one.")] = 8765,
    host: Annotated[str, typer.Option(help="Address to listen at; another than this machine's own needs --expose.")] = (
        "127.0.0.1"
    ),
    expose: Annotated[bool, typer.Option("--expose", help="Let other machines in, with TLS.")] = False,
    cert: Annotated[Path | None, typer.Option(help="TLS certificate (PEM).")] = None,
    key: Annotated[Path | None, typer.Option(help="Its private key (PEM).")] = None,
    name: Annotated[list[str] | None, typer.Option(help="A name under which the page is reached; repeatable.")] = None,
    bench: Annotated[bool, typer.Option("--bench", help="Drive it with a headless Chromium and print latencies.")] = (
        False
    ),
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Serve the page: show the live twin a task, tell it what you did, and have it do what you tell it next.

    Drive with a gamepad or the keyboard, record, describe, have it learned, type a command and watch it. Open the
    printed address: its token lets this browser in, and nobody else.

    Example: showtell serve --scene board -o demos/

    Example: showtell serve --scene tabletop --knowledge knowledge.json
    """
    import asyncio
    import signal

    from executor.errors import InputError
    from executor.talk.serving import talk_files, talking
    from teleop.loop_process import LoopSettings
    from teleop.server import PageServer
    from teleop.server_door import check_exposure, tls_context

    out = Output(as_json)
    context = tls_context(cert, key)
    check_exposure(host, expose, context)
    if demos.exists() and not demos.is_dir():
        raise InputError(f"{demos} is not a folder: demos are written into one")
    demos.mkdir(parents=True, exist_ok=True)
    settings = LoopSettings(scene, robot, seed, demos)
    if bench:
        from executor.bench.page import bench_page

        report = asyncio.run(bench_page(settings, _BENCH_SECONDS))
        out.table("Page: from input to joint command", ("figure", "value"), report.rows())
        out.result(report.values())
        return
    learned = knowledge or demos / "knowledge.json"
    server = PageServer(
        talking(settings, learned), host=host, port=port, names=name or (), context=context, files=talk_files()
    )

    def started(url: str) -> None:
        out.say(f"The page is at {url}")
        new = "" if learned.exists() else ", which the first lesson makes"
        out.say(f"Demos are in {demos}, what is learned in {learned}{new}. Ctrl-C ends.")
        out.result({"url": url, "demos": demos, "knowledge": learned})

    async def run() -> None:
        task = asyncio.ensure_future(server.run(started))
        for number in (signal.SIGINT, signal.SIGTERM):  # the usual way to end it is no error
            asyncio.get_running_loop().add_signal_handler(number, task.cancel)
        try:
            await task
        except asyncio.CancelledError:
            out.note("ended")

    asyncio.run(run())


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(serve)
