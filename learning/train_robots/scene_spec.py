"""A scene of the release as the twin builds it."""

from learning.train_robots.layout import Cell
from learning.train_robots.scene import Scene
from twin.board import cell_centre
from twin.scene_spec import ObjectSpec, SceneSpec


def scene_spec(scene: Scene) -> SceneSpec:
    """Return the layout before the action as a board scene.

    Object ids are indices in the before layout. The gripper starts in its cell, closed on the block that stands there
    where the layout says so.
    """
    before = scene.before
    return SceneSpec(
        name=f"train-robots-{scene.number}",
        objects=tuple(
            ObjectSpec(id=index, shape=block.shape, colour=block.colour, position=_centre(block.cell))
            for index, block in enumerate(before.blocks)
        ),
        gripper_position=_centre(before.gripper),
        gripper_closed=before.closed,
        held=before.held,
        seed=scene.number,
    )


def _centre(cell: Cell) -> tuple[float, float, float]:
    x, y, z = cell_centre(*cell)
    return float(x), float(y), float(z)
