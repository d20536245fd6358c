"""What the robot's hand tells of the things: which one it holds, pushes or has let go."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from learning.perception.segments import Piece
from learning.perception.track import Track
from learning.perception.upright_box import held_points
from robots.kinematics import rotation_matrix
from robots.pose import FloatArray

IN_HAND = 0.035
"""Distance of a closed hand's tool point from a thing it may hold [m]."""
SOMETHING = 0.004
"""Fingers that were told to close and stay farther apart hold something [m]."""
CLOSING = 0.0005
"""Fingers whose gap shrinks by more from frame to frame are still closing [m]."""
UNMOVED = 0.004
"""Up to here a hand has not moved since it closed [m, or of a quaternion]."""
NOT_THERE = 3
"""Frames for which a thing is missing though nothing hides its place, before it is taken to be in the hand."""
FALLING = 8
"""Frames after which what was let go lies still."""
FALLEN = 2
"""Frames after which a thing that was let go unseen is taken to have come to rest below."""
SUPPOSED = 0.9
"""Belief that a hand which closed at a thing holds it, before it moves."""
FINGERS = 0.015
"""Half of the thickness of closed fingers [m]."""
PUSHING = 0.0005
"""A hand that moves less from frame to frame pushes nothing [m]."""
HIDDEN = 0.5
"""A thing of which less is exposed is hidden."""
AROUND_HAND = 0.10
"""What a hand holds is seen nearer to the tool point than this [m]."""
NEAR_HAND = 0.10
"""A thing that is not seen may be moved by a hand nearer than this [m]."""


@dataclass(slots=True)
class _Grip:
    """A hand that closed: the track it holds, the tool's frame, the fingers' gap and the track's centre then."""

    track: Track | None
    tool: FloatArray
    opening: float
    centre: FloatArray | None
    lost: bool = False


class HandBelief:
    """Follows what the acting hand does to the things. Tell it of every frame in order."""

    def __init__(self) -> None:
        """Begin with an empty hand."""
        self._tool: FloatArray | None = None
        self._grip: _Grip | None = None
        self._released: Track | None = None

    def move(self, tracks: Sequence[Track], tool: FloatArray, closed: bool, opening: float, loose: float) -> None:
        """Take in how the hand moved, and move what it moves.

        Args:
            tracks: The things known; their beliefs go one frame on.
            tool: Tool frame in the world, (7,).
            closed: Whether the gripper was told to close.
            opening: Measured gap between the fingers [m].
            loose: Creeping of a thing that is not where it was expected [m].
        """
        before = tool if self._tool is None else self._tool
        self._tool = tool
        for track in tracks:
            track.falling = max(track.falling - 1, 0)
            track.filter.predict(before, tool, loose if track.missing else 0.0)
            if track.held:
                track.turn(before, tool)
        self._suppose(tracks, tool, closed, opening)
        if closed:
            self._push(tracks, before, tool)
        for track in tracks:
            if track.missing + track.hidden and not track.touched:
                track.touched = track.distance(tool[:3]) < NEAR_HAND

    def _suppose(self, tracks: Sequence[Track], tool: FloatArray, closed: bool, opening: float) -> None:
        """Suppose that a hand which closed holds what is nearest to it, and that an open one holds nothing.

        While the hand does not move both hypotheses explain everything, so that the belief is kept as it was supposed.
        """
        if not closed or opening < SOMETHING:
            for track in tracks:
                if track.held:
                    self._released, track.falling = track, FALLING
                track.filter.let_go()
            self._grip = None
            return
        if self._grip is None or opening < self._grip.opening - CLOSING:
            nearest = min(tracks, key=lambda track: track.distance(tool[:3]), default=None)
            if nearest is not None and nearest.distance(tool[:3]) >= IN_HAND:
                nearest = None
            self._grip = _Grip(nearest, tool, opening, None if nearest is None else nearest.centre)
        grip = self._grip
        if grip.track is None or grip.centre is None:
            return
        if np.linalg.norm(tool[:3] - grip.tool[:3]) < UNMOVED and np.abs(tool[3:] - grip.tool[3:]).max() < UNMOVED:
            for each in tracks:
                each.filter.let_go()
            grip.track.filter.suppose_held(SUPPOSED)
        elif not grip.track.held and grip.track.missing >= NOT_THERE and not grip.lost:
            # it is not where it stood, and the fingers are kept apart by something
            grip.lost = True
            turn = rotation_matrix(tool[3:]) @ rotation_matrix(grip.tool[3:]).T
            grip.track.filter.carry_to(tool[:3] + turn @ (grip.centre - grip.tool[:3]))

    def _push(self, tracks: Sequence[Track], before: FloatArray, tool: FloatArray) -> None:
        """A closed hand that moves into a thing behind the arm pushes it along: two bodies are not at one place."""
        way = tool[:2] - before[:2]
        length = float(np.linalg.norm(way))
        if length < PUSHING:
            return
        for track in tracks:
            gripped = self._grip is not None and self._grip.track is track
            if track.held or gripped or track.exposure > HIDDEN:
                continue
            off = track.centre - tool[:3]
            inside = 0.5 * float(track.box.extent[1]) + FINGERS - float(np.linalg.norm(off[:2]))
            level = abs(float(off[2])) < 0.5 * float(track.box.extent[2]) + FINGERS
            if inside > 0.0 and level and float(off[:2] @ way) > 0.0:
                track.filter.shift(np.append(way / length * min(inside, length), 0.0))

    def unknown(self, loose: Sequence[Piece]) -> list[Piece]:
        """Pieces of an unknown thing that the closed hand holds, since before the first picture.

        Its parts look out between fingers and palm; that they are one thing is felt.

        Args:
            loose: Pieces that belong to no track.
        """
        if self._grip is None or self._tool is None or self._grip.track is not None:
            return []
        tool = self._tool[:3]
        return [
            each
            for each in loose
            if each.beside_robot and np.linalg.norm(each.points - tool, axis=1).min() < AROUND_HAND
        ]

    def felt(self, points: FloatArray, track: Track | None = None) -> FloatArray | None:
        """Places (k, 3) [m] at which the hand feels what it holds; None where it does not hold it.

        Args:
            points: What is seen of the thing, (n, 3) [m].
            track: The thing; None for one that is not known yet.
        """
        grip = self._grip
        if grip is None or self._tool is None or grip.track is not track or not (track is None or track.held):
            return None
        return held_points(points, self._tool[:3], grip.opening)

    def holds(self, track: Track) -> None:
        """What the hand holds is known from now on."""
        if self._grip is not None and self._tool is not None:
            self._grip.track, self._grip.centre, self._grip.tool = track, track.centre, self._tool
            track.filter.suppose_held(SUPPOSED)

    def was_seen(self, track: Track) -> None:
        """A thing was seen: where it fell is known."""
        if track is self._released:
            self._released = None

    def fallen(self, track: Track, tracks: Sequence[Track], floor: float) -> None:
        """Let a thing that was let go, and is not seen, fall onto the table or what stands below it.

        Args:
            track: The thing, which is not seen.
            tracks: All things.
            floor: Height of the table below it [m].
        """
        if track is not self._released or track.missing + track.hidden < FALLEN:
            return
        self._released = None
        centre = track.centre
        under = [
            float(other.centre[2] + 0.5 * other.box.extent[2])
            for other in tracks
            if other is not track
            and other.centre[2] < centre[2]
            and np.linalg.norm(other.centre[:2] - centre[:2]) < 0.5 * other.box.extent[1]
        ]
        drop = max([floor, *under]) + 0.5 * float(track.box.extent[2]) - float(centre[2])
        if drop < 0.0:
            track.filter.shift(np.array([0.0, 0.0, drop]))
