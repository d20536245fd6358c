"""Commands that someone else wrote, in a file: one a line, columns with tabs between them."""

from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from executor.errors import InputError

Read = TypeVar("Read")


def read_lines(path: Path, make: Callable[[int, list[str]], Read], form: str) -> list[Read]:
    """Read commands; empty lines and lines that begin with `#` are passed over.

    Args:
        path: The file.
        make: Makes a command from the number of its line, counted from 1, and its columns; raises ValueError,
            IndexError or StopIteration for what has another form.
        form: What a line should be, for messages.

    Raises:
        InputError: The file cannot be read, holds no command, or a line has another form; names it.
    """
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    found = []
    for row, line in enumerate(lines, start=1):
        if not line.strip() or line.startswith("#"):
            continue
        try:
            found.append(make(row, [field.strip() for field in line.split("\t")]))
        except (ValueError, IndexError, StopIteration):
            raise InputError(f"{path}, line {row}: {line!r} is not {form}") from None
    if not found:
        raise InputError(f"{path}: holds no command")
    return found
