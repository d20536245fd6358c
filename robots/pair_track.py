"""Distances along the way of one posture: bounds that hold, and exact ones where they are asked for."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import coal
import numpy as np

from .near_kernel import (
    BoolArray,
    IntArray,
    approached,
    gradients,
    keep_planes,
    look_ahead,
    lower,
    place,
    sift,
)
from .pose import FloatArray, Pose

if TYPE_CHECKING:
    from .near_pairs import NearPairs

_ALL: IntArray = np.zeros(0, dtype=np.int64)


class PairTrack:
    """Distances along the way of one posture.

    Attributes:
        bounds: What each pair's distance is at least, (k,) [m]; exact where `exact`.
        exact: Which are worked out at this very posture, (k,).
    """

    def __init__(self, pairs: "NearPairs") -> None:
        """Start with nothing known."""
        self._pairs = pairs
        self._whole, self._numbers = pairs.whole, pairs.numbers
        count, shapes = len(pairs.firsts), len(pairs.solids)
        self.bounds: FloatArray = np.full(count, -np.inf)
        self.exact: BoolArray = np.zeros(count, dtype=np.bool_)
        self._normals, self._points = np.zeros((count, 3)), np.zeros((count, 3))
        self._joint_poses, self._poses = np.zeros((len(pairs.scene.parent), 12)), np.zeros((shapes, 12))
        self._reach = pairs.scene.reach.copy()
        # What coal asks for: where each shape is, written when it is needed.
        self._transforms: list[Any] = [None] * shapes
        self._written = [-1] * shapes
        self._number = 0
        self._request, self._result = coal.DistanceRequest(), coal.DistanceResult()
        self._at: FloatArray | None = None
        self._base: Pose | None = None
        self._placed = False
        self._things_placed: tuple[Pose | None, int] = None, -1

    def shrink(self, by: FloatArray) -> None:
        """Things were placed elsewhere: distances may have shrunk by as much as `NearPairs.place` says, (k,) [m]."""
        self.bounds -= by
        self.exact &= by == 0.0
        self._placed = False

    def move(self, positions: FloatArray, base: Pose) -> None:
        """Go to a posture, (nv,) as `NearPairs.positions` gives it, with the base at a pose in the world."""
        if self._at is not None and self._base is not None:
            shift = turn = 0.0
            if base is not self._base and not _same(base, self._base):
                shift = float(np.linalg.norm(base.position - self._base.position))
                turn = angle_between(base, self._base)
            known = self.bounds, self.exact
            if lower(self._whole, self._numbers, self._placed, self._reach, self._at, positions, shift, turn, *known):
                self._placed = False
        self._at, self._base = positions, base

    def jump(self, positions: FloatArray, base: Pose) -> None:
        """Go to a posture as `move` does, with nothing known there: for looking at a few pairs only."""
        self._at, self._base, self._placed = positions, base, False
        self.bounds[:] = -np.inf
        self.exact[:] = False

    def below(self, thresholds: FloatArray, which: IntArray | None = None) -> IntArray:
        """Pairs, of some or of all, nearer than thresholds (k,) [m]; their distances are exact afterwards."""
        if which is not None and not len(which):
            return which
        self._place()
        some = _ALL if which is None else which
        left = sift(self._whole, self._numbers, self._poses, self.bounds, self.exact, some, thresholds)
        return left[self.refine(left) < thresholds[left]] if len(left) else left

    def approached(self, amounts: FloatArray, most: float, offsets: FloatArray) -> IntArray:
        """Pairs nearer than motions from here take from their distances at most, to first order, and offsets.

        Their distances are exact afterwards.

        Args:
            amounts: Sizes of motions of driven joints, (n,), or also of the base, (n + 2,).
            most: What motions take from a distance counts up to this [m].
            offsets: (k,) [m].
        """
        self._place()
        left, thresholds = approached(
            self._whole,
            self._numbers,
            self._joint_poses,
            self._poses,
            self._reach,
            self.bounds,
            self.exact,
            amounts,
            self._pairs.matrix,
            most,
            offsets,
        )
        return left[self.refine(left) < thresholds[left]] if len(left) else left

    def look_ahead(
        self, end: "PairTrack", way: FloatArray, bases: Sequence[Pose], least: FloatArray
    ) -> tuple[IntArray, IntArray, IntArray, FloatArray, FloatArray]:
        """Which pairs bounds do not show to keep distances at the end of a way from here, and along it.

        Args:
            end: A track, which goes to the end.
            way: How far driven joints, or also the base, are behind each of m stretches, (m, d).
            bases: Poses of the base then, m of them.
            least: Distances to keep, (k,) [m].

        Returns:
            Pairs that may be too near at the end; others that may pass too near, and a stretch for each, 0 to m - 1,
            on which they may; positions of all joints behind each stretch, (m, nv); sums of levers for the first 0 to m
            stretches, for `NearPairs.gone`.
        """
        self._place()
        assert self._at is not None  # `move` comes first
        pairs, base = self._pairs, bases[-1]
        end.move(pairs.positions_after(self._at, way[-1]), base)
        around = end._needs_things(base)
        found = look_ahead(
            self._whole,
            self._numbers,
            pairs.matrix,
            self._at,
            way,
            pairs.rows_of(bases),
            self._poses,
            self._reach,
            self.bounds,
            self.exact,
            around,
            end._joint_poses,
            end._poses,
            end._reach,
            end.bounds,
            end.exact,
            least,
        )
        end._is_placed(around)
        return found

    def refine(self, which: IntArray) -> FloatArray:
        """Work out distances of pairs [m]."""
        self._place()
        firsts, seconds, solids = self._pairs.firsts, self._pairs.seconds, self._pairs.solids
        transforms, written, number = self._transforms, self._written, self._number
        request, result = self._request, self._result
        new = which[~self.exact[which]]
        for index in new.tolist():
            first, second = firsts[index], seconds[index]
            if written[first] != number:
                self._write(first)
            if written[second] != number:
                self._write(second)
            result.clear()
            coal.distance(solids[first], transforms[first], solids[second], transforms[second], request, result)
            self.bounds[index] = result.min_distance
            self._normals[index] = result.normal
            self._points[index] = result.getNearestPoint1()
        if len(new):
            self.exact[new] = True
            keep_planes(self._whole, self._numbers, new, self._poses, self._normals)
        return np.asarray(self.bounds[which])

    def gradients(self, which: IntArray) -> FloatArray:
        """How fast distances grow for each unit of speed, (len(which), n + 2): of driven joints, base's speed and turn.

        The distances must be exact. The two nearest points are taken as fixed to the things that they lie on: of two
        faces that turn against each other, others may come nearer.
        """
        self._place()
        known = self._normals, self._points
        return gradients(self._whole, self._numbers, self._joint_poses, which, *known, self._pairs.matrix)

    def _write(self, shape: int) -> None:
        """Write where a shape is, for coal."""
        pose = self._poses[shape]
        if self._transforms[shape] is None:
            self._transforms[shape] = coal.Transform3s()
        self._transforms[shape].setTransform(pose[:9].reshape(3, 3), pose[9:])
        self._written[shape] = self._number

    def _needs_things(self, base: Pose) -> bool:
        before, version = self._things_placed
        return version != self._pairs.version or before is None or not (base is before or _same(base, before))

    def _is_placed(self, around: bool) -> None:
        if around:
            self._things_placed = self._base, self._pairs.version
        self._number += 1
        self._placed = True

    def _place(self) -> None:
        """Put all shapes where they are at this posture."""
        if self._placed:
            return
        base = self._base
        assert self._at is not None and base is not None  # `move` comes first
        around = self._needs_things(base)
        written = self._joint_poses, self._poses, self._reach
        place(self._whole, self._numbers, self._at, self._pairs.row_of(base), around, *written)
        self._is_placed(around)


def _same(one: Pose, other: Pose) -> bool:
    return bool((one.position == other.position).all() and (one.orientation_xyzw == other.orientation_xyzw).all())


def angle_between(one: Pose, other: Pose) -> float:
    """Angle between two orientations [rad], from the chord: exact also for tiny ones."""
    first, second = one.orientation_xyzw, other.orientation_xyzw
    chord = min(float(np.linalg.norm(first - second)), float(np.linalg.norm(first + second)))
    return 4.0 * float(np.arcsin(min(0.5 * chord, 1.0)))
