"""Scoring one answer: execution by the layouts, trees by the annotation (design section 6)."""

from collections.abc import Mapping
from dataclasses import dataclass

from learning.concept_id import Concept
from learning.evaluation.annotation import word_tokens
from learning.evaluation.answers import Answer
from learning.evaluation.public_labels import public_tree
from learning.evaluation.public_tree import PublicNode, same_tree, subtree_f1
from learning.train_robots.layout import Block
from learning.train_robots.release import Command
from learning.train_robots.scene import Scene
from twin.board import nearest_cell

CAUSES = {
    "not understood: nothing in the scene": "not understood: nothing in the scene fits a word",
    "not understood: the words do not add up": "not understood: the words do not add up to an action",
    "not understood": "not understood: too little was learned",
    "moves": "wrong thing",
    "keeps": "right thing, not put down",
    "puts": "right thing, wrong place",
    "scene": "the scene does not move exactly one block",
}
"""Beginnings of reasons to what they have in common; the longer ones stand first."""


@dataclass(frozen=True, slots=True)
class CommandScore:
    """Score of one command.

    Attributes:
        command: The command.
        reason: Why the answer is wrong, empty when it is right.
        understood: Whether there was a goal at all.
        rcl_exact: Whether the tree equals the annotated one; None without an annotation.
        subtree: F1 of the tree's nodes in 0..1; None without an annotation.
    """

    command: Command
    reason: str
    understood: bool
    rcl_exact: bool | None
    subtree: float | None

    @property
    def right(self) -> bool:
        """Whether the reading's moved block and its final cell are those of the after layout."""
        return not self.reason


def score(answer: Answer, scene: Scene, annotated: PublicNode | None, names: Mapping[Concept, str]) -> CommandScore:
    """Score an answer.

    Args:
        answer: What the learner said.
        scene: The truth.
        annotated: The annotated tree, None when there is none.
        names: Public values of concepts.
    """
    exact: bool | None = None
    subtree: float | None = None
    if annotated is not None:
        tree = None
        if answer.tree is not None:
            tree = public_tree(answer.tree, names, word_tokens(answer.command.sentence))
        exact, subtree = same_tree(tree, annotated), subtree_f1(tree, annotated)
    return CommandScore(answer.command, fault(answer, scene), answer.understood, exact, subtree)


def fault(answer: Answer, scene: Scene) -> str:
    """Say what is wrong with an answer by the after layout; an empty string when it is right."""
    move = scene.move
    if move is None:
        return f"scene {scene.number} does not move exactly one block"
    if not answer.understood:
        return f"not understood: {answer.explanation}"
    blocks = scene.before.blocks
    if answer.object_ids != {move.object_id}:
        meant = ", ".join(_describe(blocks[number]) for number in sorted(answer.object_ids))
        return f"moves {meant} instead of {_describe(blocks[move.object_id])}"
    if answer.position is None:
        return "" if move.held_at_end else f"keeps the block instead of putting it in cell {move.goal}"
    cell = nearest_cell(answer.position)
    if move.held_at_end:
        return f"puts the block in cell {cell} instead of keeping it"
    return "" if cell == move.goal else f"puts the block in cell {cell} instead of {move.goal}"


def cause_of(reason: str) -> str:
    """The sort of fault that a reason tells of, for counting."""
    for beginning, cause in CAUSES.items():
        if reason.startswith(beginning):
            return cause
    return reason


def _describe(block: Block) -> str:
    return f"the {block.colour} {block.shape} in cell {block.cell}"
