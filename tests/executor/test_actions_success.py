"""The rules of success: what counts as done, and what does not."""

from dataclasses import replace

import numpy as np
import pytest

from executor.actions.success import RULES, fault_of
from executor.actions.witness import Evidence
from robots.pose import FloatArray, Pose
from twin.state import ObjectState, WorldState

COUNT = 60
UPRIGHT = (0.0, 0.0, 0.0, 1.0)
LYING = (float(np.sin(np.pi / 4)), 0.0, 0.0, float(np.cos(np.pi / 4)))


def world(place: tuple[float, float, float], turn: tuple[float, ...] = UPRIGHT, other: float = 0.0) -> WorldState:
    """Object 0 at a place, and object 1 moved along x [m]."""
    return WorldState(
        time=0.0,
        q=np.zeros(1),
        dq=np.zeros(1),
        gripper_opening=0.0,
        gripper_closed=True,
        pose_tool_in_world=Pose(np.zeros(3), np.array(UPRIGHT)),
        objects=(
            ObjectState(0, Pose(np.array(place), np.array(turn))),
            ObjectState(1, Pose(np.array([1.0 + other, 0.0, 0.0]), np.array(UPRIGHT))),
        ),
        held=None,
    )


def seen(
    start: tuple[float, float, float] = (0.5, 0.0, 0.05),
    end: tuple[float, float, float] = (0.5, 0.0, 0.05),
    clear: tuple[float, float] = (0.0, 0.0),
    held: bool = False,
    open_from: int | None = None,
    force: float = 0.0,
    seconds: float = 3.0,
) -> Evidence:
    """Evidence of an object that moves evenly, over `COUNT` samples."""
    share = np.linspace(0.0, 1.0, COUNT)[:, None]
    forces: FloatArray = np.zeros((COUNT, 3))
    forces[:, 2] = -8.0
    forces[COUNT // 2, 2] += force
    closed = np.ones(COUNT, dtype=bool)
    if open_from is not None:
        closed[open_from:] = False
    return Evidence(
        object_id=0,
        before=world(start),
        after=world(end),
        times=np.linspace(0.0, seconds, COUNT),
        centre=np.array(start) + share * (np.array(end) - np.array(start)),
        clear=np.linspace(*clear, COUNT),
        between=np.full(COUNT, held),
        closed=closed,
        wrist_force=forces,
        clear_after=clear[1],
        held_after=held,
    )


AIR = (0.5, 0.0, 0.15)
GOAL = np.array([0.6, 0.1, 0.05])
THERE = (0.6, 0.1, 0.05)
DONE: dict[str, Evidence] = {
    "pick up": seen(end=AIR, clear=(0.0, 0.1), held=True),
    "put down": seen(AIR, THERE, (0.1, 0.0), open_from=40),
    "move": seen(end=THERE, open_from=40),
    "grasp": seen(held=True),
    "lift": seen(end=AIR, clear=(0.0, 0.06), held=True),
    "lower": seen(AIR, THERE, (0.1, 0.004), held=True),
    "drop": seen(AIR, clear=(0.1, 0.0), open_from=5),
    "press": seen(force=6.0),
    "push": seen(end=(0.55, 0.0, 0.05)),
    "hold": seen(AIR, AIR, (0.1, 0.1), held=True),
}
NOT_DONE = [
    ("pick up", seen(end=AIR, clear=(0.0, 0.1)), "not held"),
    ("pick up", seen(clear=(0.0, 0.01), held=True), "not clear: 10 mm"),
    ("put down", seen(AIR, THERE, (0.1, 0.0), held=True), "not let go"),
    ("put down", seen(AIR, (0.7, 0.1, 0.05), (0.1, 0.0), open_from=40), "misplaced: 100 mm"),
    ("put down", seen(AIR, THERE, (0.1, 0.05), open_from=40), "not down: 50 mm"),
    ("move", replace(DONE["move"], after=world(THERE, LYING)), "toppled"),
    ("move", replace(DONE["move"], after=world(THERE, other=0.04)), "disturbed: another object was moved by 40 mm"),
    ("grasp", seen(end=AIR, clear=(0.0, 0.1), held=True), "lifted: 100 mm"),
    ("lift", seen(end=AIR, clear=(0.0, 0.045), held=True), "not lifted: 45 mm"),
    ("lower", seen(AIR, clear=(0.1, 0.0)), "not held"),
    ("lower", seen(clear=(0.0, 0.0), held=True), "not raised"),
    ("drop", seen(AIR, clear=(0.1, 0.0)), "not let go"),
    ("drop", seen(clear=(0.0, 0.0), open_from=5), "not in the air"),
    ("press", seen(force=1.0), "not pressed: at most 1.0 N"),
    ("press", seen(end=(0.52, 0.0, 0.05), force=6.0), "moved: the pressed object by 20 mm"),
    ("push", seen(end=(0.52, 0.0, 0.05)), "not pushed: moved by 20 mm"),
    ("push", seen(end=(0.55, 0.0, 0.09), clear=(0.0, 0.04)), "lifted"),
    ("hold", seen(AIR, (0.5, 0.02, 0.15), (0.1, 0.1), held=True), "not still"),
    ("hold", seen(AIR, AIR, (0.1, 0.1), held=True, seconds=1.0), "too short: held for 1.0 s"),
    ("hold", seen(clear=(0.0, 0.0), held=True), "not held"),
]


@pytest.mark.parametrize("action", list(RULES))
def test_an_action_that_was_done_has_no_fault(action: str) -> None:
    assert fault_of(action, DONE[action], GOAL) == ""


@pytest.mark.parametrize(("action", "evidence", "fault"), NOT_DONE)
def test_what_was_not_done_is_told(action: str, evidence: Evidence, fault: str) -> None:
    assert fault_of(action, evidence, GOAL).startswith(fault)
