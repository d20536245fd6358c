"""Which code recorded a demo: a digest of all that decides how its inputs move the robot."""

import hashlib
import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path

PARTS = ("robots", "twin", "teleop")
"""The packages between an input and a state; what is above them cannot change a replay."""
_SUFFIXES = {".py", ".toml", ".urdf", ".json"}
RECORDED_WITH = ("showtell", "pybullet", "pin", "coal", "ruckig", "numpy", "mcap")
"""Distributions whose versions are kept in a demo."""


@cache
def code_version() -> str:
    """The first 16 hexadecimal digits of a SHA-256 over the files of `PARTS`; the same wherever they are installed."""
    digest = hashlib.sha256()
    for part in PARTS:
        spec = find_spec(part)
        if spec is None or spec.origin is None:
            continue
        root = Path(spec.origin).parent
        for path in sorted(root.rglob("*")):
            if path.suffix in _SUFFIXES and path.is_file():
                digest.update(f"{part}/{path.relative_to(root).as_posix()}\0".encode())
                digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


@cache
def software_versions() -> dict[str, str]:
    """Versions of what recorded or replays, by distribution; `python` too."""
    return {**{name: version_of(name) for name in RECORDED_WITH}, "python": platform.python_version()}


def version_of(distribution: str) -> str:
    """The installed version of a distribution, in words if there is none."""
    try:
        return version(distribution)
    except PackageNotFoundError:
        return "not installed"


def differences(versions: dict[str, str], code: str) -> tuple[str, ...]:
    """What differs between the software that recorded a demo and what is here, one line each.

    Args:
        versions: Versions by distribution, from the demo.
        code: Its code version; empty where it was not kept.
    """
    here = software_versions()
    found = [
        f"recorded with {name} {there}, here is {here[name]}"
        for name, there in versions.items()
        if name in here and here[name] != there and name != "mcap"  # mcap stores, it moves nothing
    ]
    if not code:
        found.append("recorded by a version of Showtell that did not keep its code version")
    elif code != code_version():
        found.append(f"recorded with code {code}, here is {code_version()}")
    return tuple(found)
