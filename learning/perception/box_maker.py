"""Boxes around pieces of a picture, on a table."""

import numpy as np

from learning.perception.segments import Piece
from learning.perception.table import Table
from learning.perception.upright_box import UprightBox, upright_box
from robots.pose import FloatArray
from twin.camera.camera_model import CameraModel


class BoxMaker:
    """Makes boxes around what is seen, with what is known of table and camera."""

    def __init__(self, table: Table, camera: CameraModel) -> None:
        """Know table and camera."""
        self._table, self._camera = table, camera

    def box(self, piece: Piece, eye: FloatArray, felt: FloatArray | None = None, stands: bool = False) -> UprightBox:
        """The box around a piece, and around places at which the thing is felt.

        Args:
            piece: What is seen.
            eye: Where the camera is, (3,) [m].
            felt: The places, (k, 3) [m].
            stands: Whether it stands on the table though its foot may be hidden.
        """
        points = piece.points if felt is None else np.concatenate((piece.points, felt))
        middle = points.mean(axis=0)
        pitch = float(np.linalg.norm(middle - eye)) / self._camera.fx
        return upright_box(points, eye, pitch, self.floor(middle), stands)

    def floor(self, place: FloatArray) -> float:
        """Height of the table in the world under a place (3,) [m]."""
        table = self._table
        return float(-(table.normal[:2] @ place[:2] + table.offset) / table.normal[2])
