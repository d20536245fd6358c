"""Where knowledge can be used: on what it was learned on, the board or tables."""

from typing import TYPE_CHECKING

from executor.errors import InputError
from learning.concepts.space_set import BOARD

if TYPE_CHECKING:
    from pathlib import Path

    from learning import Knowledge

SEVERAL = 2.0
"""Things seen to rest on the table in a demo: at the counter of `ordering` there is one, on a `tabletop` several."""


def usual_scene(knowledge: "Knowledge") -> str:
    """Name of the scene that is most like those that knowledge was learned on, where none is asked for."""
    if knowledge.spaces.space_set.name == BOARD.name:
        return "board"
    resting = knowledge.table_language.resting.count - 1.0  # one is imagined
    return "ordering" if 0.0 < resting < SEVERAL * knowledge.demos else "tabletop"


def check_fit(knowledge: "Knowledge", kind: str, source: "Path | str" = "this knowledge") -> None:
    """See that knowledge was learned on the kind of scene that it is to be used in.

    Args:
        knowledge: What was learned.
        kind: The scene's kind, `board` or `table`.
        source: What the message calls the knowledge: its file.

    Raises:
        InputError: The knowledge is of the board and the scene is a table, or the other way round; says what to do.
    """
    on_board = knowledge.spaces.space_set.name == BOARD.name
    if on_board == (kind == "board"):
        return
    made, here = ("the board", "a table") if on_board else ("tables", "the board")
    raise InputError(
        f"{source} was learned on {made}, but this scene is {here}: use it on {made} (--scene "
        f"{usual_scene(knowledge)}), or give knowledge that was learned on {'tables' if on_board else 'the board'}"
    )
