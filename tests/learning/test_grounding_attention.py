"""What a shown move draws attention to."""

import numpy as np

from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import BoardElements
from learning.grammar.innate import COUNTS, UNIT
from learning.grounding.attention import HEADINGS, salient_meanings
from learning.percept import ShownAction
from twin.board import CELLS

MOVE = 3
SCENE = BoardElements(Arrangement((4 * CELLS + 4, 7), (0, 0), (0, 1), (0, 0), None))
"""A block at (4, 4), and one in a corner."""


def shift(x: int, y: int) -> ShownAction:
    """The first block moves to this cell."""
    return ShownAction(MOVE, (MOVE,), 0, x * CELLS + y, np.zeros(3))


def test_a_straight_move_draws_attention_to_how_far_it_goes_and_where() -> None:
    assert {HEADINGS[0], COUNTS[1], UNIT} <= set(salient_meanings(SCENE, shift(6, 4)))


def test_a_slanting_move_does_not() -> None:
    assert not {*HEADINGS, *COUNTS, UNIT} & set(salient_meanings(SCENE, shift(6, 5)))
