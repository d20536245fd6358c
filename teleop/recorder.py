"""The recorder: a demo is written to MCAP as it happens, in chunks that a crash cannot take back."""

import json
import time
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np
import orjson

from robots.model import RobotModel
from twin.scene_spec import SceneSpec
from twin.state import WorldState

from .code_version import code_version, software_versions
from .demo_events import EventKind, OutcomeKind, When
from .demo_file import start_file
from .demo_format import (
    ARMS,
    BASE,
    COMMAND,
    DRIVE,
    EVENT,
    EVENTS,
    FORMAT_VERSION,
    GAMEPAD,
    GRIPPER,
    HANDS,
    JOINTS,
    OBJECTS,
    OUTCOME,
    OUTCOMES,
    PRELUDE_DRIVE,
    UNITS,
    UTTERANCE,
    log_time,
)
from .disk_writer import DiskWriter
from .drive_command import DriveCommand
from .drive_track import command_to_message
from .errors import DemoError
from .event_watch import DriveOutcome, EventWatch, openings_of
from .gamepad import GamepadState
from .gamepad_mapping import GamepadMapping
from .servo import ServoResult

CHUNK_STEPS = 120
"""A chunk is closed and handed to the disk after this many control steps: half a second."""
CHUNK_NS = 500_000_000
"""It is closed after this much wall-clock time too, should control be slower than it ought to be [ns]."""
CLOSE_WITHIN = 30.0
"""How long `close` waits for the disk [s]."""
_CHUNK_BYTES = 1 << 20


class Recorder:
    """Writes one demo. Use it with `with`: leaving through an exception keeps what was recorded, marked incomplete.

    Nothing about a state is computed here and nothing waits for the disk, so that recording does not slow control. A
    disk that fails ends the recording and nothing else: `failed` says so, what was written stays, and further calls
    do nothing until `close` raises.

    Each message carries simulated time (MCAP's log time) and wall-clock time (its publish time).
    """

    def __init__(
        self,
        path: Path,
        scene: SceneSpec,
        mapping: GamepadMapping,
        rate: int,
        *,
        robot: RobotModel | None = None,
        details: Mapping[str, str] | None = None,
        exclusive: bool = False,
    ) -> None:
        """Open the file and write the metadata.

        Args:
            path: The demo; an existing file is replaced.
            scene: The scene the demo starts from.
            mapping: How the gamepad was mapped, for a demo that is driven through `Session`.
            rate: Control steps a second.
            robot: The robot; its joints are then named in the metadata, and its base is recorded where it moves.
            details: More metadata that a replay needs, such as the settings of the mapping and of the servo, by name.
            exclusive: Refuse a file that exists.

        Raises:
            DemoError: The file cannot be written, or exists and `exclusive` is set.
        """
        self.path = path
        self._rate = rate
        self._step = 0
        self._controlled = False
        self._closed = False
        self._chunk_began = 0
        self._chunks: list[tuple[int, int]] = []
        """Where each chunk ends in the file, and the step at which it was closed."""
        self._watch = EventWatch(rate)
        self._moves = robot is not None and robot.drive is not None
        self._arms = tuple(robot.arms) if robot is not None else ()
        # Wall-clock time that never jumps back: the clock's at the start, then that of a steady one.
        self._wall_offset = time.time_ns() - time.perf_counter_ns()
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._disk = DiskWriter(path, exclusive=exclusive)
        except OSError as error:
            raise DemoError(f"{path}: cannot be written: {error.strerror}") from error
        metadata = {
            "format": FORMAT_VERSION,
            "robot": scene.robot,
            "scene": scene.model_dump_json(),
            "seed": str(scene.seed),
            "rate": str(rate),
            "mapping": json.dumps(mapping.to_dict()),
            "units": json.dumps(UNITS),
            "versions": json.dumps(software_versions()),
            "code": code_version(),
            "started": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
            **_names(robot),
        }
        taken = sorted(set(metadata) & set(details or ()))
        if taken:
            self._disk.end()
            raise DemoError(f"details may not be named {', '.join(taken)}: these are the demo's own metadata")
        self._writer, self._channels = start_file(self._disk, {**metadata, **(details or {})}, _CHUNK_BYTES)
        self._disk.flush()
        self._disk.wait_written(CLOSE_WITHIN)
        if self.failed:
            self.abandon()
            raise DemoError(self.failed)

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

    @property
    def failed(self) -> str:
        """Why recording ended by itself, in one line; empty while all is well."""
        if not self._disk.failed:
            return ""
        kept = max((step for end, step in self._chunks if end <= self._disk.whole), default=0)
        return (
            f"{self.path}: cannot be written on: {self._disk.failed}; what was recorded until about "
            f"{kept / self._rate:.1f} s is kept"
        )

    @property
    def seconds(self) -> float:
        """Simulated time recorded so far [s]."""
        return self._step / self._rate

    @property
    def finished(self) -> bool:
        """Whether the file is written to its end and closed, or recording failed."""
        return self._disk.closed

    def utterance(self, text: str, when: When | None = None, language: str = "") -> None:
        """Record a sentence about the demo, at the present step.

        Args:
            text: The sentence.
            when: Before, during or after the demo; None takes before until control begins, then during.
            language: Tag of its language (BCP 47), where it is known.
        """
        said = when or ("during" if self._controlled else "before")
        message: dict[str, object] = {"step": self._step, "text": text, "when": said}
        self._write(UTTERANCE, self._step, message | ({"language": language} if language else {}))
        self._flush()

    def prelude(self, step: int, command: DriveCommand) -> None:
        """Record what was wanted in a step before the demo's first: a replay brings the scene to its start with it.

        The demo's own steps and states then count from its first step, and its `details` say so under `trim`.
        """
        self._write(PRELUDE_DRIVE, step, {"step": step, **command_to_message(command)})

    def event(self, kind: EventKind, text: str, arm: str = "") -> None:
        """Record that something happened, at the present step. `drive` notices most by itself.

        Raises:
            DemoError: There is no such kind of event.
        """
        if kind not in EVENTS:
            raise DemoError(f"an event cannot be of kind {kind!r}: use one of {', '.join(EVENTS)}")
        self._write(EVENT, self._step, {"step": self._step, "kind": kind, "text": text, "arm": arm})

    def outcome(self, outcome: OutcomeKind, note: str = "") -> None:
        """Record how the demo ended; the last word counts.

        Raises:
            DemoError: There is no such outcome.
        """
        if outcome not in OUTCOMES:
            raise DemoError(f"an outcome cannot be {outcome!r}: use one of {', '.join(OUTCOMES)}")
        self._write(OUTCOME, self._step, {"step": self._step, "outcome": outcome, "note": note})
        self._flush()

    def control(self, step: int, gamepad: GamepadState, result: ServoResult, gripper_opening: float) -> None:
        """Record one control step of `Session`: the input, what it asked for and what was executed."""
        self._begin_step(step)
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
        self._end_step(step)

    def drive(
        self, step: int, gamepad: GamepadState, command: DriveCommand, result: DriveOutcome, *, arrived: bool = True
    ) -> None:
        """Record one control step of a whole robot, and in words what changed since the last one.

        Args:
            step: Control step, counted from the scene's start.
            gamepad: What the device said; resting where it is none.
            command: What was wanted: a replay gives this to the servo.
            result: What the servo made of it.
            arrived: Whether the device said it since the last step; otherwise it said so earlier.
        """
        self._begin_step(step)
        openings = openings_of(result)
        arms = list(result.arms.values())
        first = arms[0]
        said = {"step": step, "axes": gamepad.axes, "buttons": gamepad.buttons, "arrived": arrived}
        self._write(GAMEPAD, step, said)
        self._write(DRIVE, step, {"step": step, **command_to_message(command)})
        self._write(
            COMMAND,
            step,
            {
                "step": step,
                "asked": first.asked,
                "executed": first.executed,
                "joint_velocity": result.joint_velocity,
                "gripper_opening": openings[0],
                "reason": str(first.reason),
            },
        )
        self._write(
            ARMS,
            step,
            {
                "step": step,
                "names": list(result.arms),
                "asked": [each.asked for each in arms],
                "executed": [each.executed for each in arms],
                "openings": openings,
                "reasons": [str(each.reason) for each in arms],
                "details": [each.detail for each in arms],
                "base_asked": result.base_asked,
                "base_executed": result.base_twist,
                "state": str(result.state),
                "reason": str(result.reason),
            },
        )
        for kind, text, arm in self._watch.after(step, command, result, arrived=arrived):
            self.event(kind, text, arm)
        self._end_step(step)

    def state(self, step: int, state: WorldState) -> None:
        """Record the state of the world before a step."""
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
        if state.arms and self._arms:
            self._hands(step, state)
        if self._moves and state.pose_base_in_world is not None:
            base = state.pose_base_in_world
            self._write(
                BASE, step, {"step": step, "position": base.position, "orientation_xyzw": base.orientation_xyzw}
            )
        if not self._controlled:
            self._flush()  # from here on the file can be read, whatever happens

    def flush(self) -> None:
        """Hand what was recorded so far to the disk; returns at once."""
        self._flush()

    def finish(self) -> None:
        """Write the index and let the disk finish; returns at once. `finished` tells when it is done."""
        if not self._closed:
            self._closed = True
            self._writer.finish()
            self._disk.end()

    def sync(self, timeout: float = CLOSE_WITHIN) -> bool:
        """Wait until the chunks so far are on the disk; False after `timeout` [s]. Not for control loops."""
        return self._disk.wait_written(timeout)

    def wait(self, timeout: float = CLOSE_WITHIN) -> bool:
        """After `finish`: wait until the file is closed; False after `timeout` [s]."""
        return self._disk.wait_closed(timeout)

    def close(self) -> None:
        """Finish, and wait until the demo is on the disk.

        Raises:
            DemoError: The disk failed; what was written before is kept.
        """
        if self._closed and self._disk.closed:
            return
        self.finish()
        if not self._disk.wait_closed(CLOSE_WITHIN):
            raise DemoError(f"{self.path}: the disk did not take the end of the demo within {CLOSE_WITHIN:.0f} s")
        if self.failed:
            raise DemoError(self.failed)

    def abandon(self) -> None:
        """Close without the index, keeping what was recorded; the demo stays marked as incomplete."""
        if self._closed:
            return
        self._closed = True
        self._writer.flush()
        self._disk.end()
        self._disk.wait_closed(CLOSE_WITHIN)

    def _hands(self, step: int, state: WorldState) -> None:
        tools = [arm.pose_tool_in_world for arm in state.arms]
        self._write(
            HANDS,
            step,
            {
                "step": step,
                "names": self._arms,
                "positions": [tool.position for tool in tools],
                "orientations_xyzw": [tool.orientation_xyzw for tool in tools],
                "openings": [arm.gripper_opening for arm in state.arms],
                "closed": [arm.gripper_closed for arm in state.arms],
                "held": [arm.held for arm in state.arms],
                "wrist_wrenches": [arm.wrist_wrench for arm in state.arms],
                "finger_efforts": [arm.finger_effort for arm in state.arms],
            },
        )

    def _begin_step(self, step: int) -> None:
        self._step = step
        self._controlled = True

    def _end_step(self, step: int) -> None:
        if (step + 1) % CHUNK_STEPS == 0 or time.perf_counter_ns() - self._chunk_began >= CHUNK_NS:
            self._flush()

    def _write(self, topic: str, step: int, message: dict[str, object]) -> None:
        if self._closed or self._disk.failed:
            return
        now = time.perf_counter_ns()
        if not self._chunk_began:
            self._chunk_began = now
        data = orjson.dumps(message, default=_plain, option=orjson.OPT_SERIALIZE_NUMPY)
        self._writer.add_message(self._channels[topic], log_time(step, self._rate), data, now + self._wall_offset, step)

    def _flush(self) -> None:
        """Close the chunk and hand it to the disk."""
        if not self._closed and not self._disk.failed:
            self._writer.flush()
            self._chunks.append((self._disk.tell(), self._step))
        self._chunk_began = 0


def _names(robot: RobotModel | None) -> dict[str, str]:
    """Metadata that name what the columns of the arrays are."""
    if robot is None:
        return {}
    arms = {name: list(arm.joint_names) for name, arm in robot.arms.items()}
    return {"joints": json.dumps(list(robot.joint_names)), "arms": json.dumps(arms)}


def _plain(value: object) -> object:
    """What orjson does not know: arrays that are not contiguous, and NumPy's numbers."""
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} cannot be written to a demo")
