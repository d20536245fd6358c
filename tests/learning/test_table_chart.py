"""Which readings of a sentence a chart holds."""

import math

import pytest

from learning.concept_id import Concept
from learning.grammar import table_chart
from learning.grammar.rcl import RclNode
from learning.grammar.table_chart import TableChart, WordUse

MOVE, LEFT = Concept("action", 3), Concept("direction", 0)
MARKER, MUG = Concept("shape", 1), Concept("shape", 2)
PIECES = ("move", "marker", "left", "mug")
SAID = (MOVE, MARKER, LEFT, MUG)


def rule(left: str, right: tuple[str, ...]) -> float:
    """An action that hardly ever goes nowhere."""
    return math.log(0.03 if right == ("nowhere",) else 0.9)


def read() -> RclNode | None:
    uses = [WordUse(at, at + 1, concept, PIECES[at], -1.0) for at, concept in enumerate(SAID)]
    return TableChart(PIECES, uses, [-5.0] * 4, rule, lambda place, pieces: -3.0 * len(pieces), None).best()


@pytest.mark.parametrize("items", [2, 10])
def test_what_a_thing_is_keeps_its_place_among_readings_of_where_it_is(
    items: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    # "the marker left of the mug" explains more words than "the marker", and is not what shall be done.
    monkeypatch.setattr(table_chart, "MOST_ITEMS", items)
    tree = read()
    assert tree is not None
    assert [(node.label, node.first, node.last) for node in tree.children] == [
        ("action", 1, 1),
        ("entity", 2, 2),
        ("destination", 3, 4),
    ]
