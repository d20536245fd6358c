"""Small recordings at a table for tests: the arm moves as told, and things move as told, without physics."""

from functools import cache
from pathlib import Path

import numpy as np

from robots import load_robot
from robots.pose import FloatArray
from teleop import Demo, GamepadMapping
from teleop.demo import CommandTrack, InputTrack, StateTrack
from teleop.drive_track import HandsTrack
from twin import SceneSpec
from twin.scene_spec import ObjectSpec

RATE = 30
"""Recorded states a second."""
robot = cache(load_robot)


def table(*things: tuple[str, float, float], robot_name: str = "mico_segway", kind: str = "table") -> SceneSpec:
    """A scene with things of a catalogue at places (x, y) on the table."""
    placed = []
    for number, (name, x, y) in enumerate(things):
        height = ObjectSpec.of_model(number, name, (x, y, 1.0)).half_extents[2]
        placed.append(ObjectSpec.of_model(number, name, (x, y, height)))
    return SceneSpec.model_validate({"name": "test", "kind": kind, "robot": robot_name, "objects": placed})


def demo_of(
    spec: SceneSpec,
    positions: FloatArray,
    q: FloatArray | None = None,
    opening: FloatArray | None = None,
    closed: FloatArray | None = None,
    force: FloatArray | None = None,
) -> Demo:
    """A demo of T states: object centres (T, N, 3), joints (T, n), finger gap (T,), told closed (T,), force (T, 3)."""
    body = robot(spec.robot)
    count, arms = len(positions), tuple(body.arms)
    q = np.tile(body.home, (count, 1)) if q is None else q
    first = body.arms[arms[0]]
    gap = np.full(count, first.gripper.max_opening) if opening is None else opening
    shut = np.zeros(count, dtype=bool) if closed is None else np.asarray(closed, dtype=bool)
    tools = np.zeros((count, len(arms), 7))
    for number, (name, arm) in enumerate(body.arms.items()):
        for step in range(count):
            pose = arm.forward_kinematics(q[step, body.slice_of(name)])
            tools[step, number] = np.concatenate((pose.position, pose.orientation_xyzw))
    gaps = np.column_stack([gap] * len(arms))
    wrenches = np.zeros((count, len(arms), 6))
    if force is not None:
        wrenches[:, 0, :3] = force
    number = len(spec.objects)
    states = StateTrack(
        steps=8 * np.arange(count), times=np.arange(count) / RATE, q=q, dq=np.zeros_like(q), tool=tools[:, 0],
        gripper_opening=gap, gripper_closed=shut, held=np.full(count, -1),
        object_ids=np.array([each.id for each in spec.objects], dtype=np.int64),
        object_positions=positions.reshape(count, number, 3),
        object_orientations=np.tile([0.0, 0.0, 0.0, 1.0], (count, number, 1)),
    )  # fmt: skip
    hands = HandsTrack(
        names=arms, tools=tools, openings=gaps, closed=np.column_stack([shut] * len(arms)),
        held=np.full((count, len(arms)), -1), wrist_wrenches=wrenches, finger_efforts=np.zeros((count, len(arms), 2)),
    )  # fmt: skip
    none = np.zeros((0, 6))
    return Demo(
        path=Path("test.mcap"), scene=spec, mapping=GamepadMapping(), rate=240, utterances=(), states=states,
        inputs=InputTrack(np.zeros((0, 4)), np.zeros((0, 17))),
        commands=CommandTrack(none, none, np.zeros((0, q.shape[1])), np.zeros(0), ()),
        versions={}, complete=True, hands=hands,
    )  # fmt: skip


def still(spec: SceneSpec, count: int) -> FloatArray:
    """Object centres of a scene in which nothing moves, (count, N, 3)."""
    return np.tile(np.array([each.position for each in spec.objects]).reshape(1, -1, 3), (count, 1, 1))
