"""Actions seen by a camera: one graphlet for each of ten actions, whatever the way in which it is shown."""

from dataclasses import replace

import numpy as np
import pytest

from learning.concepts import ConceptSpaces
from learning.errors import PerceptionError
from learning.graphs import ActionGraphlet, GraphletState, Side, action_of
from learning.graphs.action_measures import measured
from learning.graphs.camera_states import segmented
from tests.learning.table_demos import ORDERING, PERIOD, TABLETOP, Noise, table_demo

VARIATIONS = 50
A, B = Side.ABOVE, Side.BESIDE
OPEN_AWAY, OPEN_AT, HELD = (False, False, 0), (False, True, 0), (True, True, 0)
GRAPHLETS: dict[str, list[GraphletState]] = {
    "grasp": [GraphletState(*OPEN_AWAY), GraphletState(*OPEN_AT), GraphletState(*HELD)],
    "lift": [GraphletState(*HELD), GraphletState(True, True, 1, raised=True)],
    "lower": [GraphletState(*HELD, raised=True), GraphletState(True, True, 1)],
    "drop": [
        GraphletState(*HELD, raised=True),
        GraphletState(*OPEN_AT, raised=True),
        GraphletState(False, True, 1),
        GraphletState(False, False, 1),
    ],
    "press": [GraphletState(True, False, 0), GraphletState(*HELD, side=A), GraphletState(True, False, 0)],
    "push": [
        GraphletState(True, False, 0),
        GraphletState(*HELD, side=B),
        GraphletState(True, True, 1, side=B),
        GraphletState(True, False, 1),
    ],
    "hold": [GraphletState(*HELD, raised=True)],
    "pick up": [
        GraphletState(*OPEN_AWAY),
        GraphletState(*OPEN_AT),
        GraphletState(*HELD),
        GraphletState(True, True, 1, raised=True),
    ],
    "put down": [
        GraphletState(*HELD, raised=True),
        GraphletState(True, True, 1),
        GraphletState(False, True, 1),
        GraphletState(False, False, 1),
    ],
}
GRAPHLETS["move"] = [
    *GRAPHLETS["pick up"],
    GraphletState(True, True, 2),
    GraphletState(False, True, 2),
    GraphletState(False, False, 2),
]


@pytest.mark.parametrize("action", ORDERING | TABLETOP)
def test_each_action_is_one_graphlet_in_fifty_variations(action: str) -> None:
    expected = ActionGraphlet(tuple(GRAPHLETS[action]))
    for seed in range(VARIATIONS):
        observation, handled = table_demo(np.random.default_rng([seed, 1]), action)
        segmentation = segmented(observation, ConceptSpaces())
        assert segmentation.graphlet == expected, f"variation {seed}"
        assert segmentation.moved == handled, f"variation {seed}"


def test_the_ten_actions_are_ten_graphlets() -> None:
    assert len({ActionGraphlet(tuple(states)) for states in GRAPHLETS.values()}) == len(GRAPHLETS) == 10


def test_twice_the_noise_leaves_nearly_all_of_them_as_they_are() -> None:
    noise = Noise(place=0.01, hidden=0.01, flicker=0.03, gaps=2.0)
    same = [
        segmented(table_demo(np.random.default_rng([seed, 2]), action, noise=noise)[0], ConceptSpaces()).graphlet
        == ActionGraphlet(tuple(GRAPHLETS[action]))
        for seed in range(15)
        for action in GRAPHLETS
    ]
    assert np.mean(same) >= 0.97  # a track may be lost just when it matters


@pytest.mark.parametrize("action", GRAPHLETS)
def test_segments_cover_the_demo_in_order(action: str) -> None:
    observation, _ = table_demo(np.random.default_rng(5), action)
    segmentation = segmented(observation, ConceptSpaces())
    assert tuple(segment.state for segment in segmentation.segments) == segmentation.graphlet.states
    assert ActionGraphlet.of(segmentation.graphlet.states) == segmentation.graphlet
    assert segmentation.segments[0].start == 0
    assert segmentation.segments[-1].stop == len(observation.times)
    for before, after in zip(segmentation.segments, segmentation.segments[1:], strict=False):
        assert before.stop == after.start <= after.stop
    assert sum(segmentation.durations) == pytest.approx(PERIOD * len(observation.times))


def test_without_a_sense_of_the_fingers_a_closed_hand_that_touches_holds() -> None:
    observation, _ = table_demo(np.random.default_rng(6), "pick up")
    felt = action_of(observation, ConceptSpaces())
    assert action_of(replace(observation, gripper_opening=None), ConceptSpaces()) == felt


def test_a_hand_that_touches_nothing_is_no_action() -> None:
    observation, _ = table_demo(np.random.default_rng(7), "press")
    aside = replace(observation, gripper_location=observation.gripper_location + [0.0, 0.3, 0.3])
    with pytest.raises(PerceptionError, match="no object was handled: the largest evidence for it is 0.0 nats"):
        action_of(aside, ConceptSpaces())


def test_what_is_measured_is_what_was_done() -> None:
    heights, pushed, pressed = [], [], []
    for seed in range(5):
        observation, handled = table_demo(np.random.default_rng([seed, 8]), "lift")
        tool = observation.gripper_location[:, 2]
        shown = measured(segmented(observation, ConceptSpaces()))
        heights.append(shown[1]["clearance"][0] - (tool[-1] - tool[0]))
        assert observation.gripper_opening is not None
        assert shown[1]["opening"][0] == pytest.approx(observation.gripper_opening[-1], abs=0.001)  # steady fingers

        observation, handled = table_demo(np.random.default_rng([seed, 8]), "push")
        track = observation.location[:, handled, :2]
        way = np.linalg.norm(np.median(track[-9:], axis=0) - np.median(track[:9], axis=0))
        shown = measured(segmented(observation, ConceptSpaces()))
        pushed.append(shown[2]["travel"][0] - way)
        assert shown[1]["offset"][0] < -0.01 and shown[1]["faces"][0] < 0.0  # from behind, below the top
        assert shown[1]["approach"][0] > 0.8

        observation, handled = table_demo(np.random.default_rng([seed, 8]), "press")
        shown = measured(segmented(observation, ConceptSpaces()))
        pressed.append(shown[1]["force"][2] - shown[0]["force"][2])
        assert shown[1]["faces"][0] == pytest.approx(0.0075, abs=0.02)  # pressed at 0 to 15 mm, seen with 1 cm noise
        assert shown[1]["approach"][2] < -0.8
    assert np.abs(heights).max() < 0.02  # three times the track's noise
    assert np.abs(pushed).max() < 0.02
    assert np.mean(pressed) > 2.0  # 6 N, in most of the state's frames
