"""Looks at a table: things keep their numbers from look to look, and a step can be imagined."""

from dataclasses import replace

import numpy as np

from executor.tables.table_view import TableView, lost_colours
from executor.tables.taken import Taken, as_taken
from learning.perception.observation import Observation

RED, BLUE = [0.0, 0.8, 0.5], [0.62, 0.8, 0.5]


def look(*things: tuple[list[float], list[float]]) -> Observation:
    """What a camera saw of things at rest: centre and colour of each, over six frames."""
    frames, count = 6, len(things)
    return Observation(
        times=0.1 * np.arange(frames),
        gripper_location=np.tile([0.3, 0.3, 0.5], (frames, 1)),
        gripper_closed=np.zeros(frames, dtype=bool),
        object_ids=np.arange(count),
        location=np.tile([centre for centre, _ in things], (frames, 1, 1)).astype(float),
        colour=np.tile([colour for _, colour in things], (frames, 1, 1)).astype(float),
        shape=np.full((frames, count, 33), 1.0 / 33.0),
        extent=np.tile([0.05, 0.05, 0.1], (frames, count, 1)),
        gripper_opening=np.full(frames, 0.08),
    )


def test_what_stays_or_is_carried_keeps_its_number_and_what_is_new_gets_another() -> None:
    first = TableView.of(look(([0.5, 0.2, 0.05], RED), ([0.6, -0.2, 0.05], BLUE)))
    assert first.numbers == (0, 1)
    # The next look finds them in another order, the red one carried away, and a second blue one.
    now = TableView.of(look(([0.6, -0.2, 0.05], BLUE), ([0.8, 0.0, 0.05], BLUE), ([0.75, 0.25, 0.05], RED)), first)
    assert now.numbers == (1, 2, 0)
    assert now.index_of(0) == 2 and now.index_of(7) is None


def test_a_step_is_imagined_in_the_hand_or_at_its_place() -> None:
    view = TableView.of(look(([0.5, 0.2, 0.05], RED), ([0.6, -0.2, 0.05], BLUE)))
    taken = view.with_moved(0, None, holds=True)
    assert taken.held == 0 and taken.things.location[0, 2] > 0.1
    put = taken.with_moved(0, np.array([0.7, 0.0, 0.05]), holds=False)
    assert put.held is None
    assert np.allclose(put.things.location[0], [0.7, 0.0, 0.05])
    assert np.allclose(put.observation.location[:, 0], [0.7, 0.0, 0.05])
    assert np.allclose(put.things.location[1], view.things.location[1])
    assert np.allclose(view.things.location[0], [0.5, 0.2, 0.05]), "the first look is left as it was"


def test_nothing_is_felt_by_an_open_hand() -> None:
    view = TableView.of(look(([0.5, 0.2, 0.05], RED)))
    assert view.held is None and not view.feels
    closed = replace(
        look(([0.3, 0.3, 0.5], RED)), gripper_closed=np.ones(6, dtype=bool), gripper_opening=np.full(6, 0.04)
    )
    assert TableView.of(closed).held == 0


def test_the_colours_of_what_is_not_seen_any_more_are_told() -> None:
    before = TableView.of(look(([0.5, 0.2, 0.05], RED), ([0.6, -0.2, 0.05], BLUE)))
    now = TableView.of(look(([0.6, -0.2, 0.05], BLUE)), before)
    (lost,) = lost_colours(now)
    assert np.allclose(lost, [229.5, 25.5, 25.5])
    assert lost_colours(before).shape == (0, 3)


def test_what_the_hand_took_looks_and_is_called_as_before_however_little_of_it_is_seen() -> None:
    before = TableView.of(look(([0.5, 0.2, 0.05], RED), ([0.6, -0.2, 0.05], BLUE)))
    taken = Taken.of(before, 0)
    hand = {"gripper_closed": np.ones(6, dtype=bool), "gripper_opening": np.full(6, 0.04)}
    for now in (
        replace(look(([0.6, -0.2, 0.05], BLUE)), **hand),  # fingers hide all of it
        replace(look(([0.6, -0.2, 0.05], BLUE), ([0.3, 0.32, 0.48], BLUE)), **hand),  # a scrap of it in another colour
    ):
        found = as_taken(now, taken)
        assert found is not None
        view = TableView.of(found[0], before).numbered(found[1], taken.number)
        assert view.held == view.index_of(0) == found[1]
        assert np.allclose(view.observation.colour[:, found[1]], RED)
        assert np.allclose(view.things.location[found[1]], [0.3, 0.3, 0.5], atol=0.05)
        assert sorted(view.numbers) == [0, 1]


def test_an_open_hand_has_taken_nothing() -> None:
    view = TableView.of(look(([0.5, 0.2, 0.05], RED)))
    assert as_taken(look(([0.5, 0.2, 0.05], RED)), Taken.of(view, 0)) is None
