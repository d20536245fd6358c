"""The board as if nothing were in the way: what a sentence speaks of, whether or not it can be done as things stand."""

from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import COLUMNS, BoardElements


class Unobstructed(BoardElements):
    """Elements of a board on which every block may be moved, and every column and block be put upon."""

    def __init__(self, arrangement: Arrangement) -> None:
        """Index an arrangement."""
        super().__init__(arrangement)
        held = arrangement.held
        self.clear = self.blocks & ~self.held
        self.usable = (1 << COLUMNS) - 1
        for block in range(self.count):
            if block != held:
                self._landing_of[block] = 1 << self.columns[block]
