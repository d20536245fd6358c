"""Things that are not known yet, and those that only seem so."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from learning.perception.box_maker import BoxMaker
from learning.perception.segments import Piece
from learning.perception.track import BOX_SIGMA, Track
from learning.perception.upright_box import UprightBox
from robots.pose import FloatArray

SETTLED = 0.015
"""A new thing must stay where it is within this [m]"""
EARLY, SURE_EARLY, SURE_LATE = 4, 2, 8
"""for two frames at the beginning, and for many later: most of what appears then was hidden before."""
BEHIND_ARM = 0.04
"""What is seen beside the robot nearer to a known thing than this is taken to be more of that thing [m]."""
SAME_COLOUR = 55.0
"""Difference of red, green, blue up to which two views may be of one thing."""
LARGER = 3.0
"""A piece with so many times the pixels expected is another thing."""


@dataclass(slots=True, eq=False)
class Newcomer:
    """A thing that may be new: where it is, what is seen of it, for how many frames, and when last."""

    centre: FloatArray
    piece: Piece
    box: UprightBox
    frames: int
    last: int


class Newcomers:
    """Watches pieces that belong to no track until they are sure to be things."""

    def __init__(self, boxes: BoxMaker) -> None:
        """Begin with none."""
        self._boxes = boxes
        self._waiting: list[Newcomer] = []

    def watch(self, loose: Sequence[Piece], tracks: Sequence[Track], eye: FloatArray, frame: int) -> list[Newcomer]:
        """Look at the pieces of a frame that belong to no track.

        A thing that was moved while it was hidden is known again by its colour and size, and corrected.

        Args:
            loose: The pieces.
            tracks: The things known.
            eye: Where the camera is, (3,) [m].
            frame: Number of the frame.

        Returns:
            What is sure to be a new thing now.
        """
        known = cKDTree(np.concatenate([track.points() for track in tracks])) if tracks else None
        for piece in loose:
            near = BEHIND_ARM if piece.beside_robot else SETTLED
            if known is not None and np.min(known.query(piece.points)[0]) < near:
                continue
            box = self._boxes.box(piece, eye, stands=piece.beside_robot)
            same = [
                each
                for each in self._waiting
                if each.last < frame and np.linalg.norm(each.centre - box.centre) < SETTLED
            ]
            if same:
                same[0].frames += 1
                same[0].last, same[0].piece, same[0].box = frame, piece, box
            else:
                self._waiting.append(Newcomer(box.centre, piece, box, 1, frame))
        self._waiting = [each for each in self._waiting if each.last >= frame - 2]
        sure = [each for each in self._waiting if each.frames >= (SURE_EARLY if frame < EARLY else SURE_LATE)]
        self._waiting = [each for each in self._waiting if each not in sure]
        return [each for each in sure if not _known_again(each, tracks, eye)]


def _known_again(newcomer: Newcomer, tracks: Sequence[Track], eye: FloatArray) -> bool:
    """Whether what seems new is a thing that was lost, or moved by the hand while hidden; it is then corrected."""
    colour, size = newcomer.piece.colour, len(newcomer.piece.points)
    alike = []
    for track in tracks:
        if track.missing < SURE_EARLY and not (track.hidden >= SURE_EARLY and track.touched):
            continue
        other = float(np.abs(colour - track.filter.estimate()[3:]).max())
        share = size / max(track.expected(eye), 1.0)
        if other < SAME_COLOUR and share > 1.0 / LARGER and (share < LARGER or track.guessed):
            alike.append((other, track))
    if not alike:
        return False
    track = min(alike, key=lambda pair: pair[0])[1]
    track.filter.let_go()
    track.measure(newcomer.piece, newcomer.box.centre, BOX_SIGMA)
    return True
