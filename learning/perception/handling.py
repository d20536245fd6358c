"""Evidence, frame by frame, of what the hand does with each object: log likelihood ratios of noisy measurements.

Each is the logarithm of how much better a measurement is explained by one hypothesis than by the other. A measurement
may also be an outlier (a track that flickers), which no hypothesis explains: that bounds what one frame can say.
What is not seen says nothing: 0.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.special import log_ndtr

from learning.graphs.smoothing import constant_runs
from learning.perception.gaps import box_size, face_distances, gap_offsets
from learning.perception.observation import Observation
from learning.perception.track_noise import track_noise
from robots.pose import FloatArray

OUTLIERS = 0.05
"""Share of frames whose measurements are outliers."""
HAND_SIZE = 0.015
"""Standard deviation of where on the hand it touches an object, about the tool point [m]: fingers have a size."""
CLOSED_HAND_SIZE = 0.022
"""The same of fingers that are closed on nothing: their tips come together beyond the tool point [m]."""
REACH = 0.3
"""A hand that touches nothing is anywhere within this of an object, or further away [m]."""
UNSEEN = 0.015
"""Standard deviation [m] that an object's place has in addition while it is not seen: left alone, it stays."""
AIR = 0.6
"""An object in the air is anywhere up to this height [m]."""
EMPTY_NOISE = 0.0008
"""Standard deviation of the gap that is measured when the fingers are closed on nothing [m]."""
WIDEST = 0.1
"""Objects between the fingers are of any width up to this [m]."""
FINGERS_STILL = 0.002
"""Fingers whose gap changes by less than this from one frame to the next have stopped [m]."""
LEAST_FORCE = 0.5
"""Forces are not told apart better than this [N]."""
STRONGEST = 20.0
"""Standard deviation of the forces with which a hand pushes [N]."""
UNSEEN_ERROR = 0.12
"""The same of an object that is in the hand all the time and so never seen whole, if it rises or sinks [m];"""
LEAST_RISE = 0.04
"""what does not rise or sink as much tells nothing of where the table is [m]."""
FIRST_FRAMES = 5
"""Frames over which the first place of an object is taken."""
FRAGMENT = 0.12
"""What is seen of an object in the hand is no further from the tool point [m]."""
PLACE_ERROR = 0.01
"""Standard deviation of what an object's place seems to change when a hand hides part of it [m]."""
HIGH = 0.8
"""Quantile of how far a track is off its middle that tells whether it moves: it also flickers."""
MOVED_SIGMAS = 3.0
"""Standard deviations from its first place within which an object may not have moved at all."""
LEAST_CLEARANCE_NOISE = 0.008
"""No camera tells an object's underside better than this [m]: it does not see it."""
RESTING_ERROR = 0.03
"""Largest systematic error of an underside that is explained away [m]."""


def bounded(ratio: FloatArray) -> FloatArray:
    """Log likelihood ratio when a share of the measurements are outliers: between log OUTLIERS and -log OUTLIERS."""
    likelihood = np.exp(np.clip(ratio, -50.0, 50.0))
    mixed = (1.0 - OUTLIERS) * likelihood + OUTLIERS
    return np.asarray(np.log(mixed / (1.0 - OUTLIERS + OUTLIERS * likelihood)))


def touch_evidence(observation: Observation, variance: float = 0.0, mean: float = 0.0) -> FloatArray:
    """For the hand touching each object rather than being apart from it, (F, N).

    Args:
        observation: Tracks.
        variance: Variance of the *at it* concept [m²]; where it is small, few ways of touching were seen yet.
        mean: Its mean [m].
    """
    gap = np.linalg.norm(gap_offsets(observation), axis=2)
    empty = observation.gripper_closed & (holding_evidence(observation) < 0.0)
    hand = np.where(empty, CLOSED_HAND_SIZE, HAND_SIZE)[:, None]
    unseen = UNSEEN * (1.0 - seen(observation))
    spread = np.sqrt(np.maximum(variance, hand**2) + track_noise(observation) ** 2 + unseen**2)
    off = np.maximum(gap - mean, 0.0) / spread
    # A half normal distribution, as gaps are not negative, against any gap within reach.
    ratio = -0.5 * off**2 + np.log(2.0 * REACH / (np.sqrt(2.0 * np.pi) * spread))
    return bounded(ratio)


def holding_evidence(observation: Observation) -> FloatArray:
    """For something being between the closed fingers rather than nothing, (F,); 0 where they are open, or move.

    A knife leaves no gap that could be felt. But fingers that are closed on nothing lift nothing: where an object rises
    or sinks with the hand, they hold it.
    """
    opening = observation.gripper_opening
    if opening is None:
        return np.zeros(len(observation.times))
    empty = -0.5 * (opening / EMPTY_NOISE) ** 2 + np.log(2.0 / (np.sqrt(2.0 * np.pi) * EMPTY_NOISE))
    change = np.abs(np.diff(opening, prepend=opening[:1]))
    stopped = observation.gripper_closed & (change < FINGERS_STILL)
    evidence = np.where(stopped, bounded(np.log(1.0 / WIDEST) - empty), 0.0)
    for start, stop in constant_runs(observation.gripper_closed):
        if (
            observation.gripper_closed[start]
            and evidence[start:stop].sum() < 0.0
            and _carries(observation, start, stop)
        ):
            evidence[start:stop] = np.where(stopped[start:stop], np.abs(evidence[start:stop]), 0.0)
    return np.asarray(evidence)


def _carries(observation: Observation, start: int, stop: int) -> bool:
    """Whether an object that is seen rises or sinks with the hand in some frames."""
    hand = observation.gripper_location[start:stop]
    told = seen(observation)[start:stop] > 0.0
    for index in range(observation.location.shape[1]):
        track = observation.location[start:stop, index]
        near = told[:, index] & (np.linalg.norm(track - hand, axis=1) < FRAGMENT)
        if np.count_nonzero(near) < FIRST_FRAMES:
            continue
        height, between = track[near, 2], track[near, 2] - hand[near, 2]
        # As high above the hand in most frames as in the others, wherever it is: quantiles, since tracks flicker.
        rise = np.quantile(height, HIGH) - np.quantile(height, 1.0 - HIGH)
        slip = np.quantile(between, HIGH) - np.quantile(between, 1.0 - HIGH)
        if rise > LEAST_RISE and slip < 0.5 * rise:
            return True
    return False


def force_evidence(observation: Observation) -> FloatArray:
    """For a hand that is closed on nothing being pushed back by something, (F,): 0 or more; a light touch is not felt.

    The wrist also feels the hand's own weight and how it is swung about. What it feels of that is its noise.
    """
    if observation.wrist_force is None:
        return np.zeros(len(observation.times))
    free = holding_evidence(observation) < 0.0
    if np.count_nonzero(free) < 2 * FIRST_FRAMES:
        return np.zeros(len(observation.times))
    force = np.linalg.norm(observation.wrist_force - np.median(observation.wrist_force[free], axis=0), axis=1)
    noise = max(LEAST_FORCE, float(np.median(force[free])))
    swung = -0.5 * (force / noise) ** 2 - np.log(noise)
    pushed = -0.5 * (force / STRONGEST) ** 2 - np.log(STRONGEST)
    return np.where(free, np.maximum(bounded(pushed - swung), 0.0), 0.0)


def above_evidence(observation: Observation) -> FloatArray:
    """For the hand touching each object's top rather than its side, (F, N).

    That is the side to which the hand is further out of the box, told through the noise of the track.
    """
    above, outside = face_distances(observation)
    spread = np.sqrt(2.0) * np.maximum(track_noise(observation), EMPTY_NOISE)
    off = (above - outside) / spread
    return bounded(log_ndtr(off) - log_ndtr(-off)) * seen(observation)


def raised_evidence(observation: Observation) -> FloatArray:
    """For each object being in the air rather than resting on what is below it, (F, N).

    What no hand holds rests, and how far its underside seems off the table then is an error of sight. An object that is
    in the hand all the time is taken to rest where it is lowest, if that is low.

    Args:
        observation: Tracks.
    """
    clearance = _clearance(observation)
    told = seen(observation)
    free = ~observation.gripper_closed | (holding_evidence(observation) < 0.0)
    noise = track_noise(observation)
    spread = np.maximum(noise, LEAST_CLEARANCE_NOISE)
    for index in range(clearance.shape[1]):
        column = clearance[:, index]
        resting = column[free & (told[:, index] > 0.0)]
        if len(resting) >= FIRST_FRAMES:
            column -= np.median(resting)
            spread[index] = np.sqrt(2.0) * noise[index]  # both looks are noisy; the error of sight is gone
        else:
            ordered = np.sort(column)
            lowest, highest = float(np.median(ordered[:FIRST_FRAMES])), float(np.median(ordered[-FIRST_FRAMES:]))
            if lowest < (UNSEEN_ERROR if highest - lowest > LEAST_RISE else RESTING_ERROR):
                column -= lowest
    off = np.maximum(clearance, 0.0) / spread
    resting_density = -0.5 * off**2 + np.log(2.0 / (np.sqrt(2.0 * np.pi) * spread))
    return bounded(np.log(1.0 / AIR) - resting_density) * told


def seen(observation: Observation) -> FloatArray:
    """1 where an object was seen or felt to be, 0 where its place is a belief, (F, N)."""
    shape = observation.location.shape[:2]
    return np.ones(shape) if observation.visible is None else np.asarray(observation.visible, dtype=np.float64)


def _clearance(observation: Observation) -> FloatArray:
    """Height of each object's underside above the table or above what stands under its centre, (F, N) [m]."""
    radius, half_height = box_size(observation)
    location = observation.location
    underside = location[..., 2] - half_height
    top = location[..., 2] + half_height
    along = np.linalg.norm(location[:, :, None, :2] - location[:, None, :, :2], axis=3)  # [f, i, j]
    below = (along < radius) & (top[:, None, :] < underside[:, :, None] + RESTING_ERROR)
    below &= ~np.eye(location.shape[1], dtype=bool)
    # What moves itself bears nothing: it is a part of what is held that was taken for a thing of its own.
    off = np.linalg.norm(location - np.median(location, axis=0), axis=2)
    below &= np.quantile(off, HIGH, axis=0) < MOVED_SIGMAS * np.sqrt(track_noise(observation) ** 2 + PLACE_ERROR**2)
    support = np.where(below, top[:, None, :], 0.0).max(axis=2, initial=0.0)
    return np.asarray(underside - support)


def felt(observation: Observation) -> NDArray[np.bool_]:
    """Frames in which the hand feels something between its closed fingers, (F,)."""
    return np.asarray(holding_evidence(observation) > 0.0)


def handled_evidence(observation: Observation) -> FloatArray:
    """How much better each object's track is explained by its being handled than by its being left alone, (N,) [nats].

    What is left alone stays where it was first seen, and a closed hand is near it by chance only. What the fingers feel
    between them is the nearest object, even where no more of it is seen than what sticks out of the hand.
    """
    touching = np.maximum(touch_evidence(observation), 0.0)[observation.gripper_closed].sum(axis=0)
    gap = np.linalg.norm(gap_offsets(observation), axis=2)
    in_hand = (gap == gap.min(axis=1, keepdims=True)) & (gap < FRAGMENT) & felt(observation)[:, None]
    touching += np.log((1.0 - OUTLIERS) / OUTLIERS) * in_hand.sum(axis=0)
    first = np.median(observation.location[:FIRST_FRAMES], axis=0)
    spread = np.sqrt(track_noise(observation) ** 2 + PLACE_ERROR**2)
    away = np.linalg.norm(observation.location - first, axis=2) / spread
    moved = np.where(away > MOVED_SIGMAS, bounded(0.5 * away**2 - 0.5 * MOVED_SIGMAS**2) * seen(observation), 0.0)
    return np.asarray(touching + moved.sum(axis=0))
