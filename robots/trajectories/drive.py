"""The wheeled base to a pose on the floor: straight if that is free, else around what stands in the way."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from robots.pose import FloatArray

from .base import BaseLimits, BasePhase, BaseTrajectory
from .errors import listed
from .free_space import FreeSpace
from .joints import JointTrajectory, move_joints
from .limits import JointLimits
from .paths import without_repetitions
from .shortcuts import shorten

IsPoseFree = Callable[[FloatArray], bool]
"""Whether the base at (x, y, yaw), (3,) [m, m, rad], touches nothing."""

STEP = 0.03
"""Distance of neighbouring checks [m]."""
TURN_STEP = 0.05
"""Angle of neighbouring checks [rad]."""
HEADINGS = (24, 120)
"""A place on a way around must be free in this many headings, since the base may turn there: at first, then again."""
AROUND = 2.0
"""How far beyond start and goal a way around is searched [m]."""
APPROACH = 1.5
"""How far the base may drive straight out of or into a pose that leaves no room to turn [m]."""
REACH = 0.5
"""Longest edge of the sampled trees [m]."""
SHORTCUTS = 60
MAX_CHECKS = 200_000
SMALL = 1e-9
"""Turns [rad] and drives [m] below this are left out."""


@dataclass(frozen=True, slots=True)
class BaseMotion:
    """Outcome of planning a motion of the base.

    Attributes:
        success: Whether there is one.
        reason: Why not, else empty.
        checks: Poses that were checked.
        trajectory: If successful.
    """

    success: bool
    reason: str
    checks: int
    trajectory: BaseTrajectory | None = None


@dataclass(frozen=True, slots=True)
class _Leg:
    """A straight drive to a place, with the yaws in which it may be driven: forward, backward or both."""

    place: FloatArray
    yaws: tuple[float, ...]


def drive_base(
    start: FloatArray,
    goal: FloatArray,
    limits: BaseLimits,
    is_free: IsPoseFree | None = None,
    generator: np.random.Generator | None = None,
) -> BaseMotion:
    """Turn, drive, turn, forward or backward, whichever is faster; around obstacles by several such drives.

    Args:
        start: x, y, yaw, (3,) [m, m, rad].
        goal: Where to end, exactly, (3,) [m, m, rad]; its yaw up to whole turns.
        limits: Of the base.
        is_free: Whether a pose touches nothing; the floor is empty if not given.
        generator: Of the samples when the straight way is blocked; equal ones give equal ways. Seed 0 if not given.

    Returns:
        The motion, or why there is none.
    """
    start, goal = np.asarray(start, dtype=np.float64), np.asarray(goal, dtype=np.float64)
    for name, pose in (("start", start), ("goal", goal)):
        if pose.shape != (3,) or not np.all(np.isfinite(pose)):
            return BaseMotion(False, f"{name} must be three finite numbers x, y, yaw; got {listed(pose)}", 0)
    search = _Search(start, goal, limits, is_free or (lambda pose: True))
    reason, trajectory = search.run(np.random.default_rng(0) if generator is None else generator)
    return BaseMotion(trajectory is not None, reason, search.checks, trajectory)


class _Search:
    """One question to the geometry."""

    def __init__(self, start: FloatArray, goal: FloatArray, limits: BaseLimits, is_free: IsPoseFree) -> None:
        self._start, self._goal, self._limits, self._is_free = start, goal, limits, is_free
        self._headings = HEADINGS[0]
        self.checks = 0

    def run(self, generator: np.random.Generator) -> tuple[str, BaseTrajectory | None]:
        """Why there is no motion, or the motion."""
        for name, pose in (("start", self._start), ("goal", self._goal)):
            if not self._free(pose):
                return f"{name} is in collision", None
        direct = _along(self._start[:2], self._goal[:2])
        ways = [self._trajectory([_Leg(self._goal[:2], (yaw,))]) for yaw in direct] or [self._trajectory([])]
        for trajectory in sorted(ways, key=lambda way: way.duration):
            if self._is_clear(trajectory):
                return "", trajectory
        for headings in HEADINGS:
            self._headings = headings
            reason, around = self._around(generator)
            if around is None or self._is_clear(around):
                return reason, around
        return f"the way found has a place where it grazes something between {HEADINGS[-1]} free headings", None

    def _around(self, generator: np.random.Generator) -> tuple[str, BaseTrajectory | None]:
        """Out to where there is room, from roomy place to roomy place, and in."""
        out, into = self._roomy(self._start), self._roomy(self._goal)
        if out is None or into is None:
            name = "start" if out is None else "goal"
            return f"the way is blocked, and {name} has no room to turn within {APPROACH} m ahead or behind", None
        space = FreeSpace(self._has_room, STEP)
        places: FloatArray | None = np.array([out, into])
        if not space.edge(out, into):
            from .sampling_planner import sample_way  # OMPL is only loaded when the straight way is blocked

            ends = np.array([out, into])
            lower, upper = ends.min(axis=0) - AROUND, ends.max(axis=0) + AROUND
            seed = int(generator.integers(1, 2**31))
            places = sample_way(out, into, lower, upper, space, seed, REACH, MAX_CHECKS // self._headings)
        if places is None:
            return "no way around found; there may be none", None
        places = without_repetitions(shorten(places, space, generator, SHORTCUTS))
        legs = [] if np.array_equal(out, self._start[:2]) else [_Leg(out, (float(self._start[2]),))]
        legs += [_Leg(end, _along(begin, end)) for begin, end in zip(places[:-1], places[1:], strict=True)]
        if not np.array_equal(into, self._goal[:2]):
            legs.append(_Leg(self._goal[:2], (float(self._goal[2]),)))
        return "", self._trajectory(legs)

    def _free(self, pose: FloatArray) -> bool:
        self.checks += 1
        return bool(self._is_free(pose))

    def _has_room(self, place: FloatArray) -> bool:
        yaws = np.arange(self._headings) * (2 * np.pi / self._headings)
        return all(self._free(np.append(place, yaw)) for yaw in yaws)

    def _roomy(self, pose: FloatArray) -> FloatArray | None:
        """The nearest place ahead or behind with room to turn, (2,), reached by driving straight."""
        heading = np.array([math.cos(pose[2]), math.sin(pose[2])])
        open_ways = {1.0: True, -1.0: True}
        for step in range(int(APPROACH / STEP) + 1):
            for sign in open_ways if step else (1.0,):
                place = pose[:2] + sign * step * STEP * heading
                open_ways[sign] = open_ways[sign] and self._free(np.append(place, pose[2]))
                if open_ways[sign] and self._has_room(place):
                    return np.asarray(place)
        return None

    def _trajectory(self, legs: list[_Leg]) -> BaseTrajectory:
        """Drive the legs, each in that of its yaws which makes all turns together fastest, and turn to the goal's."""
        # The best way to end leg k in each of its yaws: time of all turns so far and the yaws so far.
        best = [(0.0, [float(self._start[2])])]
        for yaws in [*(leg.yaws for leg in legs), (float(self._goal[2]),)]:
            best = [
                min(
                    (time + self._turn(so_far[-1], yaw).duration, [*so_far, so_far[-1] + _wrapped(yaw - so_far[-1])])
                    for time, so_far in best
                )
                for yaw in yaws
            ]
        _, yaws_taken = min(best)
        phases: list[BasePhase] = []
        place, yaw = self._start[:2], float(self._start[2])
        for leg, taken in zip([*legs, None], yaws_taken[1:], strict=True):
            if abs(taken - yaw) > SMALL:
                phases.append(BasePhase(np.append(place, yaw), False, self._turn(yaw, taken)))
            yaw = taken
            if leg is not None:
                along = float((leg.place - place) @ np.array([math.cos(yaw), math.sin(yaw)]))
                if abs(along) > SMALL:
                    phases.append(BasePhase(np.append(place, yaw), True, _move(along, self._limits.drive)))
                place = leg.place
        turns = 2 * math.pi * round((yaw - float(self._goal[2])) / (2 * math.pi))
        return BaseTrajectory(tuple(phases), self._goal + np.array([0.0, 0.0, turns]))

    def _turn(self, begin: float, end: float) -> JointTrajectory:
        return _move(_wrapped(end - begin), self._limits.turn)

    def _is_clear(self, trajectory: BaseTrajectory) -> bool:
        """Whether all poses on the way are free, none further from the next than a step."""
        return all(self._free(pose) for phase in trajectory.phases for pose in phase.along(STEP, TURN_STEP))


def _along(begin: FloatArray, end: FloatArray) -> tuple[float, ...]:
    """Yaws in which the base drives from place to place: forward, backward; none if it is there."""
    step = end - begin
    if np.hypot(*step) <= SMALL:
        return ()
    forward = math.atan2(step[1], step[0])
    return forward, _wrapped(forward + math.pi)


def _wrapped(angle: float) -> float:
    """The same angle from -pi to pi."""
    return math.remainder(angle, 2 * math.pi)


def _move(distance: float, limits: JointLimits) -> JointTrajectory:
    return move_joints(np.zeros(1), np.array([distance]), limits)
