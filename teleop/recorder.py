"""The recorder: a demo is written to MCAP as it happens, in chunks that a crash cannot take back."""

import contextlib
import json
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Self

import orjson
from mcap.writer import CompressionType, Writer

from twin.scene_spec import SceneSpec
from twin.state import WorldState

from .demo_format import (
    COMMAND,
    FORMAT_VERSION,
    GAMEPAD,
    GRIPPER,
    JOINTS,
    METADATA,
    OBJECTS,
    SCHEMAS,
    UNITS,
    UTTERANCE,
    log_time,
)
from .errors import DemoError
from .gamepad import GamepadState
from .gamepad_mapping import GamepadMapping
from .servo import ServoResult

CHUNK_STEPS = 120
"""A chunk is closed and handed to the system after this many control steps: half a second."""
_RECORDED_WITH = ("showtell", "pybullet", "pin", "ruckig", "numpy", "mcap")


class Recorder:
    """Writes one demo. Use it with `with`: leaving through an exception keeps what was recorded, marked incomplete.

    Nothing about a state is computed here, so that recording does not slow control.
    """

    def __init__(self, path: Path, scene: SceneSpec, mapping: GamepadMapping, rate: int) -> None:
        """Open the file and write the metadata.

        Args:
            path: The demo; an existing file is replaced.
            scene: The scene the demo starts from.
            mapping: How the gamepad was mapped.
            rate: Control steps a second.

        Raises:
            DemoError: The file cannot be written.
        """
        self.path = path
        self._rate = rate
        self._step = 0
        self._closed = False
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = path.open("wb")
        except OSError as error:
            raise DemoError(f"{path}: cannot be written: {error.strerror}") from error
        self._writer: Any = Writer(self._file, chunk_size=1 << 20, compression=CompressionType.ZSTD)
        try:
            self._begin(scene, mapping)
        except OSError as error:
            raise self._failed(error) from error

    def __enter__(self) -> Self:
        """Nothing to do: a recorder is open from the start."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Finish the file, or keep what there is after an exception."""
        if kind is None:
            self.close()
        else:
            self.abandon()

    def utterance(self, text: str) -> None:
        """Record a sentence about the demo, at the present step."""
        self._write(UTTERANCE, self._step, {"step": self._step, "text": text})

    def control(self, step: int, gamepad: GamepadState, result: ServoResult, gripper_opening: float) -> None:
        """Record one control step: the input, what it asked for and what was executed.

        Raises:
            DemoError: The disk is full; what was written before is kept.
        """
        self._step = step
        self._write(GAMEPAD, step, {"step": step, "axes": gamepad.axes, "buttons": gamepad.buttons})
        self._write(
            COMMAND,
            step,
            {
                "step": step,
                "asked": result.asked,
                "executed": result.executed,
                "joint_velocity": result.joint_velocity,
                "gripper_opening": gripper_opening,
                "reason": str(result.reason),
            },
        )
        if (step + 1) % CHUNK_STEPS == 0:
            self._flush()

    def state(self, step: int, state: WorldState) -> None:
        """Record the state of the world before a step.

        Raises:
            DemoError: The disk is full; what was written before is kept.
        """
        self._step = step
        tool = state.pose_tool_in_world
        self._write(JOINTS, step, {"step": step, "time": state.time, "q": state.q, "dq": state.dq})
        self._write(
            GRIPPER,
            step,
            {
                "step": step,
                "position": tool.position,
                "orientation_xyzw": tool.orientation_xyzw,
                "opening": state.gripper_opening,
                "closed": state.gripper_closed,
                "held": state.held,
            },
        )
        poses = [each.pose_object_in_world for each in state.objects]
        self._write(
            OBJECTS,
            step,
            {
                "step": step,
                "ids": [each.id for each in state.objects],
                "positions": [pose.position for pose in poses],
                "orientations_xyzw": [pose.orientation_xyzw for pose in poses],
            },
        )

    def close(self) -> None:
        """Write the index and close; the demo is complete.

        Raises:
            DemoError: The disk is full; what was written before is kept.
        """
        if self._closed:
            return
        try:
            self._writer.finish()
            self._file.close()
        except OSError as error:
            raise self._failed(error) from error
        self._closed = True

    def abandon(self) -> None:
        """Close without the index, keeping what was recorded; the demo stays marked as incomplete."""
        if self._closed:
            return
        self._closed = True
        with contextlib.suppress(OSError):  # the disk may be what failed
            self._writer.flush()
        _close_quietly(self._file)

    def _begin(self, scene: SceneSpec, mapping: GamepadMapping) -> None:
        self._writer.start(profile="showtell", library=f"showtell {_version_of('showtell')}")
        versions = {name: _version_of(name) for name in _RECORDED_WITH}
        self._writer.add_metadata(
            METADATA,
            {
                "format": FORMAT_VERSION,
                "robot": scene.robot,
                "scene": scene.model_dump_json(),
                "seed": str(scene.seed),
                "rate": str(self._rate),
                "mapping": json.dumps(mapping.to_dict()),
                "units": json.dumps(UNITS),
                "versions": json.dumps(versions),
            },
        )
        self._channels = {
            topic: self._writer.register_channel(topic, "json", self._writer.register_schema(name, "jsonschema", data))
            for topic, (name, data) in SCHEMAS.items()
        }
        self._file.flush()

    def _write(self, topic: str, step: int, message: dict[str, object]) -> None:
        data = orjson.dumps(message, option=orjson.OPT_SERIALIZE_NUMPY)
        time = log_time(step, self._rate)
        try:
            self._writer.add_message(self._channels[topic], time, data, time, step)
        except OSError as error:
            raise self._failed(error) from error

    def _flush(self) -> None:
        try:
            self._writer.flush()
        except OSError as error:
            raise self._failed(error) from error

    def _failed(self, error: OSError) -> DemoError:
        """Close after a failed write and say what is left."""
        self._closed = True
        _close_quietly(self._file)
        return DemoError(
            f"{self.path}: cannot be written on: {error.strerror or error}; what was recorded until about "
            f"{self._step / self._rate:.1f} s is kept"
        )


def _close_quietly(file: IO[bytes]) -> None:
    """Close a file whose disk may be full; closing frees the handle even when the last flush fails."""
    with contextlib.suppress(OSError):
        file.close()


def _version_of(distribution: str) -> str:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return "not installed"
