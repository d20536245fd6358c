"""What buttons do to the state of driving: choosing arms, frames and joints, speed, and the emergency stop."""

from collections.abc import Mapping
from dataclasses import replace

from .button_reader import Presses
from .drive_command import TwistFrame
from .drive_state import RECORDING, SPEED_STEPS, DriveEvent, DriveState

ARM_CHOICES = {"choose_left": ("left",), "choose_right": ("right",), "choose_both": ("left", "right")}
"""The arms that an action chooses by name."""


def act(
    state: DriveState, presses: Presses, arms: Mapping[str, int], frames: tuple[TwistFrame, ...]
) -> tuple[DriveState, tuple[DriveEvent, ...]]:
    """Apply what was pressed.

    While the emergency stop holds, buttons only release it and label what is recorded.

    Args:
        state: What is remembered of before.
        presses: What the buttons say.
        arms: Joints of each arm of the robot.
        frames: Frames to go through.

    Returns:
        The new state, not armed when something else will move from now on; and what happened.
    """
    fired = presses.fired
    new = replace(state, held=presses.pressed, spent=presses.spent, seen=True)
    if "stop" in presses.held:
        return replace(new, stopped=True, armed=False), () if state.stopped else (DriveEvent("stop"),)
    if state.stopped and "release" in fired:
        return replace(new, stopped=False, armed=False), (DriveEvent("release"),)
    if not fired:
        return new, ()
    labels = tuple(DriveEvent(name) for name in RECORDING if name in fired)
    if state.stopped:
        return new, labels
    new = replace(new, arms=_arms(new, fired, tuple(arms)), frame=_frame(new, fired, frames))
    if "mode" in fired:
        new = replace(new, mode="base" if new.mode == "arm" else "arm")
    if "jog" in fired:
        new = replace(new, jogging=not new.jogging)
    new = replace(new, joint=_joint(new, fired, arms), speed_ratio=_speed(new, fired))
    changes = _changes(state, new)
    if changes:
        new = replace(new, armed=False)
    if new.speed_ratio != state.speed_ratio:
        changes += (DriveEvent("speed", f"{new.speed_ratio:g}"),)
    return new, labels + changes


def _arms(state: DriveState, fired: frozenset[str], names: tuple[str, ...]) -> tuple[str, ...]:
    arms = state.arms
    for action, chosen in ARM_CHOICES.items():
        if action in fired:
            arms = chosen
    if "next_arm" in fired:
        arms = (names[(names.index(arms[-1]) + 1) % len(names)],)
    return arms


def _frame(state: DriveState, fired: frozenset[str], frames: tuple[TwistFrame, ...]) -> TwistFrame:
    if "frame" not in fired:
        return state.frame
    place = frames.index(state.frame) if state.frame in frames else -1
    return frames[(place + 1) % len(frames)]


def _joint(state: DriveState, fired: frozenset[str], arms: Mapping[str, int]) -> int:
    """The joint to jog: one that every chosen arm has."""
    joints = min(arms[name] for name in state.arms)
    turn = ("joint_next" in fired) - ("joint_previous" in fired) if state.jogging and state.mode == "arm" else 0
    return (min(state.joint, joints - 1) + turn) % joints


def _speed(state: DriveState, fired: frozenset[str]) -> float:
    """The next speed ratio up or down."""
    ratio = state.speed_ratio
    if "speed_up" in fired:
        ratio = next((step for step in SPEED_STEPS if step > ratio + 1e-9), SPEED_STEPS[-1])
    if "speed_down" in fired:
        ratio = next((step for step in reversed(SPEED_STEPS) if step < ratio - 1e-9), SPEED_STEPS[0])
    return ratio


def _changes(old: DriveState, new: DriveState) -> tuple[DriveEvent, ...]:
    """What the sticks move from now on, where it differs."""
    changes = []
    if new.arms != old.arms:
        changes.append(DriveEvent("arms", " and ".join(new.arms)))
    if new.mode != old.mode:
        changes.append(DriveEvent("mode", new.mode))
    if new.jogging != old.jogging:
        changes.append(DriveEvent("jog", "on" if new.jogging else "off"))
    if new.joint != old.joint:
        changes.append(DriveEvent("joint", str(new.joint)))
    if new.frame != old.frame:
        changes.append(DriveEvent("frame", new.frame))
    return tuple(changes)
