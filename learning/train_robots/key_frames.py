"""The key frames that a pair of layouts implies: a demo without physics.

A frame is taken at the start and wherever the gripper arrives, opens or closes. A move goes: at its start, over the
block, on it open, closed on it, lifted, over the goal, at the goal closed, open, risen. A lone take ends lifted,
straight up, in the cell of the after layout; a lone drop starts with the block in the closed gripper and goes straight
down.
"""

import numpy as np

from learning.errors import LearningError
from learning.perception.observation import Observation
from learning.perception.observe import KEY_FRAME_LENGTH, WORLD_FRAMES, KeyFrame, observe_key_frames
from learning.train_robots.layout import Cell
from learning.train_robots.scene import Scene
from learning.train_robots.scene_spec import scene_spec
from twin.board import cell_centre

CLEARANCE = 2
"""Levels between the highest block and the level at which a block is carried: one for the carried block, one free."""


def key_frames(scene: Scene, rng: np.random.Generator) -> Observation:
    """Observe the key frames of a scene through the board's noise; track numbers are indices in the before layout.

    Raises LearningError when not exactly one block moves.
    """
    return observe_key_frames(implied_key_frames(scene), scene_spec(scene).objects, rng)


def observe_before(scene: Scene, rng: np.random.Generator) -> Observation:
    """Observe the layout before the action for a second, through the board's noise: what a listener sees."""
    before = scene.before
    still = KeyFrame(
        cell_centre(*before.gripper), before.closed, np.array([cell_centre(*block.cell) for block in before.blocks])
    )
    return observe_key_frames([still] * (WORLD_FRAMES // KEY_FRAME_LENGTH), scene_spec(scene).objects, rng)


def implied_key_frames(scene: Scene) -> list[KeyFrame]:
    """Return the true key frames of a scene, objects in the order of the before layout.

    Raises LearningError when not exactly one block moves.
    """
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


def _frames(scene: Scene, moved: int, steps: list[tuple[Cell, bool, bool]]) -> list[KeyFrame]:
    location = np.array([cell_centre(*block.cell) for block in scene.before.blocks])
    frames = []
    for cell, closed, carried in steps:
        if carried:
            location[moved] = cell_centre(*cell)
        frames.append(KeyFrame(cell_centre(*cell), closed, location.copy()))
    return frames


def _at_level(cell: Cell, level: int) -> Cell:
    return cell[0], cell[1], level
