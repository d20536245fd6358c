"""Keeps a robot's distance: how fast it may approach things, and whether it can still stop before them.

Two rules, one inside the other. A velocity damper (Faverjon and Tournassoud 1987) lets the distance d of a near pair
shrink no faster than k (d - stop), which makes approaches slow and sliding smooth. Behind it stands a check of what
would follow: a step is taken only if braking from it, as hard as the limits of acceleration and jerk allow, ends and
passes everywhere at a distance. Since braking is always such a step, there always is one.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from robots import RobotModel
from robots.ik_kernel import compiled
from robots.near_kernel import BoolArray, IntArray
from robots.near_pairs import NearPairs
from robots.near_shapes import RobotShapes
from robots.obstacle import Obstacle
from robots.pose import FloatArray, Pose

STOP = 0.007
"""Distance at which approaches end [m];"""
LEAST = 0.0055
"""distance that braking must keep [m]: what the control period and the distance solver leave open is far smaller;"""
FLOOR = 0.0052
"""distance below which not even a motion that seems to lead out may bring a pair nearer [m]."""
PRESS = -0.004
"""Fingers and held things may overlap so far with what they touch [m]: that presses, or pushes it on;"""
PRESS_MOST = -0.005
"""and this is the most [m]."""
STIFFEST = 10.0
"""Largest k [1/s]: contact is made at 0.04 m/s at most."""
SOFTEST = 0.5
"""Smallest k [1/s]."""
NEAR = 0.15
"""Farther pairs are left to the check of braking [m]."""
TOLERANCE = 2e-6
"""The distance solver's own [m]."""
DIP = 2e-5
"""What distances along a way are estimated by may dip so far below what its end must keep [m].

Estimates fall short the more, the longer a way is. Without this, a pair that stands right at its least distance could
part by no more than rounding errors at a time.
"""
PARTS = tuple(number / 8 for number in range(1, 9))
"""Parts of the braking time at which the way is looked at."""


@dataclass(frozen=True, slots=True)
class Dampers:
    """Rows of what may not shrink too fast.

    Attributes:
        rows: How distances grow with each speed, (m, dofs).
        least: How fast each may shrink at most, none above zero, (m,) [m/s].
        pairs: Which pairs they are, (m,).
    """

    rows: FloatArray
    least: FloatArray
    pairs: IntArray


class ServoGuard:
    """Distances of one robot among things, for the steps of a servo.

    Attributes:
        names: The two names of each pair, k of them.
        contacts: Which pairs may touch, (k,).
        own: The robot's own shapes, from which other guards of it are made in little time.
    """

    def __init__(
        self,
        robot: RobotModel,
        obstacles: Sequence[Obstacle],
        held: Mapping[str, Sequence[Obstacle]] | None = None,
        own: RobotShapes | None = None,
    ) -> None:
        """Build the geometry; takes some ten milliseconds, and few where the robot's own shapes are given."""
        held = held or {}
        self._kind = _kind(obstacles, held)
        self._pairs = NearPairs(robot, obstacles, held, own)
        self.own = self._pairs.own
        self.names, self.contacts = self._pairs.names, self._pairs.contacts
        self._now, self._end, self._between = (self._pairs.track() for _ in range(3))
        self._stop = np.where(self.contacts, PRESS, STOP)
        self._least = np.where(self.contacts, PRESS_MOST, LEAST)
        self._floor = np.where(self.contacts, PRESS_MOST, FLOOR)
        self._dofs = len(robot.joint_names) + (2 if robot.drive is not None else 0)
        self._openings: Mapping[str, float] = {}
        self._kept: dict[bytes, FloatArray] = {}
        if own is None:
            self._warm_up()

    def _warm_up(self) -> None:
        """Ask everything once: what is loaded or compiled when it is first used would delay a step."""
        robot, now = self._pairs.robot, self._now
        base, speeds = robot.pose_base_in_world, np.full(self._dofs, 1e-3)
        for q in (robot.home, robot.home + 1e-9):
            self.look(q, {}, base)
        self.dampers(speeds, speeds)
        self.offending(np.outer(PARTS, speeds), [base] * len(PARTS))
        some = np.arange(min(1, len(self.names)))
        now.refine(some)
        _least(np.ascontiguousarray(now.gradients(some)[:, : self._dofs]), speeds, speeds, np.ones(len(some)))
        now.below(np.full(len(self.names), -np.inf))

    def rebuilt(self, obstacles: Sequence[Obstacle], held: Mapping[str, Sequence[Obstacle]]) -> "ServoGuard":
        """A guard of the same robot among other things; made in little time."""
        return ServoGuard(self._pairs.robot, obstacles, held, self.own)

    def watch(self, obstacles: Sequence[Obstacle], held: Mapping[str, Sequence[Obstacle]]) -> bool:
        """Move what is there already.

        Returns:
            False if there are other things than before, so that a new guard is needed.
        """
        if _kind(obstacles, held) != self._kind:
            return False
        shrunk = self._pairs.place(obstacles, held)
        if shrunk.any():
            for track in (self._now, self._end):
                track.shrink(shrunk)
        return True

    def look(self, q: FloatArray, openings: Mapping[str, float], base: Pose) -> None:
        """Take the posture that the next questions are about: q (n,) [rad], gaps [m], where the base stands."""
        self._q, self._openings, self._base = q, openings, base
        self._now.move(self._pairs.positions(q, openings), base)

    def has_room(self, openings: Mapping[str, float]) -> bool:
        """Whether other gaps [m] bring no pair too near that may not touch, or bring it no nearer, where we are."""
        end = self._end
        end.move(self._pairs.positions(self._q, openings), self._base)
        near = end.below(self._least)
        near = near[~self.contacts[near]]
        return not len(near) or bool(np.all(end.refine(near) >= self._now.refine(near) - 1e-9))

    def dampers(self, wanted: FloatArray, braking: FloatArray) -> Dampers:
        """What limits a wanted motion.

        Args:
            wanted: Speeds, (dofs,): of the joints, then of a driven base.
            braking: Half of the time that each takes to brake from there, (dofs,) [s].
        """
        # What a pair may approach at is at most its gain times the room; the gain is one over twice the time, or less.
        now = self._now
        which = now.approached(np.abs(wanted) * np.maximum(2.0 * braking, 1.0 / STIFFEST), NEAR, self._stop)
        if not len(which):
            return Dampers(np.zeros((0, len(wanted))), np.zeros(0), which)
        rows = np.ascontiguousarray(now.gradients(which)[:, : len(wanted)])
        room = now.bounds[which] - self._stop[which]
        least = _least(rows, np.ascontiguousarray(wanted), braking, room)
        return Dampers(rows, least, which)

    def offending(self, way: FloatArray, bases: Sequence[Pose], between: BoolArray | None = None) -> IntArray:
        """Pairs that come too near on a way; empty if the way may be gone.

        Args:
            way: Where joints and base are after parts of the way, as differences from here, (m, dofs).
            bases: Where the base stands then, m of them.
            between: Only pairs that some of these speeds move and some of the others, (dofs,); None for all.
        """
        now, end = self._now, self._end
        least = self._least if between is None else self._least_between(between)
        ends, which, where, along, sums = now.look_ahead(end, np.ascontiguousarray(way), bases, least)
        if not len(ends) and not len(which):
            return which
        bad = near = end.below(least, ends)
        if len(near):
            bad = near[self._worse(near, way[-1])]
        if len(ends) > len(near):
            others = ends[end.bounds[ends] >= least[ends]]
            which, where = np.concatenate((which, others)), np.concatenate((where, np.zeros_like(others)))
        if len(which):
            start, last = now.refine(which), end.refine(which)
            short = (start + last - self._pairs.gone(sums[-1], which) < 2.0 * (least[which] - DIP)) & (
                start >= least[which]
            )
            which, where = which[short], where[short]
        if len(which):
            bad = np.concatenate((bad, which[self._passes_too_near(which, where, along, bases, sums)]))
        return bad

    def moved_by(self, pairs: IntArray) -> BoolArray:
        """Which speeds change distances of pairs, (dofs,)."""
        return np.asarray(self._pairs.moved_by[pairs, : self._dofs].any(axis=0))

    def _least_between(self, some: BoolArray) -> FloatArray:
        """Distances that braking must keep, (k,) [m], none for pairs that only some speeds (dofs,), or others, move."""
        key = some.tobytes()
        if key not in self._kept:
            moved = self._pairs.moved_by[:, : self._dofs]
            both = moved[:, some].any(axis=1) & moved[:, ~some].any(axis=1)
            self._kept[key] = np.where(both, self._least, -np.inf)
        return self._kept[key]

    def _worse(self, near: IntArray, way: FloatArray) -> BoolArray:
        """Which pairs that end too near are not on their way out."""
        before = self._now.refine(near)
        after = self._end.bounds[near]
        leading = self._now.gradients(near)[:, : len(way)] @ way >= 0.0
        kept = after >= before - TOLERANCE
        fine = kept & ((after >= self._floor[near]) | (leading & (before < self._floor[near])))
        excess = before - self._least[near]
        lowest = float(excess.min())
        if lowest < 0.0:
            # One that is deeper in decides; see `dampers`.
            fine |= (excess < 0.0) & (excess > lowest + 1e-4) & (after - self._least[near] >= lowest)
        return np.asarray(~fine)

    def _passes_too_near(
        self, which: IntArray, where: IntArray, along: FloatArray, bases: Sequence[Pose], sums: FloatArray
    ) -> BoolArray:
        """Which pairs cannot be shown to keep their distance between the looks at the way.

        Args:
            which: Pairs, w of them.
            where: A stretch for each where they most likely do not, (w,).
            along: See `PairTrack.look_ahead`, as for sums.
            bases: Poses of the base behind each stretch.
            sums: Of levers.
        """
        bad = np.zeros(len(which), dtype=bool)

        def distances(stretches: int, pairs: IntArray) -> FloatArray:
            """Distances after so many stretches."""
            if stretches in (0, len(along)):
                return (self._end if stretches else self._now).refine(pairs)
            self._between.jump(along[stretches - 1], bases[stretches - 1])
            return self._between.refine(pairs)

        def doubtful(first: int, last: int, pairs: IntArray, before: FloatArray, after: FloatArray) -> BoolArray:
            travel = self._pairs.gone(sums[last] - sums[first], pairs)
            return np.asarray(before + after - travel < 2.0 * (self._least[pairs] - DIP))

        for first in sorted(set(where.tolist())):
            some = np.flatnonzero(where == first)
            pairs = which[some]
            before, after = distances(first, pairs), distances(first + 1, pairs)
            bad[some] = doubtful(first, first + 1, pairs, before, after)
        some = np.flatnonzero(~bad)
        if not len(some):
            return bad
        stretches = [(0, len(along), some, distances(0, which[some]), distances(len(along), which[some]))]
        while stretches:
            first, last, some, before, after = stretches.pop()
            unsure = doubtful(first, last, which[some], before, after)
            some, before, after = some[unsure], before[unsure], after[unsure]
            if not len(some):
                continue
            if last - first == 1:
                bad[some] = True
                continue
            middle = (first + last) // 2
            between = distances(middle, which[some])
            stretches += [(first, middle, some, before, between), (middle, last, some, between, after)]
        return bad


@compiled
def _least(rows: FloatArray, wanted: FloatArray, braking: FloatArray, room: FloatArray) -> FloatArray:
    """How fast each pair's room (m,) [m] may shrink at most; see `ServoGuard.dampers` and `Dampers`."""
    # Where pairs are too near already, only the nearest may not come nearer: of two that squeeze a link from both
    # sides, one would otherwise forbid the way out of the other.
    deepest = 0.0
    for row in range(room.size):
        deepest = min(deepest, room[row])
    least = np.empty(room.size)
    for row in range(room.size):
        speed = way = 0.0
        for i in range(wanted.size):
            share = abs(rows[row, i] * wanted[i])
            speed += share
            way += share * braking[i]
        gain = 0.5 / max(way / max(speed, 1e-12), 1e-3)
        least[row] = -min(max(gain, SOFTEST), STIFFEST) * (room[row] - deepest)
    return least


def _kind(obstacles: Sequence[Obstacle], held: Mapping[str, Sequence[Obstacle]]) -> tuple[object, ...]:
    """What must stay for things to be moved only: their order, names and shapes."""
    return tuple(
        (arm, each.name, each.kind, each.size, None if each.corners is None else each.corners.tobytes())
        for arm, things in (("", obstacles), *sorted(held.items()))
        for each in things
    )
