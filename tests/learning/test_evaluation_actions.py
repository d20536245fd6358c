from dataclasses import replace

import numpy as np
import pytest

from learning.concepts import ConceptSpaces
from learning.evaluation.actions import score_actions
from learning.percept import NO_CONCEPT
from learning.perception.observation import Observation
from tests.learning.table_demos import ORDERING, TABLETOP, table_demo

ACTIONS = ORDERING | TABLETOP


def pairs(count: int) -> list[tuple[Observation, str]]:
    return [(table_demo(np.random.default_rng([seed, 9]), a)[0], a) for seed in range(count) for a in ACTIONS]


def test_five_demos_of_each_action_give_one_graphlet_for_each() -> None:
    spaces = ConceptSpaces()
    score = score_actions(pairs(8), spaces)
    assert score.v_measure >= 0.95
    assert score.graphlets == score.true_actions == len(ACTIONS) == len(spaces.actions)
    assert sum(score.counts.values()) == 8 * len(ACTIONS)
    assert not score.failures
    assert score.lines()[0].startswith("drop: 8 x action_4 [C touch raised 0]")


def test_what_was_never_shown_has_no_known_action() -> None:
    rng = np.random.default_rng(0)
    demos = [(table_demo(rng, a)[0], a) for a in ("lift", "lift", "press")]
    score = score_actions(demos, learned_demos=1)
    assert score.counts["lift", 1] == 2
    assert score.counts["press", 2] == 1
    nothing = score_actions(demos, learned_demos=0)
    assert nothing.graphlets == 0 and nothing.counts["press", NO_CONCEPT] == 1
    assert nothing.lines()[-1] == "press: 1 x no known action"


def test_demos_without_an_action_are_counted() -> None:
    observation, _ = table_demo(np.random.default_rng(1), "press")
    away = replace(observation, gripper_location=observation.gripper_location + 1.0)
    score = score_actions([(away, "press")])
    assert score.counts == {("press", NO_CONCEPT): 1}
    assert list(score.failures.values()) == [1]


def test_nothing_cannot_be_scored() -> None:
    with pytest.raises(ValueError, match="no demos to score: give at least one"):
        score_actions([])
