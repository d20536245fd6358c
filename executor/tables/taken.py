"""What a hand took looks as it did before: fingers hide most of it from the camera, which would not know it again."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from executor.tables.table_view import TableView
from learning.perception.gaps import gap_offsets
from learning.perception.handling import FRAGMENT, felt
from learning.perception.observation import Observation
from robots.pose import FloatArray


@dataclass(frozen=True, slots=True)
class Taken:
    """A thing as it was seen before a hand took it.

    Attributes:
        number: Its number.
        colour: Hue, saturation, lightness, (3,).
        shape: FPFH descriptor, (33,).
        extent: Length, width and height, (3,) [m].
        features: Values of further feature spaces by their name, (m,) each.
    """

    number: int
    colour: FloatArray
    shape: FloatArray
    extent: FloatArray
    features: Mapping[str, FloatArray]

    @classmethod
    def of(cls, view: TableView, index: int) -> "Taken":
        """Keep how a thing looks, in the last frame in which it was seen."""
        seen = view.observation
        frames = np.arange(len(seen.times)) if seen.visible is None else np.flatnonzero(seen.visible[:, index])
        frame = int(frames[-1]) if len(frames) else -1
        return cls(
            view.numbers[index],
            seen.colour[frame, index],
            seen.shape[frame, index],
            view.things.extent[index],
            {name: values[frame, index] for name, values in seen.features.items()},
        )


def as_taken(observation: Observation, taken: Taken) -> tuple[Observation, int] | None:
    """A look in which what the hand feels looks as it did before it was taken, and its index; None if it feels nothing.

    Where all of it is hidden it is where the hand is.
    """
    if not bool(felt(observation)[-1]):
        return None
    count = len(observation.object_ids)
    gap = np.linalg.norm(gap_offsets(observation)[-1], axis=1) if count else np.zeros(0)
    index = int(np.argmin(gap)) if count and float(gap.min()) < FRAGMENT else count
    if index == count:
        observation = _with_another(observation)
    assert observation.extent is not None  # a camera measures what it sees
    features = {
        name: _set(values, index, taken.features[name]) if name in taken.features else values
        for name, values in observation.features.items()
    }
    changed = replace(
        observation,
        colour=_set(observation.colour, index, taken.colour),
        shape=_set(observation.shape, index, taken.shape),
        extent=_set(observation.extent, index, taken.extent),
        features=features,
    )
    return changed, index


def _with_another(observation: Observation) -> Observation:
    """The same with one more thing, where the hand is."""

    def more(values: FloatArray, last: FloatArray | float) -> FloatArray:
        column = np.broadcast_to(np.asarray(last), (len(values), *values.shape[2:]))
        return np.concatenate([values, column[:, None]], axis=1)

    visible = observation.visible
    return replace(
        observation,
        object_ids=np.append(observation.object_ids, max(observation.object_ids.tolist(), default=-1) + 1),
        location=np.concatenate([observation.location, observation.gripper_location[:, None]], axis=1),
        colour=more(observation.colour, 0.0),
        shape=more(observation.shape, 0.0),
        extent=None if observation.extent is None else more(observation.extent, 0.0),
        yaw=None
        if observation.yaw is None
        else np.append(observation.yaw, np.zeros((len(observation.yaw), 1)), axis=1),
        visible=None if visible is None else np.append(visible, np.ones((len(visible), 1), dtype=bool), axis=1),
        features={name: more(values, np.nan) for name, values in observation.features.items()},
    )


def _set(values: FloatArray, index: int, value: FloatArray) -> FloatArray:
    """Values (F, N, m) with one column set to a value (m,) in all frames."""
    changed = np.array(values)
    changed[:, index] = value
    return changed
