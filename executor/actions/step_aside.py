"""Giving another arm room: up, outwards and back."""

import numpy as np

from executor.arm_motions import WAY_CLEARANCE, ArmMotions, moved

ASIDE = ((-0.10, 0.30, 0.20), (0.0, 0.25, 0.15), (0.0, 0.15, 0.25), (0.0, 0.0, 0.25), (0.0, 0.2, 0.0))
"""Ways [m] of the tool that are tried: along x, outwards from the middle, and up."""
THERE = 0.15
"""An arm whose tool is so far [m] from its home has stepped aside already."""


def step_aside(motions: ArmMotions) -> bool:
    """Bring an arm that has nothing to do out of another's way; whether it moved.

    An arm that holds something keeps still, since what it holds could hit something.
    """
    state = motions.world.state()
    if state.arms[motions.number].held is not None:
        return False
    tool, home = motions.tool, motions.arm.forward_kinematics(motions.arm.home)
    if float(np.linalg.norm(tool.position - home.position)) > THERE:
        return False
    outwards = 1.0 if tool.position[1] >= 0.0 else -1.0
    model = motions.around()
    for x, y, z in ASIDE:
        goal = motions.reach(moved(tool, np.array([x, outwards * y, z])), motions.q)
        if goal is not None and motions.free(model, goal, WAY_CLEARANCE) and motions.go(goal, model).success:
            return True
    return False
