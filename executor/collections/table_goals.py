"""Where a thing may be put on a table: in a part of it, beside, in or on another thing."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from executor.collections.driven_grasps import pose_of
from executor.collections.rules import Facts, Rule, picked_up, set_down
from robots.pose import FloatArray
from teleop.annotators import Column, Destination, Place, Relation, Row, TableAction, place_at
from twin import World
from twin.objects.overlap import footprint_depth, half_width
from twin.scene_spec import ObjectSpec

ROWS: dict[Row, float] = {"bottom": 0.53, "top": 0.77}
COLUMNS: dict[Column, float] = {"left": 0.25, "middle": 0.0, "right": -0.25}
"""Middle of the parts of the table [m]."""
ABOUT = 0.025
"""A thing is put so near to that, in each direction [m]."""
REACH_X, REACH_Y = (0.44, 0.82), (-0.36, 0.36)
"""Where things are put at all [m]."""
GAP = (0.03, 0.075)
"""Room between things beside each other [m]."""
CLEAR = 0.025
"""Least room between a thing that is put down and any other, seen from above [m]."""
WAYS: dict[Relation, tuple[float, float]] = {
    "left": (0.0, 1.0),
    "right": (0.0, -1.0),
    "front": (1.0, 0.0),
    "behind": (-1.0, 0.0),
}
"""Direction from the other thing, x and y."""
SMALL = ("cube", "cylinder", "apple", "pear", "tape")
"""What fits into a bowl or a mug,"""
FLAT = ("cube", "cylinder", "tape")
"""and what stands on another thing."""
HOLLOW = ("bowl", "mug")
ROLLING = ("apple", "pear", "banana", "marker", "cylinder")
"""What may roll when it is let go."""
LEVEL = ("cube", "tape", "stapler")
"""What has a level top."""
MOUTH = 0.6
"""What is in a hollow thing is nearer to its middle than this part of its half width."""
ON_TOP = 0.012
"""What is on a thing has its underside so near to its top, at most [m]."""
ASIDE = 0.55
"""A direction is kept to this angle [rad]."""
FARTHEST_BESIDE = 0.26
"""What is beside a thing is not farther from it than this [m]."""


@dataclass(frozen=True, slots=True)
class Goal:
    """Where a thing shall be.

    Attributes:
        destination: How a person would say it.
        position: Of its centre when it is let go, (3,) [m].
        falls: Whether it is let go above its rest, into something.
    """

    destination: Destination
    position: FloatArray
    falls: bool = False


def goals(world: World, target: int, rng: np.random.Generator) -> Iterator[Goal]:
    """Places for a thing that are free, in a random order: first the kind, so that none crowds out another."""
    spec = {each.id: each for each in world.spec.objects}
    thing, others = spec[target], [each for each in spec.values() if each.id != target]
    inside = list(_in_or_on(world, thing, others, rng))
    parts = list(_parts(world, thing, rng))
    beside = list(_beside(world, thing, others, rng))
    kinds = [kind for kind in (inside, parts, beside) if kind]
    for kind in kinds:
        rng.shuffle(kind)
    while kinds:
        number = int(rng.integers(len(kinds)))
        goal = kinds[number].pop()
        kinds = [kind for kind in kinds if kind]
        if goal.falls or goal.destination.relation == "on" or _free(world, thing, others, goal):
            yield goal


def put_rule(world: World, action: TableAction, target: int, goal: Goal | None, *, only_beside: bool = False) -> Rule:
    """When a demo of picking up, putting down or moving a thing shows what it shall; picking up has no goal.

    Args:
        world: The world as it is before.
        action: What is done.
        target: Id of the thing.
        goal: Where it goes.
        only_beside: Whether on any side of the reference is as good, as where a sentence says no more than that.
    """
    if goal is None:
        return picked_up
    rolls = world.model_of(target).shape in ROLLING
    return lambda facts: (
        set_down(facts, brought=action == "move", may_roll=rolls) or reached(facts, goal, world, only_beside)
    )


def reached(facts: Facts, goal: Goal, world: World, only_beside: bool = False) -> str:
    """Say what is wrong with where a thing ended; empty when it is where it shall be. Arguments as for `put_rule`."""
    destination, end = goal.destination, facts.positions[-1]
    if destination.relation is None or destination.reference is None:
        if facts.heights[-1] > 0.008:
            return "not on the table"
        return "" if place_at(*end[:2].tolist()) == destination.place else "in another part of the table"
    reference = next(each for each in world.spec.objects if each.id == destination.reference)
    off = end - pose_of(world, reference.id).position
    top = pose_of(world, reference.id).position[2] + reference.half_extents[2]
    if destination.relation == "in":
        inside = np.linalg.norm(off[:2]) < MOUTH * min(reference.half_extents[:2]) and facts.heights[-1] < top - 0.008
        return "" if inside else "not in it"
    if destination.relation == "on":
        over = np.linalg.norm(off[:2]) < max(min(reference.half_extents[:2]), 0.012)
        return "" if over and abs(facts.heights[-1] - top) < ON_TOP else "not on it"
    way = np.array(WAYS[destination.relation])
    distance = float(np.linalg.norm(off[:2]))
    aside = np.arccos(np.clip(off[:2] @ way / max(distance, 1e-6), -1.0, 1.0))
    if facts.heights[-1] > 0.008 or distance > FARTHEST_BESIDE or (aside > ASIDE and not only_beside):
        return "not beside it as meant"
    return ""


def _parts(world: World, thing: ObjectSpec, rng: np.random.Generator) -> Iterator[Goal]:
    here = place_at(*pose_of(world, thing.id).position[:2].tolist())
    for row, x in ROWS.items():
        for column, y in COLUMNS.items():
            place: Place = (row, column)
            at = np.array([x, y]) + rng.uniform(-ABOUT, ABOUT, 2)
            if place != here and place_at(*at.tolist()) == place:
                yield Goal(Destination(place=place), np.array([*at, thing.half_extents[2]]))


def _beside(world: World, thing: ObjectSpec, others: list[ObjectSpec], rng: np.random.Generator) -> Iterator[Goal]:
    for other in others:
        centre = pose_of(world, other.id).position
        for relation, way in WAYS.items():
            across = sum(half_width(each.half_extents, each.yaw, way) for each in (other, thing))
            shift = (across + float(rng.uniform(*GAP))) * np.array(way) + rng.uniform(-0.008, 0.008, 2)
            at = np.array([*(centre[:2] + shift), thing.half_extents[2]])
            yield Goal(Destination(relation=relation, reference=other.id), at)


def _in_or_on(world: World, thing: ObjectSpec, others: list[ObjectSpec], rng: np.random.Generator) -> Iterator[Goal]:
    for other in others:
        centre = pose_of(world, other.id).position
        top = float(centre[2]) + other.half_extents[2]
        if other.shape in HOLLOW and thing.shape in SMALL:
            deep = 0.6 if other.shape == "bowl" else 0.15
            height = top - deep * 2.0 * other.half_extents[2] + thing.half_extents[2]
            yield Goal(
                Destination(relation="in", reference=other.id), np.array([*_mouth(world, other), height]), falls=True
            )
        if other.shape in LEVEL and thing.shape in FLAT:
            at = np.array([*centre[:2], top + thing.half_extents[2]])
            yield Goal(Destination(relation="on", reference=other.id), at)


def _mouth(world: World, hollow: ObjectSpec) -> FloatArray:
    """The middle of a hollow thing's mouth, (2,) [m]: a mug's handle is no part of it."""
    pose, model = pose_of(world, hollow.id), hollow.object_model()
    inner = float(model.centre_of_mass[0])
    turn = np.array([np.cos(hollow.yaw), np.sin(hollow.yaw)])
    return np.asarray(pose.position[:2] + inner * turn)


def _free(world: World, thing: ObjectSpec, others: list[ObjectSpec], goal: Goal) -> bool:
    x, y, _ = goal.position.tolist()
    if not (REACH_X[0] < x < REACH_X[1] and REACH_Y[0] < y < REACH_Y[1]):
        return False
    for other in others:
        ox, oy, _ = pose_of(world, other.id).position.tolist()
        depth = footprint_depth(thing.half_extents, other.half_extents, (ox - x, oy - y), thing.yaw, other.yaw)
        if depth > -CLEAR:
            return False
    return True
