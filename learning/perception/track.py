"""One object as it is followed through a demo: belief, remembered look, and what it would show."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from learning.perception.particle_filter import ParticleFilter
from learning.perception.robot_eye import Look
from learning.perception.segments import Piece
from learning.perception.upright_box import UprightBox
from robots.kinematics import rotation_matrix
from robots.pose import FloatArray
from twin.camera.camera_model import CameraModel

TEMPLATE = 60
"""Points of a thing that are remembered."""
BOX_SIGMA = 0.003
"""Standard deviation of a centre measured from a whole view [m],"""
FIT_SIGMA = 0.004
"""and from a part of it that is laid on what is remembered [m]."""
COLOUR_SIGMA = 8.0
"""Standard deviation of a measured colour, of 255."""
_FIT_ROUNDS = 4
_STRAYS = 0.015
"""A point farther from what is remembered does not count [m]."""
_BEFORE = 0.012
"""How much nearer the robot must be than a point to hide it [m],"""
_BEFORE_THING = 0.030
"""and another thing [m]."""
_SLOWLY = 0.1
"""How fast the usual number of pixels follows."""


class Track:
    """An object that is followed.

    Attributes:
        id: Its number.
        filter: Belief about its centre and colour.
        box: Size and direction as last seen whole.
        missing: Frames since it was last seen, while nothing hid it.
        hidden: Frames since it was last seen, while something did.
        touched: Whether the hand came near it since.
        falling: Frames for which it may still fall since the hand let it go.
        exposure: Part of it that nothing hides now, 0 .. 1.
        colour: Red, green, blue of 255 as last measured, (3,).
        guessed: Whether it was never seen whole, so that its size is a guess.
    """

    def __init__(
        self,
        number: int,
        piece: Piece,
        box: UprightBox,
        eye: FloatArray,
        rng: np.random.Generator,
        guessed: bool = False,
    ) -> None:
        """Begin with a first view.

        Args:
            number: Its number.
            piece: What was seen.
            box: The box around it.
            eye: Where the camera is, (3,) [m].
            rng: Source of the filter's randomness.
            guessed: Whether the view showed a part only.
        """
        self.id = number
        self.guessed = guessed
        self.colour: FloatArray = piece.colour
        state = np.concatenate((box.centre, self.colour))
        self.filter = ParticleFilter(state, np.array([BOX_SIGMA] * 3 + [COLOUR_SIGMA] * 3), rng)
        self.missing = self.hidden = 0
        self.touched = False
        self.falling = 0
        self.exposure = 1.0
        self._rng = rng
        self._usual = 0.0
        self.box = box
        self.remember(piece, box, eye, guessed)

    @property
    def centre(self) -> FloatArray:
        """Where its middle is believed to be, (3,) [m]."""
        return self.filter.estimate()[:3]

    @property
    def held(self) -> bool:
        """Whether it is believed to move with the tool."""
        return self.filter.held_share > 0.5

    def remember(self, piece: Piece, box: UprightBox, eye: FloatArray, guessed: bool = False) -> None:
        """Take a view as what it looks like: a whole one, or, of a thing never seen whole, a larger part than before.

        Args:
            piece: What is seen.
            box: The box around it.
            eye: Where the camera is, (3,) [m].
            guessed: Whether it is a part.
        """
        chosen = self._rng.permutation(len(piece.points))[:TEMPLATE]
        self._points: FloatArray = piece.points[chosen] - box.centre
        self.colours: FloatArray = piece.colours[chosen]
        self._tree = cKDTree(self._points)
        if self.guessed:
            self.guessed, self._usual = guessed, 0.0
        blend = 1.0 if self._usual == 0.0 else _SLOWLY
        self.box = UprightBox(box.centre, (1 - blend) * self.box.extent + blend * box.extent, box.yaw)
        size = len(piece.points) * float(((box.centre - eye) ** 2).sum())
        self._usual = size if self._usual == 0.0 else (1 - _SLOWLY) * self._usual + _SLOWLY * size

    def turn(self, before: FloatArray, now: FloatArray) -> None:
        """Turn what is remembered with the tool, whose frames are (7,)."""
        if np.abs(before[3:] - now[3:]).max() < 1e-6:
            return
        turned = rotation_matrix(now[3:]) @ rotation_matrix(before[3:]).T
        self._points = self._points @ turned.T
        self._tree = cKDTree(self._points)

    def points(self) -> FloatArray:
        """Where what is remembered of it should be now, (m, 3) [m]."""
        return self._points + self.centre

    def distance(self, place: FloatArray) -> float:
        """Mean distance [m] of a place (3,) from its box and from its nearest remembered point.

        The box has the far side too, which was not seen; the points tell what lies in a bowl from the bowl.
        """
        side = np.array([np.cos(self.box.yaw), np.sin(self.box.yaw)])
        off = place - self.centre
        local = np.array([off[:2] @ side, off[1] * side[0] - off[0] * side[1], off[2]])
        outside = np.maximum(np.abs(local) - 0.5 * self.box.extent, 0.0)
        nearest = float(np.linalg.norm(self._points - off, axis=1).min())
        return 0.5 * (float(np.linalg.norm(outside)) + nearest)

    def expected(self, eye: FloatArray) -> float:
        """How many pixels it would show whole."""
        return self._usual / float(((self.centre - eye) ** 2).sum())

    def look_for(self, look: Look, camera: CameraModel, things: NDArray[np.float32], owner: NDArray[np.int16]) -> None:
        """Work out how much of it nothing hides.

        Args:
            look: The picture.
            camera: The camera.
            things: Depth of all things' pixels, (height, width) [m]; 0 elsewhere.
            owner: Number of the track that each of them belongs to, (height, width).
        """
        pose = look.pose_camera_in_world
        seen = (self.points() - pose.position) @ rotation_matrix(pose.orientation_xyzw)
        ahead = seen[:, 2] > 0.05
        pixels = np.round(camera.project(np.where(ahead[:, None], seen, 1.0))).astype(np.int64)
        column, row = pixels[:, 0], pixels[:, 1]
        inside = ahead & (column >= 0) & (column < camera.width) & (row >= 0) & (row < camera.height)
        row, column = np.clip(row, 0, camera.height - 1), np.clip(column, 0, camera.width - 1)
        body, depth = look.body[row, column], seen[:, 2]
        thing = np.where(owner[row, column] == self.id, np.float32(0.0), things[row, column])
        covered = (body > 0) & (body < depth - _BEFORE)
        covered |= (thing > 0) & (thing < depth - _BEFORE_THING)
        # at the very edge of the hand a pixel is the hand's
        covered |= (body > 0) & (body < depth + _BEFORE) & (look.depth[row, column] > 0)
        self.exposure = float((inside & ~covered).mean())

    def fit(self, points: FloatArray) -> FloatArray:
        """Centre (3,) [m] for which a part of the thing lies best on what is remembered: shifted, not turned.

        Args:
            points: What is seen of it, (n, 3) [m].
        """
        centre = self.centre.copy()
        for _ in range(_FIT_ROUNDS):
            found = self._tree.query(points - centre)
            distance, nearest = np.asarray(found[0]), np.asarray(found[1])
            near = distance < max(_STRAYS, float(np.percentile(distance, 60)))
            centre += (points[near] - centre - self._points[nearest[near]]).mean(axis=0)
        return centre

    def measure(self, piece: Piece, centre: FloatArray, sigma: float) -> None:
        """Correct the belief by what was seen."""
        self.colour = piece.colour
        self.filter.update(np.append(centre, self.colour), np.array([sigma] * 3 + [COLOUR_SIGMA] * 3))
        self.missing = self.hidden = 0
        self.touched = False
