"""What all commands share: where words, tables, figures and errors go.

With `--json` one JSON object goes to stdout and everything else to stderr; without it people read stdout. Progress bars
and errors are on stderr always.
"""

import json
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from robots.errors import ShowtellError

if TYPE_CHECKING:
    from rich.console import Console

Json = Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout, everything else on stderr.")]
Seed = Annotated[int, typer.Option("--seed", min=0, help="Seed of everything random.")]

FAILED = 1
"""Exit code of a task that could not be done."""
BAD_INPUT = 2
"""Exit code of wrong input."""
INTERRUPTED = 130
"""Exit code after Ctrl-C, as shells have it."""


class ShowtellGroup(TyperGroup):
    """A group of commands that tells errors in one line instead of a traceback."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command; a `ShowtellError` becomes one line on stderr and exit code 2, Ctrl-C exit code 130."""
        from twin.quiet import load_physics

        try:
            load_physics()
            return super().invoke(ctx)
        except (ShowtellError, OSError) as error:
            if isinstance(error, BrokenPipeError):
                raise
            typer.echo(f"showtell: error: {one_line(error)}", err=True)
            if "--json" in sys.argv[1:]:
                typer.echo(json.dumps({"error": one_line(error)}))
            raise typer.Exit(BAD_INPUT) from error
        except KeyboardInterrupt as error:
            typer.echo("showtell: interrupted", err=True)
            raise typer.Exit(INTERRUPTED) from error


def one_line(error: BaseException) -> str:
    """Return the message of an error without line breaks."""
    return " ".join(str(error).split()) or type(error).__name__


class Output:
    """Words and tables for people, or one JSON object for programs.

    Args:
        as_json: Whether stdout is for one JSON object.
    """

    def __init__(self, as_json: bool = False) -> None:
        self.as_json = as_json

    def console(self, err: bool = False) -> "Console":
        """Return a console on stdout (stderr with `--json` or `err`)."""
        from rich.console import Console

        return Console(stderr=self.as_json or err, highlight=False, soft_wrap=True)

    def say(self, text: str) -> None:
        """Print a line as it is."""
        typer.echo(text, err=self.as_json)

    def note(self, text: str) -> None:
        """Print a line on stderr."""
        typer.echo(text, err=True)

    def table(self, title: str, columns: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
        """Print a table; a cell is a string (shown as it is) or a Rich renderable."""
        from rich.table import Table
        from rich.text import Text

        table = Table(title=title, title_justify="left", header_style="bold")
        for column in columns:
            table.add_column(column, overflow="fold")
        for row in rows:
            table.add_row(*(cell if hasattr(cell, "__rich_console__") else Text(str(cell)) for cell in row))
        self.console().print(table)

    def result(self, values: dict[str, object]) -> None:
        """Print the JSON object, with `--json` only."""
        if self.as_json:
            sys.stdout.write(json.dumps(values, default=_plain) + "\n")
            sys.stdout.flush()

    @contextmanager
    def progress(self, description: str, total: int) -> Iterator[Callable[[], None]]:
        """Show a progress bar on stderr while the body runs; call what it yields once for every finished piece."""
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
        console = self.console(err=True)
        with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
            task = bar.add_task(description, total=total)
            yield lambda: bar.advance(task)


def _plain(value: object) -> object:
    """Turn NumPy values and paths into what JSON knows."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, Path):
        return str(value)
    raise TypeError(f"{type(value).__name__} has no JSON form")
