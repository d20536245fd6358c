"""Which other things keep a hand from an object: those that it would touch where it must be to hold it."""

from collections import Counter

import numpy as np

from executor.actions.things import pose_of
from executor.arm_motions import ArmMotions, moved
from executor.grasp_choice import APPROACH, OPENINGS, TABLE_CLEARANCE, TILTS
from twin import World
from twin.grasp_poses import grasp_poses

MOST = 24
"""Hands around an object that are looked at, spread evenly over all, for each arm."""
PLACES = (1.0, 0.5, 0.0)
"""Parts of the way to a grasp at which the hand is looked at."""


def around_grasps(world: World, object_id: int, rng: np.random.Generator) -> tuple[int, ...]:
    """Ids of the things that keep every arm from an object: of the grasp with the fewest, the most often met first.

    Empty where nothing is in the way, or something else than things is: no arm reaches there, or the table is too near.

    Args:
        world: The twin; nothing in it moves.
        object_id: The object.
        rng: Where the planners' chance comes from.

    Raises:
        TwinError: There is no such object.
    """
    found: list[frozenset[int]] = []
    for name in world.robot.arms:
        found += _met(ArmMotions(world, name, rng), object_id)
    if not found or min(map(len, found)) == 0:
        return ()
    often = Counter(each for things in found for each in things)
    fewest = min(found, key=lambda things: (len(things), -sum(often[each] for each in things), sorted(things)))
    return tuple(sorted(fewest, key=lambda each: (-often[each], each)))


def _met(motions: ArmMotions, object_id: int) -> list[frozenset[int]]:
    """Things that the hand meets on its way to each grasp that is in reach and free of all else."""
    world, arm = motions.world, motions.arm
    things = {str(each.id) for each in world.state().objects}
    model = motions.around(detailed={object_id})
    proposals = grasp_poses(
        world.model_of(object_id),
        pose_of(world.state(), object_id),
        arm.gripper,
        openings=OPENINGS[-1:],
        tilts=TILTS,
    )
    narrow = [each for each in proposals if each.opening < arm.gripper.max_opening] or proposals
    found = []
    for proposal in narrow[:: max(1, round(len(narrow) / MOST))]:
        met: set[str] = set()
        near = arm.home
        for part in PLACES:
            tool = moved(proposal.pose_tool_in_world, -part * APPROACH * proposal.approach)
            posture = motions.reach(tool, near)
            if posture is None:
                met.add("out of reach")
                break
            near = posture
            met |= motions.touched(model, posture, TABLE_CLEARANCE, proposal.opening)
        if met <= things - {str(object_id)}:
            found.append(frozenset(map(int, met)))
    return found
