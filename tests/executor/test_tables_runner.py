"""Goals at a table in physics: what slips is tried again, what is stopped is made sound, and undo keeps numbers."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import pytest

from executor.actions.player import ActionPlayer
from executor.actions.primitives import Carry
from executor.actions.things import clear_below, pose_of
from executor.execution.answer import Answer
from executor.report import ExecutionReport
from executor.tables.places import Spot
from executor.tables.table_doer import TableDoer
from executor.tables.table_understanding import TableUnderstood
from learning import Knowledge
from learning.graphs import ActionGraphlet
from learning.interpretation.interpretation import Goal
from learning.interpretation.table_interpreter import TableReading
from tests.executor.graphlets import MOVE, PICK_UP
from twin import JointCommand, ObjectSpec, SceneSpec, World
from twin.objects import object_model

CUBE, OTHER = 0, 1
"""Ids of the things."""
CUBE_AT, OTHER_AT, ELSEWHERE = (0.78, 0.22), (0.66, -0.02), (0.54, -0.22)
"""Where they stand, and a free place, so near to the camera that what is brought there looks larger [m]."""


class StoppedError(Exception):
    """Somebody presses stop."""


@dataclass
class Table:
    """A Baxter at a table with two things, and who carries out goals there."""

    world: World
    doer: TableDoer
    actions: dict[ActionGraphlet, int]

    def do(self, action: ActionGraphlet, thing: int, goal: tuple[float, float] | None = None) -> ExecutionReport:
        """Carry out a goal with a thing, as if a sentence had said so."""
        view = self.doer.look()
        where = pose_of(self.world.state(), thing).position
        index = int(np.argmin(np.linalg.norm(view.things.location - where, axis=1)))
        place = None if goal is None else np.array([*goal, where[2]])
        reading = TableReading((), None, self.actions[action], (index,), None, (), "")
        goals = (Goal(view.numbers[index], place, action),)
        spots = () if place is None else (Spot(place),)
        understood = TableUnderstood(("do",), None, "", goals=goals, reading=reading, spots=spots)
        return self.doer.carry_out(understood, view, "do")


@pytest.fixture
def table() -> Iterator[Table]:
    objects = tuple(
        ObjectSpec.of_model(number, name, (*at, float(object_model(name).half_extents[2])))
        for number, name, at in ((CUBE, "red_cube", CUBE_AT), (OTHER, "blue_cube", OTHER_AT))
    )
    known = Knowledge("table")
    actions = {graphlet: known.spaces.actions.match_or_add(graphlet) for graphlet in (MOVE, PICK_UP)}
    with World(SceneSpec(name="two things", kind="table", robot="baxter", objects=objects)) as world:
        doer = TableDoer(world, known, np.random.default_rng(0))
        yield Table(world, doer, actions)
        doer.close()


def on_first(kind: type, then: Callable[[], None]) -> Callable[[object], None]:
    """Does something when a step of a kind begins for the first time."""
    seen: list[object] = []

    def begun(step: object) -> None:
        if isinstance(step, kind) and not seen:
            seen.append(step)
            then()

    return begun


def forced_open(world: World) -> None:
    """Fingers are forced open for a moment: what they hold falls out of them."""
    still = JointCommand(np.zeros(len(world.robot.joint_names)), tuple(0.04 for _ in world.robot.arms))
    for _ in range(120):
        world.step(still)


def test_what_slips_out_of_the_hand_is_taken_once_more_and_brought_to_its_place(table: Table) -> None:
    table.doer.on_progress = on_first(Carry, lambda: forced_open(table.world))
    report = table.do(MOVE, CUBE, ELSEWHERE)
    assert report.answer is Answer.DONE, report.explanation
    assert report.attempts == 2
    assert "once more" in report.reason
    assert np.linalg.norm(pose_of(table.world.state(), CUBE).position[:2] - ELSEWHERE) < 0.02


def test_after_a_stop_on_the_way_what_is_held_is_set_down_before_the_next_goal(table: Table) -> None:
    world = table.world

    def stop() -> None:
        raise StoppedError

    def pressed() -> None:
        world.on_step = stop

    table.doer.on_progress = on_first(Carry, pressed)
    with pytest.raises(StoppedError):
        table.do(MOVE, CUBE, ELSEWHERE)
    world.on_step = None
    held = [arm.held for arm in world.state().arms]
    assert CUBE in held and clear_below(world, CUBE) > 0.03, "it was stopped in the air"
    table.doer.resume()

    fastest: list[float] = []
    last = [pose_of(world.state(), CUBE).position[2]]

    def watch() -> None:
        height = pose_of(world.state(), CUBE).position[2]
        fastest.append((last[0] - height) / world.DT)
        last[0] = height

    world.on_step = watch
    report = table.do(PICK_UP, OTHER)
    world.on_step = None
    assert report.answer is Answer.DONE, report.explanation
    assert "put down" in report.reason
    state = world.state()
    assert [arm.held for arm in state.arms if arm.gripper_closed] == [OTHER]
    assert clear_below(world, CUBE) < 0.004
    assert pose_of(state, CUBE).position[2] < 1.5 * object_model("red_cube").half_extents[2], "on nothing but the table"
    assert max(fastest) < 0.4, "what falls 3 cm is twice as fast as a hand that lowers"


def test_what_is_out_of_reach_is_refused_before_anything_moves(table: Table) -> None:
    before = table.world.state()
    report = table.do(MOVE, CUBE, (1.45, 0.0))
    after = table.world.state()
    assert report.answer is Answer.IMPOSSIBLE, report.explanation
    assert after.time == before.time
    assert np.array_equal(after.q, before.q)


def test_things_keep_their_numbers_when_the_world_is_put_back(table: Table) -> None:
    assert table.do(MOVE, CUBE, ELSEWHERE).answer is Answer.DONE
    view = table.doer.look()
    assert view.numbers != tuple(range(len(view.numbers))), "a new count would give the same numbers"
    moment = table.world.snapshot()
    for _ in range(10):
        table.world.step(JointCommand(np.zeros(len(table.world.robot.joint_names)), table.world.commanded_openings))
    table.doer.look()
    table.world.restore(moment)
    table.doer.resume()
    again = table.doer.look()
    for number in view.numbers:
        index, other = view.index_of(number), again.index_of(number)
        assert index is not None and other is not None
        assert np.linalg.norm(view.things.location[index] - again.things.location[other]) < 0.02


def test_a_base_rolls_to_where_the_arm_reaches_and_stays_where_it_never_would() -> None:
    can = float(object_model("small_red_can").half_extents[2])
    for at, rolls in (((0.60, 0.45), True), ((1.02, 0.0), False)):
        thing = ObjectSpec.of_model(CUBE, "small_red_can", (*at, can))
        spec = SceneSpec(name="far", kind="table", robot="mico_segway", objects=(thing,))
        with World(spec) as world:
            before, time = world.base_pose.position, world.time
            played = ActionPlayer(world, np.random.default_rng(0)).play(PICK_UP, CUBE)
            moved = float(np.linalg.norm(world.base_pose.position - before))
            assert played.success is rolls, played.reason
            assert (moved > 0.05) is rolls
            if rolls:
                assert world.state().held == CUBE and clear_below(world, CUBE) > 0.05
            else:
                assert world.time == time and played.reason.startswith("out of reach")
