"""What can be done before a command comes, so that motion follows it at once: look, and load what motions need."""

from typing import TYPE_CHECKING

import numpy as np

from executor.arm_motions import ArmMotions
from executor.grasp_choice import GENTLE
from robots.pose import Pose

if TYPE_CHECKING:
    from executor.executor import Executor

LIFTED = 0.01
"""Height of a line that is planned and not driven [m]."""


def get_ready(executor: "Executor") -> None:
    """Look at the scene, and load models and compiled code, while nobody waits for it; nothing moves.

    A look holds until something moves. Without this the first command does the same, and its motion begins later.
    """
    view = executor.doer.look()
    world = executor.world
    if world.spec.kind != "table":
        executor.doer.understand(("a",), view, None)
        return
    for tongue in executor.knowledge.table_language.tongues.values():  # any word will do
        executor.doer.understand(tuple(tongue.grounding.counts)[:1], view, None)
    rng = np.random.default_rng(0)  # of its own, so that plans are the same with and without it
    for name in world.robot.arms:
        motions = ArmMotions(world, name, rng)
        tool = motions.tool
        above = Pose(tool.position + np.array([0.0, 0.0, LIFTED]), tool.orientation_xyzw)
        motions.free(motions.around(), motions.q, 0.0)
        motions.reach(above, motions.q)
        motions.plan_straight(motions.q, above, GENTLE)
