"""From a camera's tracks of one demo to the states of its action graphlet, and when each of them held (thesis 3.3.4).

All predicates of a frame are smoothed at once, in one hidden Markov model whose hidden state is what the gripper does
with the object. Changes that come together are then one change, and a flicker of one predicate is outvoted by the
others. What cannot be is no state at all: an object that is not held is not in the air.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.special import log_expit

from learning.concepts.concept_spaces import ConceptSpaces
from learning.graphs.action_graphlet import ActionGraphlet
from learning.graphs.graphlet_state import GraphletState, Side
from learning.graphs.smoothing import constant_runs
from learning.graphs.state_chain import most_likely_states, switching_cost
from learning.perception.handling import (
    FIRST_FRAMES,
    OUTLIERS,
    above_evidence,
    bounded,
    force_evidence,
    holding_evidence,
    raised_evidence,
    seen,
    touch_evidence,
)
from learning.perception.held_object import with_held_object
from learning.perception.observation import Observation
from learning.perception.track_noise import track_noise
from learning.perception.tracks import moved_distance, moved_object
from robots.pose import FloatArray

STATE_TIME = 1.5
"""How long a qualitative state lasts on average [s]; shorter ones must be the clearer (`switching_cost`)."""
FIRST_PLACE, LAST_PLACE, IN_THE_AIR = 0, 1, 2
"""Places of the object before each stay in the air gets a location variable of its own."""
STATES: tuple[GraphletState, ...] = (
    *(GraphletState(closed, touch, at) for closed, touch, at in product((False, True), (False, True), (0, 1))),
    *(GraphletState(True, True, at, side=side) for side, at in product(Side, (FIRST_PLACE, LAST_PLACE))),
    GraphletState(True, True, IN_THE_AIR, raised=True),
)
"""All that the gripper can do with an object."""
TOUCHING_MEAN = 0.02
"""A distance concept with a larger mean [m] is not *at it*: no demo with a contact was seen yet."""


@dataclass(frozen=True, slots=True)
class Segment:
    """A state of the graphlet and the frames in which it held.

    Attributes:
        state: The state, with its location variable numbered in order of appearance.
        start: First frame.
        stop: One past the last frame; `start` where the state was too short to be seen.
    """

    state: GraphletState
    start: int
    stop: int


@dataclass(frozen=True, slots=True)
class Segmentation:
    """A demo cut into the states of its action graphlet.

    Attributes:
        graphlet: The action.
        segments: One a state of the graphlet, in order.
        observation: The demo's tracks, in which what is held goes where the hand goes.
        moved: Index of the manipulated object.
    """

    graphlet: ActionGraphlet
    segments: tuple[Segment, ...]
    observation: Observation
    moved: int

    @property
    def durations(self) -> tuple[float, ...]:
        """How long each state lasted [s]."""
        period = frame_period(self.observation)
        return tuple(period * (segment.stop - segment.start) for segment in self.segments)


def segmented(observation: Observation, spaces: ConceptSpaces) -> Segmentation:
    """Encode a demo that a camera saw as the states of its gripper and the object it manipulates.

    Args:
        observation: The demo's tracks, with extents.
        spaces: Concepts learned so far, for the *at it* concept.

    Raises:
        PerceptionError: No object was handled.
    """
    moved = moved_object(observation)
    observation = with_held_object(observation, moved)
    path = most_likely_states(_log_likelihood(observation, spaces, moved), _costs(frame_period(observation)))
    runs = [Segment(STATES[path[start]], start, stop) for start, stop in constant_runs(path)]
    runs = _coming_and_leaving(runs, len(path))
    segments = _numbered(_without_passing(_own_air(_one_change_at_a_time(runs))))
    return Segmentation(ActionGraphlet.of(each.state for each in segments), tuple(segments), observation, moved)


def frame_period(observation: Observation) -> float:
    """Time between two frames [s], the median."""
    return float(np.median(np.diff(observation.times))) if len(observation.times) > 1 else 0.1


def _costs(period: float) -> FloatArray:
    """What the change from each of `STATES` to each other costs, (S, S) [nats].

    Args:
        period: Time between two frames [s].
    """
    cost = switching_cost(max(STATE_TIME / period, 2.0), len(STATES))
    costs = np.full((len(STATES), len(STATES)), cost)
    np.fill_diagonal(costs, 0.0)
    for first, before in enumerate(STATES):
        for second, after in enumerate(STATES):
            if not before.raised and not after.raised and before.object_location != after.object_location:
                handled = any(state.gripper_closed and state.touching for state in (before, after))
                # On the table an object is moved by a closed hand that touches it, and then it does not come back.
                if not handled or after.object_location == FIRST_PLACE:
                    costs[first, second] = np.inf
            # Fingers that closed on nothing must open before they hold; what pries them apart they do not hold.
            if before.gripper_closed and not before.holds and after.holds:
                costs[first, second] = np.inf
    return costs


def _log_likelihood(observation: Observation, spaces: ConceptSpaces, moved: int) -> FloatArray:
    """Log likelihood of each frame under each of `STATES`, up to a constant, (F, S)."""
    mean, variance = _touching(spaces)
    holding, pushed_back = holding_evidence(observation), force_evidence(observation)
    touch = np.maximum(touch_evidence(observation, variance, mean)[:, moved], holding)  # what is felt is the object
    told_closed = np.where(observation.gripper_closed, 1.0, -1.0) * np.log((1.0 - OUTLIERS) / OUTLIERS)
    above = above_evidence(observation)[:, moved]
    raised = raised_evidence(observation)[:, moved]
    last_place = _last_place_evidence(observation, raised, moved)
    columns = []
    for state in STATES:
        column = log_expit(told_closed if state.gripper_closed else -told_closed)
        column = column + log_expit(touch if state.touching else -touch)
        column = column + log_expit(raised if state.raised else -raised)
        if not state.touching:
            column = column + _contradiction(-pushed_back)
        if state.gripper_closed:
            column = column + log_expit(holding if state.holds else -holding)
        if state.side is not None:
            column = column + _contradiction(above if state.side is Side.ABOVE else -above)
        if not state.raised:
            column = column + _contradiction(last_place if state.object_location == LAST_PLACE else -last_place)
        columns.append(column)
    likelihood = np.stack(columns, axis=1)
    if observation.gripper_opening is None:  # nothing is felt: a closed hand that touches holds, as on the board
        likelihood[:, [state.side is not None for state in STATES]] = -np.inf
    if np.all(last_place == 0.0):
        likelihood[:, [state.object_location == LAST_PLACE for state in STATES]] = -np.inf
    return likelihood


def _contradiction(evidence: FloatArray) -> FloatArray:
    """What evidence against an attribute takes from a state that has it, (F,): evidence for it gives nothing.

    Some states have no side, and some no place on the table. Those that have one must not gain by it.
    """
    return np.asarray(np.minimum(log_expit(evidence) + np.log(2.0), 0.0))


def _touching(spaces: ConceptSpaces) -> tuple[float, float]:
    """Mean [m] and variance [m²] of the *at it* concept: the distance concept nearest to none."""
    components = spaces.mixtures["distance"].components
    if not components:
        return 0.0, 0.0
    concept = components[spaces.touching]
    mean = float(concept.mean[0])
    return (mean, float(concept.covariance[0, 0])) if mean < TOUCHING_MEAN else (0.0, 0.0)


def _last_place_evidence(observation: Observation, raised: FloatArray, moved: int) -> FloatArray:
    """For the object being at its last place on the table rather than its first, (F,); 0 where it has one place only.

    A first place it has where the demo begins with the object at rest, a last one where it ends so. They are two where
    they are further apart than noise, and the closed hand moved as much: what nobody carries or pushes stays.
    """
    track = observation.location[:, moved, :2]
    nothing = np.zeros(len(track))
    if np.median(raised[:FIRST_FRAMES]) > 0.0 or np.median(raised[-FIRST_FRAMES:]) > 0.0:
        return nothing
    first, last = np.median(track[:FIRST_FRAMES], axis=0), np.median(track[-FIRST_FRAMES:], axis=0)
    closed = observation.gripper_location[observation.gripper_closed, :2]
    way = float(np.linalg.norm(np.ptp(closed, axis=0))) if len(closed) else np.inf
    threshold = float(moved_distance(observation)[moved])
    if min(float(np.linalg.norm(last - first)), way) <= threshold:
        return nothing
    variance = float(track_noise(observation)[moved]) ** 2
    nearer = np.sum((track - first) ** 2, axis=1) - np.sum((track - last) ** 2, axis=1)
    return bounded(nearer / (2.0 * variance)) * seen(observation)[:, moved]


def _coming_and_leaving(runs: list[Segment], frames: int) -> list[Segment]:
    """Let a hand that does not hold the object at the start have come to it, and one that does not at the end leave it.

    Where in time a demo is cut is chance: one ends when the fingers are open, another when the hand is well away.
    """
    first, last = runs[0].state, runs[-1].state
    if first.touching and not first.holds:
        runs = [Segment(GraphletState(first.gripper_closed, False, first.object_location), 0, 0), *runs]
    if last.touching and not last.holds:
        away = GraphletState(last.gripper_closed, False, last.object_location)
        runs = [*runs, Segment(away, frames, frames)]
    return runs


def _one_change_at_a_time(runs: list[Segment]) -> Iterator[Segment]:
    """Put in the states that were too short to be seen between two that differ in more than one respect.

    A hand that comes is there before it closes, and has closed before it carries. A hand that leaves opens first, what
    it lets go of falls then, and last it is away.
    """
    before: Segment | None = None
    for run in runs:
        if before is not None:
            for state in _between(before.state, run.state):
                yield Segment(state, run.start, run.start)
        yield run
        before = run


def _between(before: GraphletState, after: GraphletState) -> Iterator[GraphletState]:
    """The states between two, one change at a time; none if there is one change only."""
    closed, touching = before.gripper_closed, before.touching
    place = before.object_location, before.raised
    steps: list[GraphletState] = []

    def step(side: Side | None) -> None:
        steps.append(GraphletState(closed, touching, place[0], place[1], side))

    if after.touching and not touching:
        touching = True
        step(after.side if closed else None)
    if after.gripper_closed != closed:
        closed = after.gripper_closed
        step(after.side if closed and touching else None)
    if (after.object_location, after.raised) != place:
        place = after.object_location, after.raised
        step((before.side if after.side is None else after.side) if closed and touching else None)
    yield from (state for state in steps if state not in (before, after))


def _own_air(runs: Iterator[Segment]) -> Iterator[Segment]:
    """Give each stay in the air a location variable of its own."""
    stays, aloft = 0, False
    for run in runs:
        stays += run.state.raised and not aloft
        aloft = run.state.raised
        yield Segment(run.state.at(IN_THE_AIR + stays), run.start, run.stop) if aloft else run


def _without_passing(runs: Iterator[Segment]) -> list[Segment]:
    """Join equal neighbours, and of states that differ in location alone keep the first and the last.

    As in `ActionGraphlet.of`, which then has nothing left to do.
    """
    kept: list[Segment] = []
    for run in runs:
        if kept and kept[-1].state == run.state:
            kept[-1] = Segment(run.state, kept[-1].start, run.stop)
        elif len(kept) >= 2 and _same_but_place(kept[-2], run) and _same_but_place(kept[-1], run):
            kept[-1] = Segment(run.state, kept[-1].start, run.stop)
            if kept[-1].state == kept[-2].state:
                last = kept.pop()
                kept[-1] = Segment(last.state, kept[-1].start, last.stop)
        else:
            kept.append(run)
    return kept


def _same_but_place(first: Segment, second: Segment) -> bool:
    return first.state.at(0) == second.state.at(0)


def _numbered(segments: list[Segment]) -> list[Segment]:
    """Number location variables in order of first appearance."""
    graphlet = ActionGraphlet.of(segment.state for segment in segments)
    return [Segment(state, each.start, each.stop) for state, each in zip(graphlet.states, segments, strict=True)]
