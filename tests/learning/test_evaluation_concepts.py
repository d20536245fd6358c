import json
from pathlib import Path

import numpy as np
import pytest

from learning.concepts import BOARD, TABLE
from learning.errors import LearningError
from learning.evaluation.concepts import ScoredDemo, evaluate_concepts
from learning.evaluation.concepts_board import extended_scenes, scored_scenes
from learning.evaluation.concepts_demos import matched
from learning.evaluation.concepts_memory import MemoryPoint, plot_memory
from learning.evaluation.concepts_metrics import cluster_scores
from learning.evaluation.concepts_pure import best_mixture
from learning.evaluation.concepts_svm import svm_predictions
from learning.evaluation.concepts_thesis import THESIS
from learning.evaluation.concepts_truth import (
    BOARD_RULES,
    TABLE_RULES,
    TrueDemo,
    band_of,
    board_side,
    corner_of,
    kind_of_place,
    nearest_side,
    part_of_table,
    side_of,
)
from learning.train_robots import Release
from learning.train_robots.synthetic import write_synthetic_release
from tests.learning.board_demos import random_demo
from tests.learning.camera_tracks import still_objects
from twin.board import BLOCK, CELL, cell_centre


def test_scores_are_the_textbooks() -> None:
    scores = cluster_scores(["a", "a", "b", "b"], [0, 0, 1, 2])
    assert scores is not None
    assert scores.homogeneity == pytest.approx(1.0)
    assert scores.completeness == pytest.approx(2.0 / 3.0)  # H(class) = ln 2, H(cluster) = 1.5 ln 2
    assert scores.v_measure == pytest.approx(0.8)
    assert scores.mutual_information == pytest.approx(np.log(2.0))
    assert scores.normalised == pytest.approx(0.8)
    assert cluster_scores([], []) is None


@pytest.mark.parametrize(
    ("offset", "side"),
    [
        ((0.1, 0.0, 0.0), "front"),
        ((-0.1, 0.02, 0.0), "back"),
        ((0.0, 0.1, 0.05), "left"),
        ((0.0, -0.1, 0.0), "right"),
        ((0.01, 0.0, 0.05), "above"),
        ((0.01, 0.0, -0.05), None),
        ((0.1, 0.1, 0.0), None),
    ],
)
def test_a_direction_has_one_of_five_classes_or_none(offset: tuple[float, ...], side: str | None) -> None:
    assert side_of(np.array(offset)) == side


def test_blocks_have_a_direction_where_their_cells_share_a_face() -> None:
    assert board_side(np.array([CELL, 0.0, 0.0])) == "front"
    assert board_side(np.array([0.0, 0.0, BLOCK])) == "above"
    assert board_side(np.array([CELL, 0.0, BLOCK])) is None
    assert nearest_side(np.array([CELL, CELL, -BLOCK])) in ("front", "left")
    assert nearest_side(np.array([0.0, 0.0, -BLOCK])) == "below"


def test_places_have_classes() -> None:
    assert corner_of(cell_centre(0, 7, 2)) == "back left corner"
    assert corner_of(cell_centre(0, 6, 0)) is None
    kinds = {kind_of_place(cell_centre(x, y, 0)) for x in range(8) for y in range(8)}
    assert kinds == {"corner", "edge", "centre", "elsewhere"}
    assert part_of_table(np.array([0.8, 0.3, 0.02])) == "far left"
    assert part_of_table(np.full(3, np.nan)) is None
    assert [band_of(d) for d in (0.0, 0.1, 0.25, 0.4, 0.5, 0.6)] == [
        "touching",
        "close",
        "near",
        "apart",
        "distant",
        "far",
    ]


def test_tracks_are_matched_to_the_nearest_object_and_clutter_to_none() -> None:
    true = np.array([[0.5, 0.0, 0.0], [0.6, 0.1, 0.0]])
    seen = np.array([[0.61, 0.1, 0.0], [0.9, 0.9, 0.0], [0.5, 0.01, 0.0]])
    assert matched(seen, true) == [1, None, 0]
    assert matched(np.zeros((0, 3)), true) == []


def test_the_svm_never_asks_about_a_group_that_it_learned_from() -> None:
    rng = np.random.default_rng(0)
    classes = np.array(["a", "b"] * 20)
    groups = np.arange(40) // 2
    apart = np.where(classes == "a", -1.0, 1.0)[:, None] + rng.normal(0.0, 0.1, (40, 1))
    answers = svm_predictions(apart, classes, groups)
    assert answers is not None
    assert all(np.array_equal(answer, classes) for answer in answers)
    # A value that only tells the group helps not at all: folds do not share groups.
    own = np.eye(20)[groups]
    blind = svm_predictions(own, classes, groups)
    assert blind is not None
    assert all(np.mean(answer == classes) <= 0.5 for answer in blind)
    assert svm_predictions(apart, classes, groups % 3) is None


def test_pure_igmm_takes_the_number_of_components_from_bic() -> None:
    rng = np.random.default_rng(0)
    points = np.concatenate([rng.normal(mean, 0.02, (40, 2)) for mean in (0.0, 0.5, 1.0)])
    assert len(best_mixture(points, TABLE.space("location"))) == 3
    assert best_mixture(points[:1], TABLE.space("location")) == ()


def board(number: int, seed: int = 0) -> list[ScoredDemo]:
    rng = np.random.default_rng(seed)
    demos = []
    for index in range(number):
        demo = random_demo(rng, ("move", "take", "drop")[index % 3])
        first = np.array([cell_centre(*cell) for cell in demo.cells])
        last = first.copy()
        last[demo.moved] = cell_centre(*demo.goal)
        properties = {
            "colour": tuple(thing.colour for thing in demo.objects),
            "shape": tuple(thing.shape for thing in demo.objects),
        }
        truth = TrueDemo(properties, first, last, ("move", "take", "drop")[index % 3])
        demos.append(ScoredDemo(demo.observation, truth, ("take the red cube",), group=index))
    return demos


def test_a_board_is_learned_and_scored(tmp_path: Path) -> None:
    done: list[int] = []
    demos = board(15)
    report = evaluate_concepts(
        demos, len(demos), BOARD, BOARD_RULES, robot="three_dof", labels=4, on_demo=lambda: done.append(1)
    )
    assert len(done) == 15
    figures, baselines = report.figures(), report.baselines()
    for space in ("colour", "shape", "direction", "action"):
        assert figures[f"v_measure.{space}"] == pytest.approx(1.0, abs=0.03)  # a light may mix one colour's edge
        assert baselines[f"svm.{space}"] is not None
        assert baselines[f"thesis.{space}"] == THESIS["three_dof"].rows[space].v_measure
    assert figures["concepts.shape"] == figures["true_concepts.shape"] == 2
    assert figures["concepts.direction"] == figures["true_concepts.direction"] == 5
    assert (baselines["pure_igmm_concepts.colour"] or 0) >= (figures["known_concepts.colour"] or 0)
    assert figures["v_measure.location_all"] is not None
    assert report.summary.clips == 15
    assert report.summary.words == 4
    assert [point.demos for point in report.memory] == list(range(1, 16))
    assert figures["bytes"] == sum(report.memory[-1].parts.values())
    json.dumps(report.to_json())
    plot_memory([*report.memory, MemoryPoint(16, report.memory[-1].parts, 10**6)], tmp_path / "memory.png")
    assert (tmp_path / "memory.png").stat().st_size > 10_000  # a picture, not an empty page


def test_camera_tracks_are_scored_too() -> None:
    rng = np.random.default_rng(0)
    looks = {"red": (0.0, 0.8, 0.4), "green": (0.33, 0.7, 0.35), "white": (0.1, 0.02, 0.9)}
    demos = []
    for index in range(12):
        places = [(0.53, 0.25), (0.77, 0.0), (0.53, -0.25)]
        names = [str(name) for name in rng.permutation(list(looks))]
        observation = still_objects(rng, [looks[name] for name in names], places)
        where = observation.location.mean(axis=0)
        truth = TrueDemo({"colour": tuple(names), "shape": (None, None, None)}, where, where, None)
        demos.append(ScoredDemo(observation, truth, group=index))
    report = evaluate_concepts(demos, 12, TABLE, TABLE_RULES, robot="baxter", pure=False)
    rows = {row.name: row for row in report.rows}
    assert set(rows) == {"colour", "location", "distance"}  # no shape has a class, and nothing is near enough
    assert rows["colour"].ours.v_measure == pytest.approx(1.0)
    assert rows["colour"].known == rows["location"].known == 3


def test_nothing_to_score_is_said() -> None:
    with pytest.raises(LearningError, match="nothing to score"):
        evaluate_concepts([], 0, BOARD, BOARD_RULES, robot="three_dof")


def test_half_of_the_scenes_change(tmp_path: Path) -> None:
    write_synthetic_release(tmp_path, np.random.default_rng(0))
    release = Release.load(tmp_path)
    scenes = extended_scenes(release, np.random.default_rng(0))
    shapes = {thing.shape for each in scenes for thing in each.objects}
    assert shapes >= {"cube", "cylinder"}
    for each in scenes:
        own = {thing.shape for thing in each.objects}
        assert not {"cube", "cylinder"} <= own
        assert not {"prism", "sphere"} <= own
    demo = next(iter(scored_scenes(scenes, np.random.default_rng(0))))
    assert demo.truth.action in ("take", "drop", "move")
    assert len(demo.truth.properties["colour"]) == len(demo.observation.object_ids)
