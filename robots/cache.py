"""Where files that can be made again are kept: the user's cache, or a folder of this process where that fails."""

import atexit
import functools
import os
import shutil
import tempfile
from pathlib import Path


def user_folder(kind: str) -> Path:
    """The user's cache for one kind of files: in `$XDG_CACHE_HOME`, `~/.cache` without the variable. Not made here."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "showtell" / kind


@functools.cache
def own_folder(kind: str) -> Path:
    """A folder of this process for one kind of files, deleted at its end: for where the user's cannot be written."""
    folder = Path(tempfile.mkdtemp(prefix=f"showtell-{kind}-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def write_whole(path: Path, text: str) -> Path:
    """Write a file that appears whole or not at all, its folder too, and return its path.

    Raises:
        OSError: It cannot be written.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(suffix=path.suffix, dir=path.parent)
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
        os.replace(temporary, path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
    return path
