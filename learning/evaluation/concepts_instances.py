"""The instances that concepts are scored on, the same for ours, the pure IGMM and the SVM.

As the thesis has it, an instance is an observation: an object in a demo for what it is like; an object in a place where
it rests for locations; a pair of objects for each state of the scene, before and after the action, for relations; a
demo for actions. Its value is the mean of what perception measured of it over the frames that the learner looks at, in
the learner's own embedding.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from learning.concepts.demo_concepts import feature_values
from learning.concepts.space_set import SpaceSet
from learning.errors import PerceptionError
from learning.evaluation.concepts_truth import TrueDemo, TruthRules
from learning.perception.gaps import gap_offsets
from learning.perception.observation import Observation
from learning.perception.tracks import moved_object
from robots.pose import FloatArray

STEPS = 12
"""Instants of a demo, spread evenly, that describe its action to the SVM."""
HELD = -1
"""Number that `feature_values` gives to the values of the gripper at the object that it holds."""


@dataclass(frozen=True, slots=True)
class Instances:
    """Instances of one row of the table.

    Attributes:
        space: Feature space.
        values: Embedded values, (n, d).
        classes: True classes, (n,).
        demos: Demo of each, (n,).
    """

    space: str
    values: FloatArray
    classes: NDArray[np.str_]
    demos: NDArray[np.int64]


def instances_of(
    observation: Observation, truth: TrueDemo, rules: TruthRules, spaces: SpaceSet, rng: np.random.Generator
) -> dict[str, list[tuple[FloatArray, str]]]:
    """Value and true class of each instance of a demo, by row of the table.

    Args:
        observation: The demo's tracks.
        truth: What is true of it.
        rules: Classes of places, directions and distances.
        spaces: The feature spaces.
        rng: Draws pairs where there are more than the learner looks at.
    """
    number = len(observation.object_ids)
    found: dict[str, list[tuple[FloatArray, str]]] = {}

    def add(row: str, value: FloatArray, name: str | None) -> None:
        if name is not None:
            found.setdefault(row, []).append((value, name))

    for name, (points, tracks) in feature_values(observation, rng, spaces).items():
        if name in truth.properties:
            for thing in np.unique(tracks % number) if len(tracks) else ():
                add(name, points[tracks % number == thing].mean(axis=0), truth.properties[name][int(thing)])
            continue
        if name not in ("location", "direction", "distance"):
            continue  # what a user added is learned, and has no classes in the thesis's tables
        rows = [(name, rules.location if name == "location" else rules.direction)]
        rows += [(row, rule) for row, (of, rule) in rules.other.items() if of == name]
        for track in np.unique(tracks):
            value = points[tracks == track].mean(axis=0)
            if name == "location":
                for row, rule in rows:
                    add(row, value, rule(_place(truth, int(track))))
            elif name == "distance" and rules.distance is not None:
                if track >= 0:
                    add(name, value, rules.distance(float(np.linalg.norm(_offset(truth, int(track))))))
                elif track == HELD:
                    add(name, value, rules.distance(0.0))
            elif name == "direction":
                for row, rule in rows:
                    add(row, value, rule(_offset(truth, int(track))))
    return found


def gathered(space: str, parts: Sequence[tuple[int, FloatArray, str]]) -> Instances:
    """Instances from (demo, value, class)."""
    return Instances(
        space,
        np.array([value for _, value, _ in parts]),
        np.array([name for _, _, name in parts], dtype=np.str_),
        np.array([demo for demo, _, _ in parts], dtype=np.int64),
    )


def action_values(observation: Observation) -> FloatArray:
    """What an action looks like to the SVM, (m,): gripper and object at `STEPS` instants.

    Closed or not, opening and force where they are felt, way from the gripper to the object's box, and the object's
    shift from where it was. Without a handled object these are zeros.
    """
    frames = np.linspace(0, len(observation.times) - 1, STEPS).round().astype(int)
    try:
        moved = moved_object(observation)
        way = gap_offsets(observation)[frames, moved]
        shift = observation.location[frames, moved] - observation.location[0, moved]
    except PerceptionError:
        way = shift = np.zeros((STEPS, 3))
    parts = [observation.gripper_closed[frames], way, np.linalg.norm(way, axis=1), shift]
    for felt in (observation.gripper_opening, observation.wrist_force):
        if felt is not None:
            parts.append(np.nan_to_num(felt[frames]))
    return np.concatenate([np.asarray(part, dtype=np.float64).reshape(-1) for part in parts])


def _place(truth: TrueDemo, track: int) -> FloatArray:
    """True place of a resting track."""
    number = len(truth.first)
    return np.asarray(truth.last[track - number] if track >= number else truth.first[track])


def _offset(truth: TrueDemo, pair: int) -> FloatArray:
    """True offset of a pair of resting tracks, the first as seen from the second."""
    first, second = divmod(pair, 2 * len(truth.first))
    return _place(truth, first) - _place(truth, second)
