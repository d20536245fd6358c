"""Hands made sound after something went wrong at a table: what is in them is put down where there is room."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from executor.actions.hand import IN_AIR, ActingHand
from executor.actions.primitives import Carry, Lower, Release, Retreat
from executor.actions.things import clear_below, corners_of, pose_of
from executor.arm_motions import ArmMotions
from executor.handling import Handling
from executor.tables.places import LEAST_ROOM, STEP, TableThings
from robots.pose import FloatArray

if TYPE_CHECKING:
    from twin import World

REGION_X, REGION_Y = (0.44, 0.80), (-0.36, 0.36)
"""Where something may be put down that has to go somewhere [m]: on every table, in reach."""
TRIED = 6
"""Places that are tried."""
APART = 0.06
"""so far apart [m]."""
SAME = 0.06
"""What is seen so near to where a thing is or should be is that thing [m]."""
AT_HOME = 0.05
"""An arm so near to its home posture [rad] is there."""


def come_to_rest(world: "World", things: TableThings, rng: np.random.Generator, keep: int | None = None) -> str:
    """Put down what hands hold, open those that are closed on nothing, and bring those that let go of things home.

    Nothing is let go of in the air, and nothing is put on another thing: where neither can be avoided, the hand keeps
    what it holds.

    Args:
        world: The twin.
        things: What is seen on the table, with what is held or without it.
        rng: Where the planners' chance comes from.
        keep: Id of a thing that stays in the hand.

    Returns:
        What was done, in plain words; empty where nothing had to be done.
    """
    told = []
    for number, name in enumerate(world.robot.arms):
        hand = world.state().arms[number]
        if hand.gripper_closed and hand.held is not None and hand.held != keep:
            put = _put_down(world, name, hand.held, things, rng)
            told.append(
                "what was in the hand was put down" if put else "what is in the hand stays there: no free place"
            )
            if put:
                Handling(world, name, rng).go_home()
        elif hand.held is None and (hand.gripper_closed or _away(world, name, rng)):
            handling = Handling(world, name, rng)
            if hand.gripper_closed:
                handling.motions.fingers.move(handling.arm.gripper.max_opening)
                told.append("the hand was closed on nothing and is open again")
            # Among things it leaves the way it came; where it is free already it goes home at once.
            if not handling.go_home().success and handling.leave().success:
                handling.go_home()
    return "; ".join(dict.fromkeys(told))


def bring_home(world: "World", rng: np.random.Generator) -> None:
    """Bring arms home whose hands hold nothing; a closed hand goes as it is, and opens there.

    Args:
        world: The twin.
        rng: Where the planners' chance comes from.
    """
    for number, name in enumerate(world.robot.arms):
        hand = world.state().arms[number]
        if hand.held is not None and hand.gripper_closed:
            continue
        motions = ArmMotions(world, name, rng)
        if _away(world, name, rng) and not motions.go(motions.arm.home, motions.around()).success:
            handling = Handling(world, name, rng)
            if handling.leave().success:
                motions.go(motions.arm.home, motions.around())
        if hand.gripper_closed and not _away(world, name, rng):
            motions.fingers.move(motions.arm.gripper.max_opening)


def _away(world: "World", arm: str, rng: np.random.Generator) -> bool:
    """Whether an arm is not at home."""
    motions = ArmMotions(world, arm, rng)
    return float(np.abs(motions.q - motions.arm.home).max()) > AT_HOME


def _put_down(world: "World", arm: str, held: int, things: TableThings, rng: np.random.Generator) -> bool:
    """Whether what an arm holds could be put down: where it stands already, below where it is, or at a free place."""
    hand = ActingHand(world, arm, held, None, rng)
    if hand.take_over() and clear_below(world, held) < IN_AIR and _lowest(world, held) < IN_AIR:
        hand.do(Release())
        hand.do(Retreat())
        return True
    for place in _places(world, held, things):
        hand = ActingHand(world, arm, held, place, rng)
        if not hand.take_over():
            return False
        if not hand.do(Carry()).success or not hand.do(Lower()).success:
            continue
        hand.do(Release())
        hand.do(Retreat())
        return True
    return False


def _lowest(world: "World", held: int) -> float:
    """Height of a thing's underside above the table [m]."""
    return float(corners_of(world, held)[:, 2].min())


def _places(world: "World", held: int, things: TableThings) -> Iterator[FloatArray]:
    """Free places on the table for what is held, the nearest first: where its centre comes to rest, (3,) [m]."""
    centre, corners = pose_of(world.state(), held).position, corners_of(world, held)
    radius = float(np.linalg.norm(corners[:, :2] - centre[:2], axis=1).max())
    height = float(centre[2] - corners[:, 2].min())
    others = np.linalg.norm(things.location - centre, axis=1) > SAME
    location, radii = things.location[others, :2], things.radius[others]
    grid = [np.clip(centre[:2], (REGION_X[0], REGION_Y[0]), (REGION_X[1], REGION_Y[1]))]
    grid += [np.array([x, y]) for x in np.arange(*REGION_X, STEP) for y in np.arange(*REGION_Y, STEP)]
    kept: list[FloatArray] = []
    for at in sorted(grid, key=lambda at: float(np.linalg.norm(at - centre[:2]))):
        room = np.linalg.norm(location - at, axis=1) - radii - radius
        if np.all(room >= LEAST_ROOM) and all(np.linalg.norm(at - other) > APART for other in kept):
            kept.append(at)
            yield np.append(at, height)
        if len(kept) == TRIED:
            return
