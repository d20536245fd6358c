"""New commands, suites and written sentences: what is made, and how it is judged."""

from pathlib import Path

import numpy as np
import pytest

from executor.errors import InputError
from executor.execution.answer import Answer
from executor.execution.evaluation.board_cases import board_cases, written_cases
from executor.execution.evaluation.case import Case, Expected, Suite
from executor.execution.evaluation.figures import causes_of, figures_of
from executor.execution.evaluation.suite_cases import SUITES, suite_cases
from executor.execution.evaluation.verdict import Job, Verdict, fault_of, run_case
from executor.report import ExecutionReport
from learning.grounding.ngrams import words_of
from teleop.referring import Board
from twin import World, random_board


def test_equal_seeds_make_equal_commands_and_none_that_was_heard() -> None:
    cases = board_cases(6, 3, 0.25)
    assert cases == board_cases(6, 3, 0.25)
    heard = {words_of(cases[0].sentence)}
    assert all(words_of(case.sentence) not in heard for case in board_cases(6, 3, 0.25, heard))


@pytest.mark.parametrize("suite", SUITES)
def test_a_suite_asks_what_should_be_answered(suite: Suite) -> None:
    cases = suite_cases(suite, 14, 4)
    assert len(cases) == 14
    assert {case.expected.answer for case in cases if case.expected} == {Answer(suite)}


def test_what_is_ambiguous_fits_two_clear_blocks() -> None:
    for case in suite_cases("ambiguous", 6, 9):
        board = Board(case.scene)
        colours = {block.colour for block in case.scene.objects if block.colour in case.sentence}
        assert any(
            sum(block.colour == colour and board.clear(block) for block in case.scene.objects) > 1
            for colour in colours
            if colour in case.sentence
        ) or any(word in case.sentence for word in ("cyan", "magenta"))


def test_written_commands_are_read(tmp_path: Path) -> None:
    path = tmp_path / "said.tsv"
    path.write_text("# scenes of mine\n7\ttake the red cube\t3\theld\n\n8\tput it there\t2\t1,2,0\n9\tfoo\tambiguous\n")
    first, second, third = written_cases(path)
    assert first.expected == Expected(object_id=3)
    assert second.expected == Expected(object_id=2, cell=(1, 2, 0))
    assert third.expected == Expected(answer=Answer.AMBIGUOUS)
    assert first.scene.objects == random_board(np.random.default_rng(7), seed=7).objects


def test_a_line_of_another_form_is_named(tmp_path: Path) -> None:
    path = tmp_path / "said.tsv"
    path.write_text("7\ttake it\n seven\ttake it\n")
    with pytest.raises(InputError, match=r"line 2: .* is not a seed, a sentence"):
        written_cases(path)


def test_an_arm_that_moved_is_wrong_where_it_should_have_asked() -> None:
    report = ExecutionReport("take it", Answer.AMBIGUOUS, "")
    asked = Expected(answer=Answer.AMBIGUOUS)
    with World.from_scene("board", seed=1) as world:
        state = world.state()
        assert fault_of(asked, report, state, state) == ""
        refused = ExecutionReport("take it", Answer.REFUSED, "")
        assert "answered refused, not ambiguous" in fault_of(asked, refused, state, state)
        assert "not in the gripper" in fault_of(Expected(object_id=0), report, state, state)


def test_a_command_that_is_not_done_is_judged_by_the_truth(knowledge_file: str) -> None:
    case = board_cases(1, 3, 0.0)[0]
    nonsense = Case(case.number, case.scene, "blubb", case.expected, case.kind)
    verdict = run_case(Job(nonsense, Path(knowledge_file), 0))
    assert verdict.right is False and not verdict.moved
    assert verdict.cause == "answered unknown-word"


def test_false_success_counts_what_was_reported_done_and_is_not() -> None:
    verdicts = [
        Verdict(0, "a", "take", Answer.DONE, True, "", "", True, "", {"to_motion": 0.1}),
        Verdict(1, "b", "take", Answer.DONE, False, "wrong", "motion (done)", True, "", {"to_motion": 0.3}),
        Verdict(2, "c", "take", Answer.REFUSED, False, "wrong", "answered refused", False, ""),
        Verdict(3, "d", "take", Answer.DONE, None, "", "", True, "", {"to_motion": 0.2}),
    ]
    figures = figures_of(verdicts)
    assert figures["success_rate"] == pytest.approx(1 / 3)
    assert figures["false_success"] == 1 and figures["unscored"] == 1
    assert figures["median_ms_to_motion"] == pytest.approx(200.0)
    assert causes_of(verdicts) == [("motion (done)", 1), ("answered refused", 1)]
