"""Readings of whole sentences."""

from learning.concept_id import Concept
from learning.grammar.actions import ActionTable
from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import BoardElements
from learning.grammar.clauses import LINKED, read_clauses
from learning.grammar.innate import ABOVE, IT
from learning.grammar.phrase_chart import PhraseChart, Use
from learning.grammar.weights import Weights

RED, CUBE, MOVE = Concept("colour", 0), Concept("shape", 0), Concept("action", 1)
ACTIONS = ActionTable(starts_held={1: False}, ends_held={1: False}, composed={})


def test_either_of_two_alike_may_be_put_on_the_other() -> None:
    scene = BoardElements(Arrangement((3, 40), (0, 0), (0, 0), (0, 0), None), frozenset({0}))
    concepts = (MOVE, RED, CUBE, ABOVE, RED, CUBE)
    uses = [Use(k, k + 1, concept, 0.0, (), f"w{k}", f"w{k + 1}") for k, concept in enumerate(concepts)]
    chart = PhraseChart(len(uses), uses, [-5.0] * len(uses), lambda feature: 0.0, scene)
    best = read_clauses(chart, ACTIONS, lambda feature: 0.0)[0]
    assert dict(best.moves) == {0: 1 << 40, 1: 1 << 3}


def test_a_second_clause_is_rather_said_after_a_word_that_means_nothing_by_itself() -> None:
    """ "Take the red cube and put it on the blue one": "and" is not taken for a part of the verb for it."""
    scene = BoardElements(Arrangement((3, 40), (0, 0), (0, 1), (0, 0), None), frozenset({0}))
    actions = ActionTable(
        starts_held={1: False, 2: False, 3: True},
        ends_held={1: False, 2: True, 3: False},
        composed={(2, 3): 1},
    )
    said = (Concept("action", 2), RED, CUBE, None, Concept("action", 3), IT, ABOVE, Concept("colour", 1), CUBE)
    uses = [Use(k, k + 1, each, 0.0, (), f"w{k}", f"w{k + 1}") for k, each in enumerate(said) if each is not None]
    joined = Use(3, 4, Concept("action", 3), 0.0, (), "w3", "w4")
    weights = Weights()
    chart = PhraseChart(len(said), [*uses, joined], [-1.2] * len(said), weights.of, scene)
    best = read_clauses(chart, actions, weights.of)[0]
    assert best.moves == ((0, 1 << 40),)
    assert best.clauses[1].action.used == (4,)
    assert LINKED in best.features
