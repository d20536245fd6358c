import json
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from learning.concept_id import Concept
from learning.errors import LearningError
from learning.evaluation import TrainRobotsReport, cross_validate, examine, make_folds
from learning.evaluation.answers import Answer
from learning.evaluation.baselines import Outcome, baseline_credits, possible_outcomes
from learning.evaluation.board_exam import board_exam
from learning.evaluation.command_score import fault
from learning.evaluation.concept_names import ConceptTally, true_distance, true_place, true_relation
from learning.grammar.rcl import RclNode
from learning.percept import NO_CONCEPT, Percept
from learning.train_robots import Block, Command, Layout, Release, Scene
from robots.pose import FloatArray
from twin.board import cell_centre

COLOURS = ("blue", "cyan", "red", "yellow", "green", "magenta", "gray", "white")
SHAPES = ("cube", "prism")
KINDS = ("move", "take", "drop")


@dataclass(frozen=True)
class ToldGoal:
    object_id: int
    position: FloatArray | None


@dataclass(frozen=True)
class Told:
    goals: tuple[ToldGoal, ...]
    tree: RclNode | None
    explanation: str
    understood: bool


@dataclass
class Crammer:
    """A student that was told the truth of each scene; it knows only commands up to `knows`."""

    scenes: dict[int, Scene]
    knows: int
    asked: int = 0

    def percept(self, scene: Scene) -> Percept:
        self.asked = scene.number
        blocks = scene.before.blocks
        n = len(blocks)
        near = np.full((n, n), NO_CONCEPT)
        for i, thing in enumerate(blocks):
            for j, ground in enumerate(blocks):
                if true_relation(thing.cell, ground.cell) == "above":
                    near[i, j] = 0
        return Percept(
            object_ids=np.arange(n),
            location=np.array([cell_centre(*b.cell) for b in blocks]),
            properties={
                "colour": np.array([COLOURS.index(b.colour) for b in blocks]),
                "shape": np.array([SHAPES.index(b.shape) for b in blocks]),
                "location": np.zeros(n, dtype=np.int64),
            },
            relations={"direction": near},
            placements=np.empty((0, 3)),
            placement_properties={"location": np.empty(0, dtype=np.int64)},
            placement_relations={"direction": np.empty((0, n), dtype=np.int64)},
            support=np.empty(0, dtype=np.int64),
            clear=np.ones(n, dtype=bool),
            held=scene.before.held,
        )

    def shown_action(self, scene: Scene) -> int | None:
        return KINDS.index(scene.move.kind) if scene.move else None

    def interpret(self, sentence: str, _percept: Percept) -> Told:
        scene = self.scenes[self.asked]
        if scene.number > self.knows or scene.move is None:
            return Told((), None, f"no reading of '{sentence}'", understood=False)
        words = sentence.split()
        tree = RclNode(
            "event",
            None,
            1,
            len(words),
            (
                RclNode("action", Concept("action", KINDS.index("take")), 1, 2 if words[1] == "up" else 1),
                RclNode("entity", None, 1, 1, self._entity(scene, len(words))),
            ),
        )
        goal = None if scene.move.held_at_end else cell_centre(*scene.move.goal)
        return Told((ToldGoal(scene.move.object_id, goal),), tree, "as told", understood=True)

    def _entity(self, scene: Scene, last: int) -> tuple[RclNode, ...]:
        assert scene.move is not None
        block = scene.before.blocks[scene.move.object_id]
        return (
            RclNode("colour", Concept("colour", COLOURS.index(block.colour)), last - 1, last - 1),
            RclNode("shape", Concept("shape", SHAPES.index(block.shape)), last, last),
        )


def cram(all_scenes: dict[int, Scene], knows: int, _scenes: Sequence[Scene], _commands: Sequence[Command]) -> Crammer:
    """What the examination calls to learn (top level, so that it can go to another process)."""
    return Crammer(all_scenes, knows)


@pytest.fixture(scope="module")
def release(synthetic_release_directory: Path) -> Release:
    return Release.load(synthetic_release_directory)


@pytest.fixture(scope="module")
def report(release: Release) -> TrainRobotsReport:
    return cross_validate(release, partial(cram, release.scenes, 24), folds=3, seed=5)


def test_folds_by_group_share_no_layout(release: Release) -> None:
    folds = make_folds(release, 4, "groups", np.random.default_rng(0))
    assert sorted(c.id for fold in folds for c in fold.asked) == sorted(c.id for c in release.commands)
    for fold in folds:
        assert {release.scenes[c.scene].group % 4 for c in fold.asked} == {fold.number}
        assert all(scene.group % 4 != fold.number for scene in fold.scenes)
        assert all(release.scenes[c.scene].group % 4 != fold.number for c in fold.learned)


def test_folds_by_command_ask_each_command_once(release: Release) -> None:
    folds = make_folds(release, 4, "commands", np.random.default_rng(0))
    assert sorted(c.id for fold in folds for c in fold.asked) == sorted(c.id for c in release.commands)
    assert {len(fold.asked) for fold in folds} == {24}
    for fold in folds:
        assert not {c.id for c in fold.learned} & {c.id for c in fold.asked}


@pytest.mark.parametrize("count", [1, 7])
def test_impossible_folds_are_refused(release: Release, count: int) -> None:
    with pytest.raises(LearningError, match=rf"{count} folds by groups are not possible here; choose 2\.\.6"):
        make_folds(release, count, "groups", np.random.default_rng(0))


def test_a_crammer_is_right_where_it_was_told(report: TrainRobotsReport) -> None:
    figures = report.figures()
    assert figures["commands"] == 96
    assert figures["execution_accuracy"] == 0.5
    assert figures["understood"] == 0.5
    assert figures["vocabulary.ceiling"] == 1.0
    assert figures["vocabulary.execution_accuracy"] == 0.5
    # Its trees are right for lone takes alone: 3 of the first 24 scenes, two commands each.
    assert figures["rcl_exact"] == pytest.approx(6 / 96)
    assert figures["kind.single_take.commands"] == 12
    assert figures["kind.single_take.execution_accuracy"] == 0.5
    assert 6 / 96 < (figures["subtree_score"] or 0) < 0.5
    failures = report.failures()
    assert len(failures) == 48
    assert {failure["scene"] for failure in failures} == set(range(25, 49))
    assert str(failures[0]["reason"]).startswith("not understood: no reading of")


def test_the_report_is_json_with_the_names_of_the_design(report: TrainRobotsReport) -> None:
    data = json.loads(json.dumps(report.to_json()))
    assert {"figures", "baselines", "machine", "seed", "failures"} <= set(data)
    assert {"commands", "execution_accuracy", "rcl_exact", "subtree_score"} <= set(data["figures"])
    assert set(data["baselines"]) == {
        f"{name}.execution_accuracy" for name in ("random_move", "majority_move", "word_template")
    }
    assert 0 < data["baselines"]["random_move.execution_accuracy"] < 0.1
    assert data["seed"] == 5


def test_without_annotations_the_tree_scores_are_null(tmp_path: Path, synthetic_release_directory: Path) -> None:
    for name in ("commands.txt", "configuration.txt"):
        shutil.copy(synthetic_release_directory / name, tmp_path)
    release = Release.load(tmp_path)
    figures = examine(release, Crammer(release.scenes, 24)).figures()
    assert figures["execution_accuracy"] == 0.5
    assert figures["rcl_exact"] is None
    assert figures["subtree_score"] is None
    assert figures["vocabulary.ceiling"] is None


def test_several_processes_give_the_same_report(release: Release, report: TrainRobotsReport) -> None:
    again = cross_validate(release, partial(cram, release.scenes, 24), folds=3, seed=5, jobs=2)
    assert again.figures() == report.figures()
    assert again.failures() == report.failures()


def test_words_and_trees_are_scored_alike_in_one_process_or_many(release: Release) -> None:
    alone, many = (
        board_exam(release, partial(cram, release.scenes, 24), folds=2, seed=5, jobs=jobs) for jobs in (1, 2)
    )
    assert alone.figures() == many.figures()
    assert alone.failures() == many.failures()
    told_all = board_exam(release, partial(cram, release.scenes, 48), folds=2, seed=5).figures()
    less, more = alone.figures()["subtree_score"], told_all["subtree_score"]
    assert less is not None and more is not None and 0 < less < more
    assert alone.baselines() == many.baselines()


BEFORE = Layout(
    1, 1, (0, 0, 5), False, (Block((1, 1, 0), "red", "cube"), Block((2, 2, 0), "blue", "cube"))
)  # fmt: skip
MOVED = Layout(1, 2, (0, 0, 5), False, (Block((2, 2, 1), "red", "cube"), Block((2, 2, 0), "blue", "cube")))
LIFTED = Layout(1, 5, (1, 1, 6), True, (Block((1, 1, 6), "red", "cube"), Block((2, 2, 0), "blue", "cube")))
COMMAND = Command(1, 1, "go")


@pytest.mark.parametrize(
    ("scene", "objects", "cell", "reason"),
    [
        (Scene(1, BEFORE, MOVED), {0}, (2, 2, 1), ""),
        (Scene(1, BEFORE, MOVED), {0}, (2, 2, 0), r"puts the block in cell (2, 2, 0) instead of (2, 2, 1)"),
        (Scene(1, BEFORE, MOVED), {1}, (2, 2, 1), "moves the blue cube in cell (2, 2, 0) instead of the red cube"),
        (Scene(1, BEFORE, MOVED), {0, 1}, (2, 2, 1), "moves the red cube in cell (1, 1, 0), the blue cube in cell"),
        (Scene(1, BEFORE, MOVED), {0}, None, "keeps the block instead of putting it in cell (2, 2, 1)"),
        (Scene(1, BEFORE, LIFTED), {0}, None, ""),
        (Scene(1, BEFORE, LIFTED), {0}, (1, 1, 0), "puts the block in cell (1, 1, 0) instead of keeping it"),
        (Scene(1, LIFTED, BEFORE), {0}, (1, 1, 0), ""),
        (Scene(1, BEFORE, BEFORE), {0}, (1, 1, 0), "scene 1 does not move exactly one block"),
    ],
)
def test_faults_are_told(scene: Scene, objects: set[int], cell: tuple[int, int, int] | None, reason: str) -> None:
    position = None if cell is None else cell_centre(*cell) + [0.01, -0.01, 0.01]  # a reading's place is noisy
    answer = Answer(COMMAND, frozenset(objects), position, None, understood=True, explanation="")
    told = fault(answer, scene)
    assert told.startswith(reason) if reason else told == ""


def test_possible_outcomes_obey_physics() -> None:
    prism = Layout(1, 1, (0, 0, 5), False, (Block((1, 1, 0), "red", "cube"), Block((2, 2, 0), "blue", "prism")))
    outcomes = possible_outcomes(prism)
    assert len(outcomes) == 2 + 62 + 63  # two takes; not onto itself, and nothing onto the prism
    assert Outcome(0, (2, 2, 1)) not in outcomes
    assert Outcome(1, (1, 1, 1)) in outcomes
    held = possible_outcomes(LIFTED)
    assert len(held) == 64
    assert Outcome(0, (2, 2, 1)) in held
    buried = possible_outcomes(MOVED)
    assert all(outcome.block == 0 for outcome in buried)


def test_the_word_baseline_learns_an_unambiguous_language(release: Release) -> None:
    credit = baseline_credits(release.scenes, release.commands, release.commands)
    mean = {name: sum(values) / len(values) for name, values in credit.items()}
    assert mean["word_template"] > 0.5 > mean["majority_move"] > mean["random_move"]
    assert list(baseline_credits(release.scenes, (), release.commands)) == ["random_move"]


@pytest.mark.parametrize(
    ("thing", "relation"),
    [
        ((3, 3, 2), "above"),
        ((3, 3, 0), "below"),
        ((5, 3, 1), "front"),
        ((1, 3, 4), "backward"),
        ((3, 6, 1), "left"),
        ((3, 0, 1), "right"),
        ((5, 5, 1), "front left"),
        ((1, 1, 1), "backward right"),
    ],
)
def test_true_relations(thing: tuple[int, int, int], relation: str) -> None:
    assert true_relation(thing, (3, 3, 1)) == relation


def test_true_distances() -> None:
    cells = ((3, 3, 4), (2, 4, 0), (3, 6, 1))
    assert [true_distance(cell, (3, 3, 1)) for cell in cells] == ["same column", "adjacent", "3 cells"]


def test_true_places() -> None:
    cells = ((7, 7, 0), (0, 0, 3), (7, 3, 0), (4, 0, 0), (4, 4, 0))
    assert [true_place(cell) for cell in cells] == [
        "front left corner",
        "back right corner",
        "front edge",
        "right edge",
        "inner",
    ]


def test_concepts_are_named_by_what_they_most_often_are(release: Release) -> None:
    student = Crammer(release.scenes, 0)
    tally = ConceptTally()
    for scene in release.scenes.values():
        tally.add(student.percept(scene), student.shown_action(scene), scene)
    names = tally.names()
    assert [names[Concept("colour", i)] for i in range(8)] == list(COLOURS)
    assert [names[Concept("shape", i)] for i in range(2)] == list(SHAPES)
    assert [names[Concept("action", i)] for i in range(3)] == list(KINDS)
    assert names[Concept("direction", 0)] == "above"
