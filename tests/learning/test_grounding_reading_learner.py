"""Learning a toy language from before and after, in two word orders."""

import json

import numpy as np
import pytest

from learning.concept_id import Concept
from learning.grammar.actions import ActionTable
from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import BoardElements
from learning.grammar.reading_tree import tree_of
from learning.grounding.reading_learner import LONGEST, ReadingLearner
from learning.interpretation.reading_interpreter import moves_of
from learning.percept import ShownAction
from twin.board import CELLS

TAKE, DROP, MOVE = 1, 2, 3
ACTIONS = ActionTable(
    starts_held={TAKE: False, DROP: True, MOVE: False},
    ends_held={TAKE: True, DROP: False, MOVE: False},
    composed={(TAKE, DROP): MOVE},
)
BEARING = frozenset({0})
COLOURS = ("rosso", "blu", "verde", "giallo")
SHAPES = ("cubo", "prisma")
Lesson = tuple[tuple[str, ...], Arrangement, ShownAction]


def lesson(rng: np.random.Generator) -> Lesson:
    """A take, or a move of one block onto another, noun before adjective."""
    looks = [(c, s) for c in range(len(COLOURS)) for s in range(len(SHAPES))]
    columns = tuple(int(c) for c in rng.permutation(CELLS * CELLS)[:6])
    chosen = [looks[int(k)] for k in rng.permutation(len(looks))[:6]]
    scene = Arrangement(columns, (0,) * 6, tuple(c for c, _ in chosen), tuple(s for _, s in chosen), None)
    moved = int(rng.integers(6))
    grounds = [i for i in range(6) if chosen[i][1] == 0 and i != moved]
    said = (SHAPES[chosen[moved][1]], COLOURS[chosen[moved][0]])
    if rng.random() < 0.3 or not grounds:
        return ("prendi", "il", *said), scene, ShownAction(TAKE, (TAKE,), moved, None, np.zeros(3))
    ground = grounds[int(rng.integers(len(grounds)))]
    onto = (SHAPES[0], COLOURS[chosen[ground][0]])
    shown = ShownAction(MOVE, (TAKE, DROP, MOVE), moved, columns[ground], np.zeros(3))
    return ("metti", "il", *said, "sopra", "il", *onto), scene, shown


def taught(seed: int, lessons: int = 120) -> ReadingLearner:
    learner = ReadingLearner()
    rng, replay = np.random.default_rng(seed), np.random.default_rng(1)
    for _ in range(lessons):
        words, scene, shown = lesson(rng)
        learner.learn(words, scene, shown, ACTIONS, BEARING, replay)
    return learner


@pytest.fixture(scope="module")
def learner() -> ReadingLearner:
    return taught(0)


def test_new_commands_are_understood(learner: ReadingLearner) -> None:
    rng = np.random.default_rng(9)
    right = 0
    for _ in range(40):
        words, scene, shown = lesson(rng)
        votes = moves_of(learner.read(words, BoardElements(scene, BEARING), ACTIONS))
        right += bool(votes) and max(votes, key=lambda move: votes[move]) == (shown.moved, shown.placement)
    assert right == 40  # looks are unique in every scene, so that every sentence has one meaning


def test_the_tree_says_what_was_said(learner: ReadingLearner) -> None:
    scene = Arrangement((3, 20), (0, 0), (0, 1), (1, 0), None)
    found = learner.read(
        ("metti", "il", "prisma", "rosso", "sopra", "il", "cubo", "blu"), BoardElements(scene), ACTIONS
    )
    tree = tree_of(found.readings[0], found.kept)
    assert [child.label for child in tree.children] == ["action", "entity", "destination"]
    leaves = [(node.label, node.first) for node in tree.nodes() if node.concept is not None]
    assert leaves == [
        ("action", 1),
        ("shape", 3),
        ("colour", 4),
        ("relation", 5),
        ("shape", 7),
        ("colour", 8),
    ]


def test_a_word_that_only_ever_comes_with_a_verb_has_no_meaning_of_its_own() -> None:
    """ "Prendi" and "prendi su": they mean one thing together, and it is the verb that means it."""
    learner = ReadingLearner()
    rng, replay = np.random.default_rng(0), np.random.default_rng(1)
    for _ in range(150):
        words, scene, shown = lesson(rng)
        if words[0] == "prendi" and rng.random() < 0.6:
            words = (words[0], "su", *words[1:])
        learner.learn(words, scene, shown, ACTIONS, BEARING, replay)
    take = Concept("action", TAKE)
    assert learner.meanings("prendi")[take] > 0.7
    assert learner.meanings("su").get(take, 0.0) < 0.5 * learner.meanings("su")[None]


def test_the_same_seed_learns_the_same() -> None:
    assert json.dumps(taught(3, 40).to_json()) == json.dumps(taught(3, 40).to_json())


def test_what_was_learned_survives_a_file(learner: ReadingLearner) -> None:
    again = ReadingLearner.from_json(json.loads(json.dumps(learner.to_json())))
    words, scene, shown = lesson(np.random.default_rng(5))
    votes = moves_of(again.read(words, BoardElements(scene, BEARING), ACTIONS))
    assert max(votes, key=lambda move: votes[move]) == (shown.moved, shown.placement)


def test_a_sentence_of_any_length_is_answered(learner: ReadingLearner) -> None:
    scene = BoardElements(Arrangement((3, 20), (0, 0), (0, 1), (1, 0), None))
    assert learner.read(("rosso",) * (LONGEST + 1), scene, ACTIONS).readings == ()
    assert learner.read(("rosso",) * LONGEST, scene, ACTIONS).readings == ()
    assert learner.read((), scene, ACTIONS).readings == ()


def test_a_contradiction_moves_nothing(learner: ReadingLearner) -> None:
    scene = BoardElements(Arrangement((3, 20), (0, 0), (0, 1), (1, 0), None), BEARING)
    found = learner.read(("metti", "il", "cubo", "blu", "sopra", "il", "cubo", "blu"), scene, ACTIONS)
    assert not any(reading.does(1, 20) for reading in found.readings)
