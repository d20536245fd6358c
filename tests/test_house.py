"""The house itself: public names, packaging and the door to the command line. `tests/docs` reads the papers."""

import importlib
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from packaging.requirements import Requirement

REPOSITORY = Path(__file__).resolve().parent.parent
FLOORS = ("robots", "twin", "teleop", "learning", "executor")
HEAVY = (
    "coal",
    "highspy",
    "moderngl",
    "numba",
    "ompl",
    "open3d",
    "pinocchio",
    "pulp",
    "pybullet",
    "pygame",
    "ruckig",
    "scipy",
    "sklearn",
    "trimesh",
)


def packages() -> Iterator[str]:
    for floor in FLOORS:
        for file in sorted((REPOSITORY / floor).rglob("__init__.py")):
            yield ".".join(file.parent.relative_to(REPOSITORY).parts)


def project() -> dict[str, object]:
    return tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))


def python(code: str) -> str:
    """Run code in a fresh interpreter at the repository's root and return what it prints."""
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=REPOSITORY, capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.mark.parametrize("name", list(packages()))
def test_public_names_resolve(name: str) -> None:
    module = importlib.import_module(name)
    assert module.__doc__, f"{name} does not say what it offers"
    for public in getattr(module, "__all__", ()):
        assert getattr(module, public) is not None


@pytest.mark.parametrize("floor", FLOORS)
def test_floors_offer_names_and_types(floor: str) -> None:
    assert importlib.import_module(floor).__all__
    assert (REPOSITORY / floor / "py.typed").exists()


def test_every_package_is_listed() -> None:
    listed = project()["tool"]["setuptools"]["packages"]  # type: ignore[index]
    assert sorted(listed) == sorted(packages())
    with_code = {
        ".".join(file.parent.relative_to(REPOSITORY).parts) for f in FLOORS for file in (REPOSITORY / f).rglob("*.py")
    }
    assert with_code == set(listed), "a folder with code has no __init__.py"


def test_data_files_are_in_the_package() -> None:
    """Every file beside the code is matched by a package-data pattern, so that the wheel has it."""
    patterns = project()["tool"]["setuptools"]["package-data"]  # type: ignore[index]
    listed = project()["tool"]["setuptools"]["packages"]  # type: ignore[index]
    packed = {
        file
        for package in listed
        for pattern in [*patterns["*"], *patterns.get(package, [])]
        for file in (REPOSITORY / Path(*package.split("."))).glob(pattern)
    }
    for floor in FLOORS:
        for file in (REPOSITORY / floor).rglob("*"):
            if file.is_file() and file.suffix != ".py" and file.parent.name != "__pycache__":
                assert file in packed, f"{file.relative_to(REPOSITORY)} would be missing from the wheel"


@pytest.mark.parametrize("arguments", [["--help"], ["record", "--help"], ["evaluate", "--help"]])
def test_the_command_line_answers(arguments: list[str]) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "executor.cli", *arguments],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "Usage" in done.stdout


def test_the_command_line_imports_nothing_heavy() -> None:
    loaded = python(f"import executor.cli, sys; print([name for name in {HEAVY!r} if name in sys.modules])")
    assert loaded == "[]"


def test_floors_import_nothing_heavy() -> None:
    code = f"import sys, {', '.join(FLOORS)}; print([name for name in {HEAVY!r} if name in sys.modules])"
    assert python(code) == "[]"


def test_constraints_pin_versions_and_name_no_host() -> None:
    lines = (REPOSITORY / "constraints.txt").read_text(encoding="utf-8").splitlines()
    pins = [line for line in lines if line and not line.startswith("#")]
    assert all(re.fullmatch(r"[A-Za-z0-9._-]+==[A-Za-z0-9.+!]+", pin) for pin in pins)
    pinned = {pin.split("==")[0].lower().replace("_", "-") for pin in pins}
    table = project()["project"]
    wanted = [*table["dependencies"], *table["optional-dependencies"]["dev"]]  # type: ignore[index]
    assert {Requirement(text).name.lower() for text in wanted} <= pinned
