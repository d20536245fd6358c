"""Output files appear whole or not at all: written beside their place under another name, then moved into it."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from executor.errors import InputError


@contextmanager
def written_whole(path: Path) -> Iterator[Path]:
    """Yield a temporary path in the same folder; move it to `path` when the body succeeds, remove it otherwise.

    The temporary name keeps the suffix, so that libraries that choose a format by it still do.

    Raises:
        InputError: The folder does not exist, or `path` is a folder.
    """
    check_place(path)
    temporary = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        yield temporary
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def check_place(path: Path) -> None:
    """See before long work that a file can be written at `path`.

    Raises:
        InputError: The folder does not exist or is read-only, or `path` is a folder.
    """
    if path.is_dir():
        raise InputError(f"{path} is a folder; name a file")
    folder = path.absolute().parent
    if not folder.is_dir():
        raise InputError(f"the folder {folder} for {path.name} does not exist; create it first")
    if not os.access(folder, os.W_OK):
        raise InputError(f"the folder {folder} cannot be written to")


def existing(path: Path, what: str) -> Path:
    """Return `path` if it is there.

    Raises:
        InputError: It is not.
    """
    if not path.exists():
        raise InputError(f"{path}: no such {what}")
    return path


def new_folder(path: Path) -> Path:
    """Create a folder if it is not there yet, and return it.

    Raises:
        InputError: There is a file of that name, or the folder cannot be made or written to.
    """
    if path.exists() and not path.is_dir():
        raise InputError(f"{path} is a file; name a folder")
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"the folder {path} cannot be made: {error.strerror}") from error
    if not os.access(path, os.W_OK):
        raise InputError(f"the folder {path} cannot be written to")
    return path
