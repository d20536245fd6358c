"""A recorded demo in memory."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from robots.pose import FloatArray
from twin.scene_spec import SceneSpec

from .demo_events import Event, Outcome, Sentence, Trim
from .drive_track import ArmsTrack, DriveTrack, HandsTrack
from .gamepad import GamepadState
from .gamepad_mapping import GamepadMapping


@dataclass(frozen=True, slots=True)
class InputTrack:
    """What the gamepad said at each of K control steps.

    Attributes:
        axes: (K, 4).
        buttons: (K, 17).
        arrived: Whether it came since the step before, (K,); else it is an earlier one. None where that was not kept.
    """

    axes: FloatArray
    buttons: FloatArray
    arrived: NDArray[np.bool_] | None = None

    def __len__(self) -> int:
        """Number of control steps, K."""
        return len(self.axes)

    def gamepad(self, step: int) -> GamepadState:
        """The state of the gamepad at a control step."""
        return GamepadState(tuple(self.axes[step].tolist()), tuple(self.buttons[step].tolist()))


@dataclass(frozen=True, slots=True)
class CommandTrack:
    """What was asked for and executed at each of K control steps.

    Attributes:
        asked: Twists along the axes of the world, (K, 6) [m/s, rad/s].
        executed: The same after all limits, (K, 6).
        joint_velocity: Executed joint velocities, (K, n) [rad/s].
        gripper_opening: Wanted gap between the fingers, (K,) [m].
        reasons: Why asked and executed differ, K texts; empty where they agree.
    """

    asked: FloatArray
    executed: FloatArray
    joint_velocity: FloatArray
    gripper_opening: FloatArray
    reasons: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class StateTrack:
    """True states of the world at T moments, for replay and scoring.

    Attributes:
        steps: Control step before which each state was taken, (T,).
        times: Simulated times, (T,) [s].
        q: Driven joint positions, (T, n) [rad].
        dq: Driven joint velocities, (T, n) [rad/s].
        tool: Tool frame in the world: position [m] and quaternion xyzw, (T, 7).
        gripper_opening: Measured gap between the fingers, (T,) [m].
        gripper_closed: Whether the gripper was told to close, (T,).
        held: Id of the object between the fingers, -1 for none, (T,).
        object_ids: Ids of the N objects, (N,).
        object_positions: Centres in the world, (T, N, 3) [m].
        object_orientations: Quaternions xyzw, (T, N, 4).
    """

    steps: NDArray[np.int64]
    times: FloatArray
    q: FloatArray
    dq: FloatArray
    tool: FloatArray
    gripper_opening: FloatArray
    gripper_closed: NDArray[np.bool_]
    held: NDArray[np.int64]
    object_ids: NDArray[np.int64]
    object_positions: FloatArray
    object_orientations: FloatArray


@dataclass(frozen=True, slots=True)
class Demo:
    """One recorded episode; all arrays are read-only.

    Attributes:
        path: The file it was read from.
        scene: What the scene was made of; the demo starts from it.
        mapping: How the gamepad was mapped to twists.
        rate: Control steps a second [Hz].
        utterances: The sentences that describe it.
        states: True states at 30 Hz.
        inputs: Gamepad at the control rate.
        commands: Commands at the control rate.
        versions: Versions of the software that recorded it, by distribution.
        complete: False where the file ends early (a crash, a full disk); all that was recovered is here.
        sentences: The utterances with the step at which each was said, and whether before, during or after.
        events: What happened: the servo slowed down or stopped, a device was lost, a gripper closed.
        outcome: How it ended, None where nobody said.
        wall_ns: Wall-clock time of each control step since 1970, (K,) [ns]; None where it was not kept.
        drive: What was wanted of the whole robot at the control rate; None for a demo driven through `Session`.
        arm_commands: Commands of all arms and the base at the control rate; None where there was no `drive`.
        hands: Hands of all arms at the moments of the states; None where they were not kept.
        base: The robot's base in the world: position [m] and quaternion xyzw, (T, 7); None where it does not move.
        prelude: A trimmed demo's inputs before its first step, from the scene's start; None where nothing was trimmed.
        trim: Where a trimmed demo was cut from.
        repaired: Whether the file ended early and was rewritten up to there.
        code: Version of the code that recorded it; empty where it was not kept.
        metadata: All metadata of the file.
    """

    path: Path
    scene: SceneSpec
    mapping: GamepadMapping
    rate: int
    utterances: tuple[str, ...]
    states: StateTrack
    inputs: InputTrack
    commands: CommandTrack
    versions: dict[str, str]
    complete: bool
    sentences: tuple[Sentence, ...] = ()
    events: tuple[Event, ...] = ()
    outcome: Outcome | None = None
    wall_ns: NDArray[np.int64] | None = None
    drive: DriveTrack | None = None
    arm_commands: ArmsTrack | None = None
    hands: HandsTrack | None = None
    base: FloatArray | None = None
    prelude: InputTrack | DriveTrack | None = None
    trim: Trim | None = None
    repaired: bool = False
    code: str = ""
    metadata: Mapping[str, str] = field(default_factory=dict)

    @property
    def times(self) -> FloatArray:
        """Times of the states, (T,) [s]."""
        return self.states.times

    def utterances_in(self, language: str) -> tuple[str, ...]:
        """The sentences in a language, in order; those whose language nobody said count as in any.

        Args:
            language: Its tag (BCP 47), such as `en`; it stands for all its regions and scripts too, such as `en-GB`.
        """
        wanted = language.lower()
        tags = [(each.text, each.language.lower()) for each in self.sentences]
        return tuple(text for text, tag in tags if tag in ("", wanted) or tag.startswith(f"{wanted}-"))

    @property
    def duration(self) -> float:
        """Time between the first and the last state [s]."""
        return float(self.states.times[-1] - self.states.times[0])
