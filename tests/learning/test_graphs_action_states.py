"""Actions of hand-made tracks: key frames, and driven ones with slow approach, noise and flicker."""

from dataclasses import replace

import numpy as np
import pytest

from learning.concepts import ConceptSpaces, fit_demo
from learning.errors import PerceptionError
from learning.graphs import StateGraph, action_of
from learning.perception import KeyFrame, observe_key_frames
from learning.perception.board_noise import FRAME_TIME, TrueTracks, observed
from learning.perception.observation import Observation
from tests.learning.board_demos import Cell, blocks, key_frames, random_demo
from tests.learning.test_graphs_action_graphlet import DROP, MOVE, TAKE
from twin.board import cell_centre

CELLS: list[Cell] = [(2, 2, 0), (2, 2, 1), (4, 5, 0), (1, 2, 0)]
OBJECTS = blocks(*zip(CELLS, ("red", "green", "blue", "white"), ("cube",) * 4, strict=True))
MOVED = 1
PLANS = {"take": (TAKE, (2, 2, 9)), "drop": (DROP, (2, 2, 1)), "move": (MOVE, (4, 5, 1))}
SPEED = 0.25
"""Of the gripper [m/s]."""


@pytest.fixture(scope="module")
def spaces() -> ConceptSpaces:
    rng = np.random.default_rng(0)
    known = ConceptSpaces()
    for kind in ("move", "take", "drop") * 5:
        known.update(fit_demo(random_demo(rng, kind).observation, rng))
    return known


def start_cells(kind: str) -> list[Cell]:
    cells = list(CELLS)
    if kind == "drop":
        cells[MOVED] = (2, 2, 9)
    return cells


def driven(kind: str, rng: np.random.Generator) -> Observation:
    """The key frames joined by motion, with grasps that are off the centre and fingers that take their time."""
    frames = key_frames(start_cells(kind), MOVED, PLANS[kind][1], kind)
    grip, closed, block = [], [], []
    off = rng.normal(0, 0.003, 3)  # where the gripper holds the block
    for before, after in zip(frames, frames[1:], strict=False):
        way = after.gripper_location - before.gripper_location
        steps = max(int(np.linalg.norm(way) / (SPEED * FRAME_TIME)), int(rng.integers(3, 7)))
        for share in np.linspace(0, 1, steps, endpoint=False):
            grip.append(before.gripper_location + share * way + off)
            closed.append(before.gripper_closed)
            carried = before.gripper_closed and after.gripper_closed
            there = before.object_location[MOVED] + (share * way if carried else 0.0)
            block.append(there)
    for _ in range(4):
        grip.append(frames[-1].gripper_location + off)
        closed.append(frames[-1].gripper_closed)
        block.append(frames[-1].object_location[MOVED])
    location = np.repeat(frames[0].object_location[None], len(grip), axis=0)
    location[:, MOVED] = block
    tracks = TrueTracks(FRAME_TIME * np.arange(len(grip)), np.array(grip), np.array(closed), location)
    return observed(tracks, OBJECTS, rng)


def test_what_the_hand_does_before_it_comes_and_after_it_left_is_no_part_of_the_action(spaces: ConceptSpaces) -> None:
    frames = key_frames(start_cells("move"), MOVED, PLANS["move"][1], "move")
    shut = [replace(each, gripper_closed=True) for each in (frames[0], frames[-1])]
    away = [replace(each, gripper_location=each.gripper_location + (0.0, 0.0, 0.1)) for each in shut]
    busy = observe_key_frames([away[0]] * 4 + [*frames] + [away[1]] * 4, OBJECTS, np.random.default_rng(0))
    assert action_of(busy, spaces) == MOVE


@pytest.mark.parametrize("kind", PLANS)
@pytest.mark.parametrize("seed", range(8))
def test_driven_demos_and_key_frames_give_the_same_action(kind: str, seed: int, spaces: ConceptSpaces) -> None:
    rng = np.random.default_rng(seed)
    expected, goal = PLANS[kind]
    still = observe_key_frames(key_frames(start_cells(kind), MOVED, goal, kind), OBJECTS, rng)
    assert action_of(still, spaces) == expected
    assert action_of(driven(kind, rng), spaces) == expected


def test_flicker_of_a_frame_changes_nothing(spaces: ConceptSpaces) -> None:
    for frame in range(1, 35):
        observation = driven("move", np.random.default_rng(1))
        gripper, closed = observation.gripper_location.copy(), observation.gripper_closed.copy()
        gripper[frame] += 0.2  # the gripper is lost from sight once
        closed[frame] = not closed[frame] if 0 < frame < len(closed) - 1 and _steady(closed, frame) else closed[frame]
        flickering = Observation(
            observation.times,
            gripper,
            closed,
            observation.object_ids,
            observation.location,
            observation.colour,
            observation.shape,
        )
        assert action_of(flickering, spaces) == MOVE


def _steady(closed: np.ndarray, frame: int) -> bool:
    """Away from the changes, where one frame more or less would move a change rather than flicker."""
    return bool(np.all(closed[max(frame - 3, 0) : frame + 4] == closed[frame]))


def test_a_gripper_that_closes_as_it_arrives_has_been_there_open(spaces: ConceptSpaces) -> None:
    start, goal = cell_centre(*CELLS[MOVED]), cell_centre(4, 5, 1)
    location = np.array([cell_centre(*cell) for cell in CELLS])
    frames = []
    for gripper, closed, block in (
        (cell_centre(2, 2, 9), False, start),
        (start, True, start),
        (goal, True, goal),
        (cell_centre(4, 5, 9), False, goal),
    ):
        here = location.copy()
        here[MOVED] = block
        frames.append(KeyFrame(gripper, closed, here))
    assert action_of(observe_key_frames(frames, OBJECTS, np.random.default_rng(2)), spaces) == MOVE


def test_when_nothing_moves_that_is_said(spaces: ConceptSpaces) -> None:
    still = KeyFrame(cell_centre(0, 0, 9), False, np.array([cell_centre(*cell) for cell in CELLS]))
    observation = observe_key_frames([still, still], OBJECTS, np.random.default_rng(3))
    with pytest.raises(PerceptionError, match="no object was moved: the largest change of place is . mm"):
        action_of(observation, spaces)


def test_what_was_carried_away_and_put_back_was_moved(spaces: ConceptSpaces) -> None:
    frames = key_frames(start_cells("move"), MOVED, (4, 5, 1), "move")
    frames += [KeyFrame(f.gripper_location, f.gripper_closed, f.object_location) for f in frames[-2::-1]]
    graph = StateGraph.of(observe_key_frames(frames, OBJECTS, np.random.default_rng(4)), spaces)
    assert [str(state)[:7] for state in graph.action.states] == [
        "O apart",
        "O touch",
        "C touch",
        "O touch",
        "O apart",
        "O touch",
        "C touch",
        "O touch",
        "O apart",
    ]
    assert {state.object_location for state in graph.action.states} == {0}
