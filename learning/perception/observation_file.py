"""Observations on disk: one `.npz` file each, plain arrays, nothing pickled."""

import os
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from learning.errors import PerceptionError
from learning.perception.camera_observation import Perceived
from learning.perception.observation import Observation
from robots.pose import FloatArray

_FORMAT = "showtell observation 1"
_NEEDED = ("times", "gripper_location", "gripper_closed", "object_ids", "location", "colour", "shape")
_OPTIONAL = ("visible", "extent", "gripper_opening", "wrist_force")
_FEATURE = "feature_"


def save_observation(path: Path, perceived: Perceived) -> None:
    """Write an observation and its notes, whole or not at all.

    Raises:
        PerceptionError: It cannot be written; names the file.
    """
    seen = perceived.observation
    arrays: dict[str, NDArray[np.generic]] = {name: getattr(seen, name) for name in _NEEDED}
    arrays |= {name: getattr(seen, name) for name in _OPTIONAL if getattr(seen, name) is not None}
    arrays |= {_FEATURE + name: values for name, values in seen.features.items()}
    arrays["notes"] = np.array(perceived.notes, dtype=np.str_)
    arrays["format"] = np.array(_FORMAT)
    temporary = ""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(suffix=".partial", dir=path.parent)
        with os.fdopen(handle, "wb") as file:
            np.savez_compressed(file, allow_pickle=False, **arrays)
        os.replace(temporary, path)
    except OSError as error:
        raise PerceptionError(f"{path}: cannot be written: {error.strerror}") from error
    finally:
        if temporary:
            Path(temporary).unlink(missing_ok=True)


def load_observation(path: str | Path) -> Perceived:
    """Read an observation and its notes.

    Raises:
        PerceptionError: The file is missing, damaged or something else; names it.
    """
    try:
        with np.load(path, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
    except OSError as error:
        raise PerceptionError(f"{path}: cannot be read: {error.strerror or 'it is no .npz file'}") from error
    except Exception as error:  # zipfile, zlib and NumPy raise what they like on damaged files
        raise PerceptionError(f"{path}: damaged: {' '.join(str(error).split())}; delete it") from error
    missing = [name for name in (*_NEEDED, "notes", "format") if name not in arrays]
    if missing or str(arrays["format"]) != _FORMAT:
        raise PerceptionError(f"{path}: not an observation of this version; delete it to make it anew")
    for values in arrays.values():
        values.setflags(write=False)
    features: dict[str, FloatArray] = {
        name.removeprefix(_FEATURE): values for name, values in arrays.items() if name.startswith(_FEATURE)
    }
    seen = Observation(
        times=arrays["times"],
        gripper_location=arrays["gripper_location"],
        gripper_closed=arrays["gripper_closed"],
        object_ids=arrays["object_ids"],
        location=arrays["location"],
        colour=arrays["colour"],
        shape=arrays["shape"],
        visible=arrays.get("visible"),
        extent=arrays.get("extent"),
        gripper_opening=arrays.get("gripper_opening"),
        wrist_force=arrays.get("wrist_force"),
        features=features,
    )
    return Perceived(seen, tuple(map(str, arrays["notes"])))
