"""Following every object of a scene from picture to picture, also behind the arm and in the hand."""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from learning.perception.box_maker import BoxMaker
from learning.perception.hand_belief import HIDDEN, HandBelief
from learning.perception.newcomers import LARGER, SAME_COLOUR, Newcomers
from learning.perception.pixel_owners import owners_of, unowned
from learning.perception.robot_eye import Look
from learning.perception.segments import LEAST_PIXELS, Piece, Pixels, joined, pieces_of, standing_out
from learning.perception.sighting import Sighting
from learning.perception.table import Table, TableView
from learning.perception.track import BOX_SIGMA, FIT_SIGMA, Track
from learning.perception.upright_box import UprightBox
from robots.pose import FloatArray
from twin.camera.camera_model import CameraModel

WHOLE = 0.93
"""Exposed by this part, and with nearly all its usual pixels, a thing is seen whole."""
NEARLY_ALL = 0.75
MOSTLY = 0.5
"""From this part of its usual pixels on its colour is told: a cap alone has another."""
MORE = 1.2
"""Where more pixels by this are seen than ever before of a thing that was not seen whole, its size is guessed anew."""
LEAST_SEEN = 0.2
"""With fewer of its usual pixels a thing is not seen."""
LEAST_TRUST = 0.3
"""The less of a thing is seen, the less its place is trusted, down to this part of its usual pixels."""
REACH = 0.06
"""How far a thing may jump between two frames in which it is seen [m],"""
REACH_MORE = 0.02
"""and how much farther for every frame in which it was not,"""
FARTHEST = 0.40
"""up to this."""
FELL = 0.03
"""A thing that was let go and is seen this far from where it would fit has fallen [m]."""
LOOSE = 0.004
"""Creeping of a thing that was not found where nothing hides it [m] a frame."""
SAME_PLACE = 2e-4
"""A camera that moved less stands still [m, or of a quaternion]."""
IMPOSSIBLE = 1e3


class Tracker:
    """Follows the things on a table.

    Each pixel that stands out goes to the thing known that it is most like; pieces that are left go to things that
    were not found (Hungarian method), or are new. A thing that is hidden stays where it is believed to be: where it
    rests, or in the hand.

    Attributes:
        tracks: The objects known, in the order in which they were found.
    """

    def __init__(
        self, table: Table, camera: CameraModel, rng: np.random.Generator, apart: FloatArray | None = None
    ) -> None:
        """Begin without any object.

        Args:
            table: Where they stand.
            camera: What looks at them.
            rng: Source of all randomness.
            apart: Colours of things that are no lids of what they stand in or on, see `pieces_of`.
        """
        self.tracks: list[Track] = []
        self._apart = apart
        self._table, self._camera, self._rng = table, camera, rng
        self._view: TableView | None = None
        self._boxes = BoxMaker(table, camera)
        self._newcomers = Newcomers(self._boxes)
        self._hand = HandBelief()
        self._frame = -1

    def step(self, look: Look, tool: FloatArray, closed: bool, opening: float) -> list[Sighting]:
        """Look at the next picture.

        Args:
            look: The picture.
            tool: Tool frame of the acting arm in the world, (7,).
            closed: Whether its gripper was told to close.
            opening: Measured gap between its fingers [m].

        Returns:
            What is known of every track, in their order.
        """
        self._frame += 1
        eye = look.pose_camera_in_world.position
        seen = standing_out(look, self._placed(look))
        self._hand.move(self.tracks, tool, closed, opening, LOOSE)
        owner = owners_of(seen, self.tracks)
        self._expose(look, seen, owner)
        found: dict[int, Piece] = {}
        for number in range(len(self.tracks)):
            mine = owner == number
            if (mine & seen.trusted).sum() >= LEAST_PIXELS // 2:
                found[number] = seen.piece(mine)
        loose = self._match(pieces_of(seen, unowned(seen, owner), self._apart), found, eye)
        loose = self._feel(loose, found, eye)
        sightings = [self._corrected(track, found.get(number), eye) for number, track in enumerate(self.tracks)]
        for each in self._newcomers.watch(loose, self.tracks, eye, self._frame):
            track = Track(len(self.tracks), each.piece, each.box, eye, self._rng, guessed=each.piece.beside_robot)
            self.tracks.append(track)
            sightings.append(self._sighting(track, True, True, each.piece, not track.guessed))
        return sightings

    def _placed(self, look: Look) -> TableView:
        """The table from where the camera is now."""
        now, view = look.pose_camera_in_world, self._view
        if view is not None:
            was = view.pose_camera_in_world
            moved = np.abs(now.position - was.position).max() > SAME_PLACE
            if not moved and np.abs(now.orientation_xyzw - was.orientation_xyzw).max() <= SAME_PLACE:
                return view
        self._view = TableView(self._table, self._camera, now)
        return self._view

    def _expose(self, look: Look, seen: Pixels, owner: NDArray[np.int64]) -> None:
        """Work out how much of each track is hidden by the robot and by others."""
        depth = np.zeros(look.depth.shape, dtype=np.float32)
        whose = np.full(look.depth.shape, -1, dtype=np.int16)
        depth.reshape(-1)[seen.pixels] = seen.depth
        whose.reshape(-1)[seen.pixels] = owner
        for track in self.tracks:
            track.look_for(look, self._camera, depth, whose)

    def _match(self, loose: list[Piece], found: dict[int, Piece], eye: FloatArray) -> list[Piece]:
        """Give pieces that no track claims to tracks that were not found; returns what is left."""
        waiting = [number for number in range(len(self.tracks)) if number not in found]
        if not waiting or not loose:
            return loose
        cost = np.full((len(waiting), len(loose)), IMPOSSIBLE)
        for row, number in enumerate(waiting):
            track = self.tracks[number]
            believed = track.filter.estimate()
            reach = min(REACH + REACH_MORE * (track.missing + track.hidden), FARTHEST)
            for column, piece in enumerate(loose):
                away = float(np.linalg.norm(piece.points.mean(axis=0) - believed[:3]))
                other = float(np.abs(piece.colour - believed[3:]).max())
                size = len(piece.points) / max(track.expected(eye), 1.0)
                if away < reach and other < SAME_COLOUR and (size < LARGER or track.guessed):
                    cost[row, column] = away / reach + other / SAME_COLOUR
        taken = set()
        rows, columns = linear_sum_assignment(cost)
        for row, column in zip(rows.tolist(), columns.tolist(), strict=True):
            if cost[row, column] < IMPOSSIBLE:
                found[waiting[row]] = loose[column]
                taken.add(column)
        return [piece for column, piece in enumerate(loose) if column not in taken]

    def _feel(self, loose: list[Piece], found: dict[int, Piece], eye: FloatArray) -> list[Piece]:
        """Get to know an unknown thing that the closed hand holds; returns the other pieces."""
        mine = self._hand.unknown(loose)
        if not mine:
            return loose
        piece = joined(mine)
        box = self._boxes.box(piece, eye, self._hand.felt(piece.points))
        track = Track(len(self.tracks), piece, box, eye, self._rng, guessed=True)
        self._hand.holds(track)
        self.tracks.append(track)
        found[track.id] = piece
        return [each for each in loose if not any(each is one for one in mine)]

    def _corrected(self, track: Track, piece: Piece | None, eye: FloatArray) -> Sighting:
        """Correct a track by its piece, or leave it where it is believed to be."""
        if piece is None:
            hidden = track.exposure <= HIDDEN
            track.hidden, track.missing = track.hidden + hidden, track.missing + (not hidden)
            self._hand.fallen(track, self.tracks, self._boxes.floor(track.centre))
            return self._sighting(track, False, False, None, False)
        share = len(piece.points) / max(track.expected(eye), 1.0)
        whole = track.exposure > WHOLE and share > NEARLY_ALL and not piece.beside_robot
        if whole or (track.guessed and share > MORE):
            felt = self._hand.felt(piece.points, track)
            box = self._boxes.box(piece, eye, felt, stands=not whole and felt is None)
            track.measure(piece, box.centre, BOX_SIGMA)
            # about the centre believed, so that what is remembered does not jump with the noise
            track.remember(piece, UprightBox(track.centre, box.extent, box.yaw), eye, guessed=not whole)
        else:
            centre = track.fit(piece.points)
            if track.falling and share >= MOSTLY:  # the fit does not tell how far it slid along itself
                fallen = self._boxes.box(piece, eye).centre
                centre = fallen if np.linalg.norm(fallen - centre) > FELL else centre
            track.measure(piece, centre, FIT_SIGMA / max(min(share, 1.0), LEAST_TRUST))
        self._hand.was_seen(track)
        return self._sighting(track, share >= LEAST_SEEN, whole or share >= MOSTLY, piece, whole)

    def _sighting(self, track: Track, visible: bool, coloured: bool, piece: Piece | None, whole: bool) -> Sighting:
        colour = track.colour if coloured else None
        return Sighting(
            track.id, track.centre, track.box.extent, visible, track.held, colour, track.exposure, piece, whole,
            self._view, track.box.yaw,
        )  # fmt: skip
