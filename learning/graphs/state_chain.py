"""The most likely sequence of hidden qualitative states behind noisy frames: a hidden Markov model (Viterbi 1967)."""

import numpy as np
from numpy.typing import NDArray

from robots.pose import FloatArray


def switching_cost(expected_frames: float, states: int) -> float:
    """What a change of state costs [nats], as against staying.

    States are taken to last a geometrically distributed time and to be followed by any other state alike. A state in
    the middle is therefore seen only where the frames speak for it with twice this much: at 10 Hz, for states of 1.5 s
    on average and 13 of them, 2 x 5.1, which is four frames in which one measurement says so as clearly as one can, or
    two in which two do. That, and no count of frames, is how short a state may be.

    Args:
        expected_frames: Mean duration of a state in frames, above 1.
        states: Number of states.
    """
    change = 1.0 / expected_frames
    return float(np.log1p(-change) - np.log(change / max(states - 1, 1)))


def most_likely_states(log_likelihood: FloatArray, costs: FloatArray) -> NDArray[np.int64]:
    """The sequence of states with the largest posterior probability, (F,).

    Args:
        log_likelihood: Log likelihood of each frame's measurements under each state, (F, S); -inf forbids a state.
        costs: What the change from the one state to the other costs, (S, S) [nats]: 0 for staying, `switching_cost` for
            changes, inf for those that cannot be.
    """
    frames, number = log_likelihood.shape
    came_from = np.zeros((frames, number), dtype=np.int64)
    score = log_likelihood[0].copy() if frames else np.zeros(number)
    for frame in range(1, frames):
        reached = score[:, None] - costs
        came_from[frame] = np.argmax(reached, axis=0)
        score = reached[came_from[frame], np.arange(number)] + log_likelihood[frame]
    path = np.zeros(frames, dtype=np.int64)
    state = int(np.argmax(score))
    for frame in range(frames - 1, -1, -1):
        path[frame] = state
        state = int(came_from[frame, state])
    return path
