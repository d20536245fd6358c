"""What is in the way at a table: told where nobody wants it cleared, put aside where somebody does."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

import numpy as np
import pytest

from executor.actions.obstruction import around_grasps
from executor.actions.things import pose_of
from executor.execution.answer import Answer
from executor.report import ExecutionReport
from executor.tables.clearing import covering, in_the_way, places_aside
from executor.tables.places import TableThings
from executor.tables.table_doer import TableDoer
from executor.tables.table_understanding import TableUnderstood
from learning import Knowledge
from learning.graphs import ActionGraphlet
from learning.grounding.table_scene import OVER, SIDE_PLACES
from learning.interpretation.interpretation import Goal
from learning.interpretation.table_interpreter import TableGoal, TableReading
from tests.executor.graphlets import APART, GRIP, MOVE, PICK_UP, TOUCH
from twin import ObjectSpec, SceneSpec, World
from twin.objects import object_model

FAR, _, LEFT, _ = SIDE_PLACES
TAKE, LET_GO = ActionGraphlet((APART, TOUCH, GRIP)), ActionGraphlet((GRIP, TOUCH, APART))
CUBE, BOWL, LOW = [0.035, 0.035, 0.034], [0.1, 0.09, 0.046], [0.035, 0.034, 0.022]
"""Length, width and height of things as they are seen [m]."""


def knowing(actions: Iterable[ActionGraphlet], rows: Iterable[float], aside: float, height: float) -> Knowledge:
    """Knowledge of some actions and of where things rest [m], without a word."""
    knowledge = Knowledge("table")
    for graphlet in actions:
        knowledge.spaces.actions.match_or_add(graphlet)
    for x in rows:
        for y in (-aside, 0.0, aside):
            knowledge.table_language.resting.add(np.array([x, y, height]))
    return knowledge


def known() -> Knowledge:
    """Knowledge of Baxter's table, and of two actions."""
    return knowing((MOVE, PICK_UP), (0.53, 0.77), 0.25, 0.02)


def at_a_counter() -> Knowledge:
    """The same where nothing was ever shown that brings a thing elsewhere: one is taken, and let go of."""
    return knowing((TAKE, LET_GO), (0.45, 0.60), 0.15, 0.05)


def things(*seen: tuple[list[float], list[float]]) -> TableThings:
    return TableThings(np.array([place for place, _ in seen]), np.array([extent for _, extent in seen]))


def test_what_lies_on_a_thing_covers_it_the_uppermost_first_and_what_is_below_or_beside_does_not() -> None:
    low, middle, top = [0.6, 0.2, 0.011], [0.602, 0.199, 0.039], [0.6, 0.202, 0.072]
    pile = things((low, LOW), (middle, CUBE), (top, CUBE), ([0.6, 0.25, 0.017], CUBE))
    assert covering(0, pile, known()) == (2, 1)
    assert covering(1, pile, known()) == (2,)
    assert covering(2, pile, known()) == ()
    assert covering(0, pile, known(), held=2) == (1,)


def test_what_lies_in_a_bowl_covers_it() -> None:
    table = things(([0.62, 0.15, 0.023], BOWL), ([0.618, 0.139, 0.019], CUBE), ([0.62, 0.24, 0.017], CUBE))
    assert covering(0, table, known()) == (1,)
    assert covering(1, table, known()) == ()


def test_where_a_part_of_the_table_is_full_the_fewest_things_are_named_and_all_that_lies_on_them() -> None:
    crowd = [([x, y, 0.023], BOWL) for x in (0.72, 0.84) for y in (0.12, 0.25, 0.38)]
    table = things(([0.5, -0.2, 0.017], CUBE), *crowd, ([0.84, 0.37, 0.06], CUBE))
    goal = TableGoal(frozenset({FAR, LEFT}), ())
    found = in_the_way(goal, 0, table, known())
    assert found is not None
    away, spots = found
    assert len(away) == 1 and away[0] in range(1, 6)  # the bowl with the cube in it would be two
    assert all({FAR, LEFT} <= known().table_language.resting.at(spot.position) for spot in spots)


def test_a_thing_on_which_another_lies_has_no_room_and_that_other_one_is_in_the_way() -> None:
    table = things(([0.6, -0.2, 0.017], CUBE), ([0.6, 0.2, 0.017], CUBE), ([0.601, 0.2, 0.05], CUBE))
    found = in_the_way(TableGoal(frozenset({OVER}), (1,)), 0, table, known())
    assert found is not None
    away, (spot,) = found
    assert away == (2,)
    assert spot.onto == 1 and spot.position[2] == pytest.approx(0.051, abs=0.001)


def test_what_is_put_aside_is_out_of_the_way_of_what_comes_there() -> None:
    table = things(([0.6, -0.2, 0.017], CUBE), ([0.75, 0.25, 0.023], BOWL))
    found = in_the_way(TableGoal(frozenset({FAR, LEFT}), ()), 0, table, known())
    kept = None if found is None else found[1][0]
    for spot in places_aside(1, 0, kept, table, known())[:10]:
        assert np.linalg.norm(spot.position[:2] - [0.6, -0.2]) > 0.07 + 0.025


@contextmanager
def doing(
    *models: tuple[str, float, float, float], clear: bool, robot: str = "baxter"
) -> Iterator[tuple[World, TableDoer, Knowledge]]:
    """A robot at a table with things that stand at x and y [m], in such a height."""
    knowledge = known() if robot == "baxter" else at_a_counter()
    objects = tuple(
        ObjectSpec.of_model(number, name, (x, y, float(object_model(name).half_extents[2]) + above))
        for number, (name, x, y, above) in enumerate(models)
    )
    with World(SceneSpec(name="crowd", kind="table", robot=robot, objects=objects)) as world:
        doer = TableDoer(world, knowledge, np.random.default_rng(0), clear=clear)
        yield world, doer, knowledge
        doer.close()


def taken(
    world: World, doer: TableDoer, knowledge: Knowledge, thing: int, action: ActionGraphlet = PICK_UP
) -> ExecutionReport:
    """Pick up a thing, as if a sentence had said so."""
    view = doer.look()
    where = pose_of(world.state(), thing).position
    index = int(np.argmin(np.linalg.norm(view.things.location - where, axis=1)))
    reading = TableReading(("take",), None, knowledge.spaces.actions.match_or_add(action), (index,), None, (), "")
    goals = (Goal(view.numbers[index], None, action),)
    return doer.carry_out(TableUnderstood(("take",), None, "", goals=goals, reading=reading), view, "take")


BETWEEN = (("red_marker", 0.65, 0.10, 0.0), ("black_stapler", 0.65, 0.136, 0.0), ("gray_stapler", 0.65, 0.065, 0.0))
"""A marker between two staplers, where no hand comes around it."""


def test_what_keeps_the_hand_from_a_thing_is_named_and_nothing_moves() -> None:
    with doing(*BETWEEN, clear=False) as (world, doer, knowledge):
        before = world.state()
        assert set(around_grasps(world, 0, np.random.default_rng(0))) == {1, 2}
        assert around_grasps(world, 1, np.random.default_rng(0)) == ()
        report = taken(world, doer, knowledge, 0)
        after = world.state()
    assert report.answer is Answer.IMPOSSIBLE, report.explanation
    assert "in the way" in report.reason
    assert after.time == before.time


def test_what_keeps_the_hand_from_a_thing_is_put_aside_and_the_thing_taken() -> None:
    with doing(*BETWEEN, clear=True) as (world, doer, knowledge):
        before = {each.id: each.pose_object_in_world.position for each in world.state().objects}
        report = taken(world, doer, knowledge, 0)
        after = world.state()
        moved = {
            each.id
            for each in after.objects
            if np.linalg.norm(each.pose_object_in_world.position - before[each.id]) > 0.03
        }
    assert report.answer is Answer.DONE, report.explanation
    assert 0 in [arm.held for arm in after.arms]
    assert len(report.cleared) == len(moved) - 1 > 0


AMONG = (
    ("small_red_can", 0.52, 0.0, 0.0),
    ("large_yellow_can", 0.52, 0.0795, 0.0),
    ("large_blue_can", 0.52, -0.0795, 0.0),
    ("large_black_can", 0.4405, 0.0, 0.0),
)
"""A can among three larger ones, 2 cm apart: the Mico's hand does not come around it."""


def test_the_base_stays_where_other_things_are_in_the_way() -> None:
    with doing(*AMONG, clear=False, robot="mico_segway") as (world, doer, knowledge):
        report = taken(world, doer, knowledge, 0, TAKE)
        assert world.time == 0.0
    assert report.answer is Answer.IMPOSSIBLE
    assert "no room" in report.reason and "in the way" in report.reason


def test_what_takes_and_what_lets_go_make_up_an_action_that_puts_aside() -> None:
    with doing(*AMONG, clear=True, robot="mico_segway") as (world, doer, knowledge):
        report = taken(world, doer, knowledge, 0, TAKE)
        after = world.state()
    assert report.answer is Answer.DONE, report.explanation
    assert [arm.held for arm in after.arms] == [0]
    assert report.cleared
