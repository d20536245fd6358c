"""The key frames that a pair of layouts implies: a demo without physics.

A frame is taken at the start and wherever the gripper arrives, opens or closes. A move goes: at its start, over the
block, on it open, closed on it, lifted, over the goal, at the goal closed, open, risen. A lone take ends lifted,
straight up, in the cell of the after layout; a lone drop starts with the block in the closed gripper and goes straight
down.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from learning.errors import LearningError
from learning.train_robots.layout import Cell
from learning.train_robots.scene import Scene
from robots.pose import FloatArray
from twin.board import cell_centre

FRAME_INTERVAL = 1.0
"""Time between key frames [s]; only their order matters."""
CLEARANCE = 2
"""Levels between the highest block and the level at which a block is carried: one for the carried block, one free."""


@dataclass(frozen=True, slots=True)
class KeyFrames:
    """True positions in F key frames with N blocks.

    Attributes:
        gripper_location: Tool frame, (F, 3) [m].
        gripper_closed: Gripper state, (F,).
        location: Block centres in the order of the before layout, (F, N, 3) [m].
    """

    gripper_location: FloatArray
    gripper_closed: NDArray[np.bool_]
    location: FloatArray

    @property
    def times(self) -> FloatArray:
        """Frame times, (F,) [s]."""
        return np.arange(len(self.gripper_closed), dtype=np.float64) * FRAME_INTERVAL


def implied_key_frames(scene: Scene) -> KeyFrames:
    """Return the key frames of a scene in which exactly one block moves; LearningError for any other scene."""
    move = scene.move
    if move is None:
        raise LearningError(f"scene {scene.number} does not move exactly one block; no key frames are implied")
    levels = [block.cell[2] for block in (*scene.before.blocks, *scene.after.blocks)]
    carry = max(levels) + CLEARANCE
    over_start, over_goal = _at_level(move.start, carry), _at_level(move.goal, carry)
    # (gripper cell, closed, block in the gripper)
    steps: list[tuple[Cell, bool, bool]] = []
    if move.held_at_start:
        steps.append((move.start, True, True))
    else:
        steps.append((scene.before.gripper, scene.before.closed, False))
        steps += [(over_start, False, False), (move.start, False, False), (move.start, True, True)]
        if not move.held_at_end:
            steps.append((over_start, True, True))
    if not move.held_at_end and (move.start[:2] != move.goal[:2] or not move.held_at_start):
        steps.append((over_goal, True, True))
    steps.append((move.goal, True, True))
    if not move.held_at_end:
        steps += [(move.goal, False, False), (over_goal, False, False)]
    return _frames(scene, move.object_id, steps)


def _frames(scene: Scene, moved: int, steps: list[tuple[Cell, bool, bool]]) -> KeyFrames:
    still = np.array([cell_centre(*block.cell) for block in scene.before.blocks])
    gripper = np.array([cell_centre(*cell) for cell, _, _ in steps])
    location = np.repeat(still[np.newaxis], len(steps), axis=0)
    where = still[moved]
    for frame, (cell, _, carried) in enumerate(steps):
        if carried:
            where = cell_centre(*cell)
        location[frame, moved] = where
    return KeyFrames(gripper, np.array([closed for _, closed, _ in steps]), location)


def _at_level(cell: Cell, level: int) -> Cell:
    return cell[0], cell[1], level
