"""The command line `showtell`.

Each command lives in a module of `executor.commands` and imports what it needs itself, so that `showtell --help`
answers at once.
"""

from typing import Annotated

import typer

from executor.commands import (
    bench,
    demo,
    demos,
    describe,
    devices,
    do,
    evaluate,
    import_demos,
    inspect,
    learn,
    perceive,
    record,
    replay,
    robots,
    serve,
)
from executor.commands.output import ShowtellGroup

app = typer.Typer(
    name="showtell",
    cls=ShowtellGroup,
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    help="Show a virtual robot a task, tell it what you did, and it does what you tell it next.",
)


def _version(asked: bool) -> None:
    if asked:
        from importlib.metadata import PackageNotFoundError, version

        try:
            typer.echo(f"showtell {version('showtell')}")
        except PackageNotFoundError:  # run from a clone that is not installed
            typer.echo("showtell (not installed)")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and stop.")
    ] = False,
) -> None:
    """Show a virtual robot a task, tell it what you did, and it does what you tell it next."""


demo.add_to(app)
record.add_to(app)
serve.add_to(app)
app.add_typer(import_demos.app, name="import")
demos.add_to(app)
replay.add_to(app)
perceive.add_to(app)
learn.add_to(app)
inspect.add_to(app)
do.add_to(app)
describe.add_to(app)
app.add_typer(evaluate.app, name="evaluate")
app.add_typer(bench.app, name="bench")
devices.add_to(app)
robots.add_to(app)


def main() -> None:
    """Run the command line (the console script's entry point)."""
    app()


if __name__ == "__main__":
    main()
