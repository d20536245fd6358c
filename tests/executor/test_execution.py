"""Answers, steps, undo, clearing, and a sound hand whatever happens: on boards of our own."""

import numpy as np
import pytest

from executor import Executor
from executor.errors import InputError
from executor.execution.answer import Answer, OnAmbiguous
from executor.execution.board_blocks import blocking
from executor.execution.board_doer import BoardDoer
from executor.execution.session import Session
from executor.execution.steps import marked_words
from executor.execution.understood import Referent, Understood
from executor.execution.unobstructed import Unobstructed
from executor.free_places import free_place
from executor.goal_runner import GoalRunner
from executor.outcome import agreed, judge
from executor.report import Outcome
from executor.sight import Sight
from learning import Goal, Knowledge
from learning.grammar.arrangement import Arrangement
from learning.grammar.innate import ABOVE
from learning.grammar.phrase_chart import Modifier
from learning.graphs import ActionGraphlet
from twin import ObjectSpec, SceneSpec, World, WorldState, board

HALF_CELL = board.CELL / 2
Cell = tuple[int, int, int]


def scene(*blocks: tuple[str, str, Cell]) -> SceneSpec:
    return SceneSpec(
        objects=tuple(
            ObjectSpec.model_validate(
                {"id": i, "shape": shape, "colour": colour, "position": tuple(board.cell_centre(*cell))}
            )
            for i, (colour, shape, cell) in enumerate(blocks)
        )
    )


PLAIN = scene(("red", "cube", (2, 2, 0)), ("blue", "cube", (5, 3, 0)), ("white", "prism", (4, 6, 0)))
TWINS = scene(("red", "cube", (2, 2, 0)), ("red", "cube", (5, 3, 0)), ("blue", "cube", (6, 6, 0)))


def place(state: WorldState, number: int) -> np.ndarray:
    return next(each.pose_object_in_world.position for each in state.objects if each.id == number)


def at(state: WorldState, number: int, cell: Cell) -> bool:
    return bool(np.linalg.norm(place(state, number) - board.cell_centre(*cell)) < HALF_CELL)


# Answers


def test_an_unknown_word_is_named_and_an_offer_made(knowledge: Knowledge) -> None:
    with World.from_scene(PLAIN) as world:
        report = Executor(world, knowledge).execute("put the turquoise cube on the blue cube")
        assert world.time == 0.0
    assert report.answer is Answer.UNKNOWN_WORD and report.refused
    assert report.unknown == ("turquoise",)
    assert report.reason == "I never heard “turquoise”; show me: record a demo and say it"


def test_two_things_that_fit_lead_to_a_question_that_can_be_answered(knowledge: Knowledge) -> None:
    with World.from_scene(TWINS) as world:
        executor = Executor(world, knowledge, np.random.default_rng(0))
        report = executor.execute("take the red cube")
        assert report.answer is Answer.AMBIGUOUS and world.time == 0.0
        assert {option.thing for option in report.options} == {0, 1}
        assert len({option.name for option in report.options}) == 2
        assert all("red cube" in option.name for option in report.options)
        chosen = executor.execute("take the red cube", choice=1)
        assert chosen.answer is Answer.DONE and world.state().held == 1


def test_the_best_is_taken_where_that_is_asked(knowledge: Knowledge) -> None:
    with World.from_scene(TWINS) as world:
        report = Executor(world, knowledge, on_ambiguous=OnAmbiguous.BEST).execute("take the red cube", plan_only=True)
    assert report.answer is Answer.PLANNED and report.plan is not None


def test_a_way_that_is_unknown_is_bad_input(knowledge: Knowledge) -> None:
    with World.from_scene(PLAIN) as world, pytest.raises(InputError, match="'guess', allowed: ask, best"):
        Executor(world, knowledge, on_ambiguous="guess")


def test_a_report_holds_tree_referents_and_plan(knowledge: Knowledge) -> None:
    with World.from_scene(PLAIN) as world:
        report = Executor(world, knowledge).execute("put the red cube on the blue cube", plan_only=True)
    plain = report.to_dict()
    assert plain["answer"] == "planned"
    assert report.tree is not None and report.tree.label == "event"
    assert str(plain["tree"]).startswith("{'label': 'event'")
    assert report.referents[0] == Referent("entity", "red cube", 3, 4, (0,))
    assert "entity “red cube”: object 0" in report.text()
    assert "close the gripper" in report.text()


# Outcomes


def looked(*places: tuple[float, float, float], ids: tuple[int, ...] = (0, 1)) -> Sight:
    return Sight(np.array(ids), np.array(places), np.array([0.2, 0.2, 0.4]), False, None)


def test_a_block_that_is_not_seen_any_more_is_uncertain_not_done() -> None:
    before = looked((0.1, 0.1, 0.019), (0.3, 0.3, 0.019))
    outcome = judge(0, np.array([0.2, 0.2, 0.019]), before, looked((0.3, 0.3, 0.019), ids=(1,)))
    assert outcome.doubt and not outcome.right


def test_a_block_at_the_edge_of_its_place_is_uncertain() -> None:
    before = looked((0.1, 0.1, 0.019), (0.3, 0.3, 0.019))
    outcome = judge(0, np.array([0.2, 0.2, 0.019]), before, looked((0.224, 0.2, 0.019), (0.3, 0.3, 0.019)))
    assert "cannot tell" in outcome.doubt


def test_two_looks_that_disagree_are_uncertain() -> None:
    right, wrong = Outcome(True, 0.001, (), "there"), Outcome(False, 0.1, (), "not there")
    assert agreed(right, right) == right
    assert "disagree" in agreed(right, wrong).doubt and not agreed(wrong, right).right


def test_what_is_in_the_hand_after_a_failure_is_put_down(actions: dict[str, ActionGraphlet]) -> None:
    with World.from_scene(PLAIN) as world:
        runner = GoalRunner(world, np.random.default_rng(1))
        runner.carry_out(Goal(0, None, actions["take"]), Sight.of(runner.look()))
        assert world.state().held == 0
        note = runner.come_to_rest(None, Sight.of(runner.look()))
        state = world.state()
    assert "put down" in note
    assert state.held is None and not state.gripper_closed
    assert place(state, 0)[2] == pytest.approx(board.BLOCK / 2, abs=0.003)  # it stands on the board


def test_a_hand_closed_on_nothing_is_opened(actions: dict[str, ActionGraphlet]) -> None:
    with World.from_scene(PLAIN.model_copy(update={"gripper_closed": True})) as world:
        runner = GoalRunner(world, np.random.default_rng(1))
        assert "open again" in runner.come_to_rest(None, Sight.of(runner.look()))
        assert not world.state().gripper_closed


# Steps and undo


def test_punctuation_is_remembered() -> None:
    words, marks = marked_words("Take it, then put it down.")
    assert words == ("take", "it", "then", "put", "it", "down")
    assert marks == {2}


def test_two_steps_are_done_one_after_the_other_and_undone_together(knowledge: Knowledge) -> None:
    with World.from_scene(PLAIN) as world:
        executor = Executor(world, knowledge, np.random.default_rng(0))
        before = world.state()
        report = executor.execute("put the red cube on the blue cube, then take the white prism")
        after = world.state()
        assert report.answer is Answer.DONE and len(report.steps) == 2
        assert at(after, 0, (5, 3, 1)) and after.held == 2
        assert executor.undo() == "put the red cube on the blue cube, then take the white prism"
        back = world.state()
        for old, new in zip(before.objects, back.objects, strict=True):
            np.testing.assert_array_equal(old.pose_object_in_world.position, new.pose_object_in_world.position)
        assert back.time == before.time and executor.undo() is None
        again = executor.execute("take the white prism")  # the arm goes on from there
        assert again.answer is Answer.DONE and world.state().held == 2


def test_nothing_moves_when_a_later_step_cannot_be_done(knowledge: Knowledge) -> None:
    with World.from_scene(PLAIN) as world:
        report = Executor(world, knowledge).execute("put the red cube on the blue cube, then take the green cube")
        assert world.time == 0.0
    assert report.refused


def test_a_dialogue_undoes_and_ends(knowledge: Knowledge) -> None:
    with World.from_scene(TWINS) as world:
        session = Session(Executor(world, knowledge, np.random.default_rng(0)))
        assert session.answer("undo") == "there is nothing to undo"
        assert session.answer("wrong") == "nothing was done that could be wrong"
        asked = session.answer("take the red cube")
        assert asked is not None and asked.startswith("ambiguous") and "  2. " in asked
        assert session.answer("3") == "there is no choice 3; say 1 to 2"
        assert str(session.answer("1")).startswith("done")
        assert session.answer("undo") == "undone: take the red cube"
        assert session.answer("quit") is None


# Clearing


BURIED = scene(("red", "cube", (2, 2, 0)), ("blue", "cube", (5, 3, 0)), ("green", "prism", (5, 3, 1)))


def test_what_is_in_the_way_is_found_from_the_top() -> None:
    tower = Arrangement((9, 9, 9, 20), (0, 1, 2, 0), (0, 1, 2, 3), (0, 0, 1, 0), None)
    elements, bearing = Unobstructed(tower), frozenset((0,))
    assert blocking(elements, tower, bearing, 0, None, None) == ((2, 1), None)
    on_the_lowest = Modifier(ABOVE, 1)
    assert blocking(elements, tower, bearing, 3, 9, on_the_lowest) == ((2, 1), 0)
    somewhere_there = None  # a corner, say: only the prism has to go
    assert blocking(elements, tower, bearing, 3, 9, somewhere_there) == ((2,), 1)
    assert blocking(elements, tower, bearing, 3, 30, None) == ((), None)


def test_a_block_is_put_aside_and_the_goal_reached(knowledge: Knowledge, actions: dict[str, ActionGraphlet]) -> None:
    goal = Goal(0, board.cell_centre(5, 3, 1), actions["move"])
    understood = Understood(("put",), Answer.IMPOSSIBLE, "the prism is in the way", goals=(goal,), blocked=(2,))
    with World.from_scene(BURIED) as world:
        doer = BoardDoer(world, knowledge, np.random.default_rng(0))
        report = doer.carry_out(understood, doer.look(), "put the red cube on the blue cube")
        state = world.state()
    assert report.answer is Answer.DONE and report.cleared == (2,)
    assert at(state, 0, (5, 3, 1)) and at(state, 1, (5, 3, 0))
    x, y, z = board.nearest_cell(place(state, 2))
    assert z == 0 and 0 <= x < 8 and 0 <= y < 8 and (x, y) not in {(2, 2), (5, 3)}


def test_a_free_place_is_near_and_not_where_it_would_block() -> None:
    sight = looked(tuple(board.cell_centre(3, 3, 0)), tuple(board.cell_centre(3, 4, 0)))
    found = free_place(sight, board.cell_centre(3, 3, 0), {(2, 3), (4, 3)})
    assert found is not None
    cell = board.nearest_cell(found)
    assert cell[2] == 0 and cell[:2] not in {(3, 3), (3, 4), (2, 3), (4, 3)}


def test_a_full_board_has_no_free_place() -> None:
    cells = [tuple(board.cell_centre(x, y, 0)) for x in range(8) for y in range(8)]
    assert free_place(looked(*cells, ids=tuple(range(64))), np.zeros(3), ()) is None
