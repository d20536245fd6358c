"""Readings of whole sentences."""

from learning.concept_id import Concept
from learning.grammar.actions import ActionTable
from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import BoardElements
from learning.grammar.clauses import read_clauses
from learning.grammar.innate import ABOVE
from learning.grammar.phrase_chart import PhraseChart, Use

RED, CUBE, MOVE = Concept("colour", 0), Concept("shape", 0), Concept("action", 1)
ACTIONS = ActionTable(starts_held={1: False}, ends_held={1: False}, composed={})


def test_either_of_two_alike_may_be_put_on_the_other() -> None:
    scene = BoardElements(Arrangement((3, 40), (0, 0), (0, 0), (0, 0), None), frozenset({0}))
    concepts = (MOVE, RED, CUBE, ABOVE, RED, CUBE)
    uses = [Use(k, k + 1, concept, 0.0, (), f"w{k}", f"w{k + 1}") for k, concept in enumerate(concepts)]
    chart = PhraseChart(len(uses), uses, [-5.0] * len(uses), lambda feature: 0.0, scene)
    best = read_clauses(chart, ACTIONS, lambda feature: 0.0)[0]
    assert dict(best.moves) == {0: 1 << 40, 1: 1 << 3}
