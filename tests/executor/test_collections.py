"""Collections of demos: driven, judged by physics, recorded, replayed, gone on with."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from executor.cli import app
from executor.collections import (
    LEEDS_COUNT,
    ORDERING_COUNT,
    Attempt,
    LeedsCollection,
    OrderingCollection,
    make_demo,
)
from executor.collections.driven_grasps import moved
from executor.collections.rehearsal import Rehearsal
from executor.collections.rules import slipped_out
from executor.demo_summary import summarise
from teleop import check_replay, load_demo
from teleop.strokes import Reach
from teleop.truth import read_truth
from twin import World


def test_collections_have_the_thesis_sizes_and_show_everything_equally_often() -> None:
    ordering = OrderingCollection(Path("."), 0)
    shown = [ordering.shows(number) for number in range(ORDERING_COUNT)]
    assert ORDERING_COUNT == 1120
    assert {shown.count(each) for each in set(shown)} == {5}
    leeds = LeedsCollection(Path("."), 0)
    table = [leeds.shows(number) for number in range(LEEDS_COUNT)]
    assert LEEDS_COUNT == 204
    things = [thing for _, thing in table]
    assert {things.count(each) for each in set(things)} == {4}
    assert [sum(action == each for action, _ in table) for each in ("pick up", "put down", "move")] == [68, 68, 68]


def test_a_lift_starts_with_the_object_in_the_hand_replays_exactly_and_is_kept(tmp_path: Path) -> None:
    collection = OrderingCollection(tmp_path, 0, ("en", "ar"))
    made = make_demo(collection, 8)
    assert made.done
    assert not made.kept
    demo = load_demo(made.path)
    assert demo.prelude is not None
    assert demo.outcome is not None
    assert demo.outcome.outcome == "success"
    assert demo.states.held[0] == demo.states.held[-1] == 0
    assert demo.states.object_positions[-1, 0, 2] - demo.states.object_positions[0, 0, 2] > 0.05
    assert check_replay(demo).max_error == 0.0
    truth = read_truth(made.path)
    assert truth["action"] == "lift"
    assert truth["objects"]["0"]["name"] == collection.shows(8)[1]
    assert [len(demo.utterances_in(language)) for language in ("en", "ar")] == [1, 1]
    assert [each["text"] for each in truth["sentences"]] == list(demo.utterances)
    assert make_demo(collection, 8).kept
    summary = summarise([demo], "en")
    assert (summary.clips, summary.commands, summary.objects) == (1, 1, 1.0)


def test_failed_tries_are_counted_and_never_kept(tmp_path: Path) -> None:
    class Clumsy:
        name, folder, seed = "clumsy", tmp_path, 0

        def attempt(self, number: int, attempt: int, path: Path) -> Attempt:
            if attempt == 1:
                return Attempt("lift", "out of reach")
            if attempt < 4:
                return Attempt("lift", "dropped", simulated=2.0)
            path.write_bytes(b"demo")
            return Attempt("lift", "", {"action": "lift"}, 2.0)

    made = make_demo(Clumsy(), 3)
    assert (made.failures, made.drawn, made.done) == (("dropped", "dropped"), 4, True)
    assert read_truth(made.path)["failed_tries"] == ["dropped", "dropped"]
    assert sorted(each.name for each in tmp_path.iterdir()) == ["clumsy_0_0003.mcap", "clumsy_0_0003.truth.json"]


def test_what_falls_out_of_the_closed_hand_has_slipped_and_what_flickers_has_not() -> None:
    closed = np.array([True] * 8 + [False] * 4)
    carried = np.array([True] * 8 + [False] * 4)
    assert not slipped_out(carried, closed)
    flickering = carried & (np.arange(12) != 7)
    assert not slipped_out(flickering, closed)
    fallen = carried & (np.arange(12) < 4)
    assert slipped_out(fallen, closed)
    assert not slipped_out(np.zeros(12, dtype=bool), closed)


def test_a_rehearsal_says_why_a_way_cannot_be_driven() -> None:
    with World.from_scene("ordering", seed=2) as world:
        rehearsal = Rehearsal(world, "arm")
        here = rehearsal.arm.forward_kinematics(rehearsal.q)
        near = rehearsal.along(rehearsal.q, (Reach(moved(here, np.array([0.03, 0.0, 0.02])), 0.1),))
        assert near.reason == ""
        there = rehearsal.arm.forward_kinematics(near.q).position
        assert there == pytest.approx(here.position + [0.03, 0.0, 0.02], abs=0.002)  # `OFF`, where a line counts
        far = rehearsal.along(rehearsal.q, (Reach(moved(here, np.array([0.8, 0.0, 0.0])), 0.1),))
        assert far.reason.startswith("out of reach")
        into = rehearsal.along(rehearsal.q, (Reach(moved(here, np.array([0.0, 0.0, -0.5])), 0.1),))
        assert re.match("no room|out of reach", into.reason)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--languages", "fr"], "--languages 'fr': give one or several of en, ar"),
        (["--count", "205"], "leeds has 204 demos, got --count 205"),
        (["--robot", "mico_segway"], "leeds is recorded with its own robot"),
    ],
)
def test_what_a_collection_cannot_do_is_refused(tmp_path: Path, options: list[str], message: str) -> None:
    result = CliRunner().invoke(app, ["record", "--collection", "leeds", "-o", str(tmp_path), *options])
    assert result.exit_code == 2
    assert message in result.output


def test_the_same_numbers_give_the_same_sentences_in_other_languages_too() -> None:
    one = LeedsCollection(Path("."), 0, ("en",))
    assert replace(one, languages=("en", "ar")).shows(7) == one.shows(7)
