"""From pictures to an observation: what was sighted of every object, gathered over a demo."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from learning.perception.held_weight import empty_hand, held_weight
from learning.perception.newcomers import EARLY
from learning.perception.observation import Observation
from learning.perception.proprioception import Proprioception
from learning.perception.shape_over_time import Glimpse, shape_over_time
from learning.perception.sighting import Sighting
from learning.perception.surface_colour import hsl_of
from learning.perception.table import Table
from robots.kinematics import rotation_matrix
from robots.pose import FloatArray, read_only

LEAST_FRAMES = 3
"""What was seen in fewer frames of a demo was no object."""
GONE = 10
"""Frames at the end in which nothing hides an object's place and it is not there: it is gone."""
EDGE = 0.10
"""An object last seen nearer than this to the table's edge left the table [m]."""
NEAR_HAND = 0.15
"""An open hand farther from everything touches nothing [m]."""


@dataclass(frozen=True, slots=True)
class Perceived:
    """An observation, and what people should know about it.

    Attributes:
        observation: The tracks.
        notes: What happened that the tracks do not say, in plain words.
    """

    observation: Observation
    notes: tuple[str, ...] = ()


def gathered(own: Proprioception, frames: Sequence[Sequence[Sighting]], table: Table) -> Perceived:
    """Make an observation of what was sighted.

    Args:
        own: What the robot felt of itself, for F frames.
        frames: Sightings of each frame; tracks are added at the end and never taken away.
        table: The table, for telling what left it.
    """
    count = max((len(each) for each in frames), default=0)
    tracks = [[each[number] if number < len(each) else None for each in frames] for number in range(count)]
    kept = [
        track for track in tracks if sum(each is not None and each.visible for each in track) >= _least(len(frames))
    ]
    number = len(kept)
    location, extent = np.zeros((len(frames), number, 3)), np.zeros((len(frames), number, 3))
    colour, yaw = np.zeros((len(frames), number, 3)), np.zeros((len(frames), number))
    shape, glimpsed = np.zeros((2, len(frames), number, 33))
    visible, held = np.zeros((len(frames), number), dtype=bool), np.zeros((len(frames), number), dtype=bool)
    notes = []
    for column, track in enumerate(kept):
        known = [each for each in track if each is not None]
        late = len(frames) - len(known)  # before it was known it was where it was first found
        filled = [known[0]] * late + known
        location[:, column] = [each.centre for each in filled]
        if late and known[0].held and own.closed[: late + 1].all():  # it was in the hand before it came into sight
            location[:late, column] = _carried_back(own, known[0].centre, late)
        extent[:, column] = [each.extent for each in filled]
        yaw[:, column] = [each.yaw for each in filled]
        visible[late:, column] = [each.visible for each in known]
        visible[:late, column] = late < EARLY  # it was looked at twice before it was believed
        held[late:, column] = [each.held for each in known]
        colour[:, column] = hsl_of(_filled(_colours(filled)))
        shapes = shape_over_time(_glimpses(track), len(frames))
        shape[:, column], glimpsed[:, column] = shapes.best, shapes.glimpsed
        notes += _gone(column, known, own, table)
    weight = _weights(own, location, extent, held)
    features = {"size": read_only(extent), "glimpsed_shape": read_only(glimpsed)}
    if weight is not None:
        features["weight"] = weight
    visible.setflags(write=False)
    closed = np.array(own.closed, dtype=bool)
    closed.setflags(write=False)
    return Perceived(
        Observation(
            times=own.times,
            gripper_location=read_only(own.tool[:, :3]),
            gripper_closed=closed,
            object_ids=np.arange(number, dtype=np.int64),
            location=read_only(location),
            colour=read_only(colour),
            shape=read_only(shape),
            visible=visible,
            extent=read_only(extent),
            gripper_opening=own.opening,
            wrist_force=own.wrist_force,
            yaw=read_only(yaw),
            features=features,
        ),
        tuple(notes),
    )


def _least(frames: int) -> int:
    return min(LEAST_FRAMES, frames)


def _carried_back(own: Proprioception, centre: FloatArray, frame: int) -> FloatArray:
    """Where what is in the hand at a frame was before, if it was in the hand all the time, (frame, 3) [m]."""
    in_tool = rotation_matrix(own.tool[frame, 3:]).T @ (centre - own.tool[frame, :3])
    return np.stack([tool[:3] + rotation_matrix(tool[3:]) @ in_tool for tool in own.tool[:frame]])


def _filled(colours: Sequence[FloatArray | None]) -> FloatArray:
    """Colours (F, 3) in which a frame without one has the nearest's."""
    when = np.array([number for number, each in enumerate(colours) if each is not None])
    if not len(when):
        return np.zeros((len(colours), 3))
    nearest = np.abs(np.arange(len(colours))[:, None] - when).argmin(axis=1)
    return np.asarray(np.stack([each for each in colours if each is not None])[nearest])


def _colours(filled: Sequence[Sighting]) -> list[FloatArray | None]:
    """Colours as the whole views of a thing show it, where there are any."""
    whole = any(each.whole for each in filled)
    return [each.colour if each.whole or not whole else None for each in filled]


def _glimpses(track: Sequence[Sighting | None]) -> list[Glimpse]:
    return [
        Glimpse(frame, each.whole, each.centre, each.piece.measured, each.piece.depth, each.view)
        for frame, each in enumerate(track)
        if each is not None and each.piece is not None and each.view is not None
    ]


def _weights(
    own: Proprioception, location: FloatArray, extent: FloatArray, held: NDArray[np.bool_]
) -> FloatArray | None:
    """Weights (F, N, 1) [kg], NaN where they were not felt; None for a hand that feels none."""
    if own.force is None:
        return None
    away = np.linalg.norm(location - own.tool[:, None, :3], axis=2)
    empty = empty_hand(own, (away < NEAR_HAND).any(axis=1))
    if empty is None:
        empty = own.hand_pull
    height, foot = location[..., 2], location[..., 2] - 0.5 * extent[..., 2]
    found = [
        held_weight(own, empty, held[:, each], height[:, each], foot[:, each]) for each in range(location.shape[1])
    ]
    return read_only(np.broadcast_to(np.array(found).reshape(1, -1, 1), (*location.shape[:2], 1)))


def _gone(number: int, known: Sequence[Sighting], own: Proprioception, table: Table) -> list[str]:
    """What to tell of an object that is not there at the end."""
    last = len(known) - 1
    while last >= 0 and not known[last].visible:
        last -= 1
    after = known[last + 1 :]
    if len(after) < GONE or np.median([each.exposure for each in after[-GONE:]]) < 0.5 or after[-1].held:
        return []
    place = known[last].centre
    when = own.times[len(own.times) - len(known) + last]
    edge = float((table.outline[:, 2] - table.outline[:, :2] @ place[:2]).min())
    where = f"object {number} was last seen at {when:.1f} s at ({place[0]:.2f}, {place[1]:.2f}, {place[2]:.2f}) m"
    if edge < EDGE or place[2] < 0.0:
        return [f"{where}, by the table's edge, and is gone: it left the table"]
    return [f"{where} and is not there any more, though nothing hides its place: its later places are guesses"]
