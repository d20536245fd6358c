"""The sidecar with what is true of a demo. Only evaluation opens it; the learner never does (design section 7)."""

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .errors import DemoError


def truth_path(demo: str | Path) -> Path:
    """Where the truth of a demo lies: `x.mcap` has `x.truth.json`."""
    return Path(demo).with_suffix(".truth.json")


def write_truth(demo: str | Path, truth: Mapping[str, Any]) -> None:
    """Write the truth of a demo, whole or not at all.

    Raises:
        DemoError: It cannot be written.
    """
    path = truth_path(demo)
    temporary = path.with_name(path.name + ".partial")
    try:
        temporary.write_text(json.dumps(truth, indent=1, sort_keys=True) + "\n", encoding="utf-8")
        os.replace(temporary, path)
    except OSError as error:
        raise DemoError(f"{path}: cannot be written: {error.strerror}") from error


def read_truth(demo: str | Path) -> dict[str, Any]:
    """Read the truth of a demo, for scoring.

    Raises:
        DemoError: It is missing or not a JSON object.
    """
    path = truth_path(demo)
    try:
        truth = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise DemoError(f"{path}: cannot be read: {error.strerror}") from error
    except ValueError as error:
        raise DemoError(f"{path}: not JSON: {error}") from error
    if not isinstance(truth, dict):
        raise DemoError(f"{path}: expected a JSON object, got {type(truth).__name__}")
    return truth
