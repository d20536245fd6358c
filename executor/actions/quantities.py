"""How much of each change belongs to an action: the means of what its demos showed, as numbers for a motion."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from learning.graphs.action_graphlet import ActionGraphlet
from learning.graphs.action_statistics import ActionStatistics
from learning.graphs.graphlet_state import Side
from robots.pose import FloatArray

RISE = 0.10
"""Height [m] by which an object is lifted where no demo tells."""
SHIFT = 0.08
"""Way [m] by which an object is pushed where no demo tells."""
DURATION = 2.5
"""Time [s] for which a state lasts where no demo tells."""
FORCE = 8.0
"""Force [N] with which an object is pressed where no demo tells."""
LOWEST_RISE = 0.03
"""A hand lifts no object less than this [m]: it would not be clear of what stands around it."""
SELDOM_LESS = 1.5
"""So many standard deviations below the mean is what is seldom less."""
LEAST_FORCE = 1.0
"""No less force [N] is told from what the wrist carries."""


@dataclass(frozen=True, slots=True)
class Quantities:
    """What a graphlet leaves open and its demos fill in.

    Attributes:
        rise: Height by which a held object is lifted [m].
        shift: Way by which an object is pushed along what bears it [m].
        force: Force with which a hand closed on nothing touches, by the side from which it does [N].
        durations: How long each state lasts, by its number [s].
    """

    rise: float = RISE
    shift: float = SHIFT
    force: Mapping[Side, float] = field(default_factory=dict)
    durations: Mapping[int, float] = field(default_factory=dict)

    def force_from(self, side: Side) -> float:
        """Force [N] of a touch from a side."""
        return self.force.get(side, FORCE)

    def duration_of(self, state: int) -> float:
        """How long a state lasts [s]."""
        return self.durations.get(state, DURATION)


def quantities_of(graphlet: ActionGraphlet, statistics: ActionStatistics | None) -> Quantities:
    """The means of what the demos of an action showed; usual amounts for what none did.

    Args:
        graphlet: The action; it may go on where the one that was measured ends.
        statistics: Gaussians of its states; None where nothing was measured (the board).
    """
    if statistics is None:
        return Quantities()
    states = graphlet.states
    durations = {n: mean for n in range(len(states)) if (mean := _mean(statistics, n, "duration")) is not None}
    return Quantities(
        rise=_rise(graphlet, statistics),
        shift=_shift(graphlet, statistics),
        force=_forces(graphlet, statistics),
        durations=durations,
    )


def least_travel(statistics: ActionStatistics | None) -> float:
    """How far an object was seldom brought less than [m], by its demos.

    Args:
        statistics: Gaussians of the action's states; None where nothing was measured.
    """
    if statistics is None:
        return 0.0
    for number in reversed(range(len(statistics.states))):
        mean, spread = statistics.mean(number, "travel"), statistics.spread(number, "travel")
        if mean is not None and spread is not None:
            return max(0.0, float(mean[0]) - SELDOM_LESS * float(spread[0]))
    return 0.0


def _rise(graphlet: ActionGraphlet, statistics: ActionStatistics) -> float:
    """Height at which the first state in the air ended; where it ended by lowering, the object had been higher."""
    states = graphlet.states
    for number, state in enumerate(states):
        height = _mean(statistics, number, "clearance")
        if state.raised and height is not None:
            lowered = number + 1 < len(states) and states[number + 1].holds and not states[number + 1].raised
            return max(height, RISE) if lowered else max(height, LOWEST_RISE)
    return RISE


def _shift(graphlet: ActionGraphlet, statistics: ActionStatistics) -> float:
    """Way along the table to the place where a hand from outside brought the object."""
    ways = [_mean(statistics, n, "travel") for n, state in enumerate(graphlet.states) if state.side is not None]
    return next((way for way in reversed(ways) if way is not None), SHIFT)


def _forces(graphlet: ActionGraphlet, statistics: ActionStatistics) -> dict[Side, float]:
    """Force of a touch from each side, beyond what the wrist carries in the state before."""
    forces: dict[Side, float] = {}
    for number, state in enumerate(graphlet.states):
        felt, before = _vector(statistics, number, "force"), _vector(statistics, number - 1, "force")
        if state.side is not None and state.side not in forces and felt is not None and before is not None:
            forces[state.side] = max(float(np.linalg.norm(felt - before)), LEAST_FORCE)
    return forces


def _vector(statistics: ActionStatistics, state: int, name: str) -> FloatArray | None:
    """Mean of a measure in a state; None where none was measured."""
    return statistics.mean(state, name) if 0 <= state < len(statistics.states) else None


def _mean(statistics: ActionStatistics, state: int, name: str) -> float | None:
    """Mean of a measure that is one number."""
    mean = _vector(statistics, state, name)
    return None if mean is None else float(mean[0])
