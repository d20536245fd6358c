"""Finding and opening recorded demos for the commands."""

import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from executor.errors import InputError

if TYPE_CHECKING:
    from teleop import Demo

SUFFIX = ".mcap"


def demo_paths(where: Path) -> list[Path]:
    """Demos of a folder in the order of their names, or the one demo that `where` is.

    Raises:
        InputError: There is none.
    """
    if where.is_dir():
        paths = sorted(where.glob(f"*{SUFFIX}"))
        if not paths:
            raise InputError(f"{where}: holds no demo (*{SUFFIX}); record some with `showtell record`")
        return paths
    if not where.exists():
        raise InputError(f"{where}: no such demo or folder of demos")
    return [where]


def read_demo(path: Path) -> "Demo":
    """Read a demo without a word about one that ends early (`Demo.complete` tells).

    Raises:
        DemoError: The file is not a demo; names it.
    """
    from teleop import load_demo

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return load_demo(path)


def open_demo(path: Path) -> "Demo":
    """Read a whole demo.

    Raises:
        DemoError: The file is not a demo; names it.
        InputError: It ends early.
    """
    demo = read_demo(path)
    if not demo.complete:
        raise InputError(
            f"{path}: the demo ends early, after {demo.duration:.1f} s; record it again, or use --skip-broken"
        )
    return demo
