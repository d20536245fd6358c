"""How well objects are followed through a demo: position error and identity switches, against the recorded states."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from learning.evaluation.machine import machine
from learning.perception.observation import Observation
from robots.pose import FloatArray

GATE = 0.05
"""A track is an object's in a frame when it is nearer than this [m]; larger than errors, about one object."""


@dataclass(frozen=True, slots=True)
class TrackingScore:
    """How one demo was tracked.

    Attributes:
        errors: Distance of each object's centre from the truth in every frame in which it was seen, (k,) [m].
        hidden_errors: The same where it was not seen, (h,) [m].
        switches: Identity switches: frames in which another track than before is an object's.
        objects: True objects.
        found: Objects that a track followed.
        extra: Tracks that followed none.
        occluded: Whether an object was hidden for a while and seen again.
    """

    errors: FloatArray
    hidden_errors: FloatArray
    switches: int
    objects: int
    found: int
    extra: int
    occluded: bool


def score_tracking(seen: Observation, times: FloatArray, positions: FloatArray) -> TrackingScore:
    """Compare an observation with the truth.

    Tracks are matched to objects as in CLEAR MOT (Bernardin & Stiefelhagen 2008): a pair stays while it is near;
    the others are matched by least distance.

    Args:
        seen: The observation.
        times: Times of the true states, (T,) [s].
        positions: True centres, (T, M, 3) [m].
    """
    at = np.clip(np.searchsorted(times, seen.times - 1e-6), 0, len(times) - 1)
    true = positions[at]
    visible = np.ones(seen.location.shape[:2], dtype=bool) if seen.visible is None else seen.visible
    apart = np.linalg.norm(seen.location[:, :, None] - true[:, None], axis=3)  # (F, N, M)
    votes = np.zeros(apart.shape[1:], dtype=np.int64)
    last: dict[int, int] = {}
    switches = 0
    for frame in range(len(apart)):
        pairs = _matched(apart[frame], visible[frame], last)
        for thing, track in pairs.items():
            switches += thing in last and last[thing] != track
            votes[track, thing] += 1
        last |= pairs
    errors, hidden, followed = [], [], set()
    extra = 0
    for track in range(votes.shape[0]):
        if votes.shape[1] == 0 or votes[track].max() == 0:
            extra += 1
            continue
        thing = int(votes[track].argmax())
        followed.add(thing)
        errors.append(apart[visible[:, track], track, thing])
        hidden.append(apart[~visible[:, track], track, thing])
    return TrackingScore(
        errors=np.concatenate(errors) if errors else np.zeros(0),
        hidden_errors=np.concatenate(hidden) if hidden else np.zeros(0),
        switches=switches,
        objects=positions.shape[1],
        found=len(followed),
        extra=extra,
        occluded=bool(any(_comes_back(visible[:, track]) for track in range(visible.shape[1]))),
    )


def _matched(apart: FloatArray, visible: NDArray[np.bool_], last: dict[int, int]) -> dict[int, int]:
    """Object to track in one frame, given distances (N, M) and earlier pairs."""
    pairs = {thing: track for thing, track in last.items() if visible[track] and apart[track, thing] < GATE}
    tracks = [track for track in np.flatnonzero(visible).tolist() if track not in pairs.values()]
    things = [thing for thing in range(apart.shape[1]) if thing not in pairs]
    if tracks and things:
        cost = np.minimum(apart[np.ix_(tracks, things)], GATE)
        for row, column in zip(*linear_sum_assignment(cost), strict=True):
            if cost[row, column] < GATE:
                pairs[things[column]] = tracks[row]
    return pairs


def _comes_back(visible: NDArray[np.bool_]) -> bool:
    """Whether a track is seen, not seen, and seen again."""
    shown = np.flatnonzero(visible)
    return bool(len(shown)) and not bool(visible[shown[0] : shown[-1] + 1].all())


@dataclass(frozen=True, slots=True)
class TrackingReport:
    """Scores of many demos.

    Attributes:
        scores: One for each demo.
        failures: Demo and reason where it could not be scored.
        seed: Seed of the perception.
    """

    scores: Sequence[TrackingScore]
    failures: Sequence[tuple[str, str]]
    seed: int

    def figures(self) -> dict[str, float | None]:
        """Figures over all demos: errors are in millimetres, over seen objects and frames."""
        errors = np.concatenate([np.zeros(0), *(each.errors for each in self.scores)])
        hidden = np.concatenate([np.zeros(0), *(each.hidden_errors for each in self.scores)])
        occluded = [each for each in self.scores if each.occluded]
        objects = sum(each.objects for each in self.scores)
        return {
            "demos": float(len(self.scores)),
            "frames": float(len(errors) + len(hidden)),
            "median_error_mm": _percentile(errors, 50),
            "p95_error_mm": _percentile(errors, 95),
            "hidden.median_error_mm": _percentile(hidden, 50),
            "switches": float(sum(each.switches for each in self.scores)),
            "without_switch": _share([each.switches == 0 for each in self.scores]),
            "occluded.demos": float(len(occluded)),
            "occluded.without_switch": _share([each.switches == 0 for each in occluded]),
            "objects_found": sum(each.found for each in self.scores) / objects if objects else None,
            "extra_tracks": float(sum(each.extra for each in self.scores)),
        }

    def to_json(self) -> dict[str, object]:
        """What `showtell evaluate tracking --json` prints."""
        return {
            "figures": self.figures(),
            "baselines": {},
            "failures": [{"demo": demo, "reason": reason} for demo, reason in self.failures],
            "machine": machine(),
            "seed": self.seed,
        }


def _percentile(values: FloatArray, part: float) -> float | None:
    return 1000 * float(np.percentile(values, part)) if len(values) else None


def _share(good: Sequence[bool]) -> float | None:
    return sum(good) / len(good) if good else None
