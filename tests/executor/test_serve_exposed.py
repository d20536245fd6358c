"""`showtell serve` does not open itself to a network by accident: it says in one line what is missing."""

import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ([], "--host 0.0.0.0 can be reached from other machines: use 127.0.0.1, or add --expose with --cert and --key"),
        (["--expose"], "--expose needs TLS, or the token is read on the way to 0.0.0.0: add --cert and --key"),
    ],
)
def test_what_is_missing_is_said_in_one_line(arguments: list[str], told: str, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "executor.cli", "serve", "--host", "0.0.0.0", "-o", str(tmp_path / "demos")]
    done = subprocess.run([*command, *arguments], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert told in line
    assert not (tmp_path / "demos").exists()
