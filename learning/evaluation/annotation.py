"""Reading `annotation.txt` of a Train-Robots release. Only the scorer does this: the learner never sees a tree."""

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from learning.evaluation.public_tree import PublicNode, Span
from learning.train_robots.change import Change
from learning.train_robots.reader import Line, read_lines
from learning.train_robots.release import Release

CHANGED_LABELS = {"shape": "type", "colour": "color"}
"""Property of a block to the public label of its leaf."""
ANNOTATION_FILE = "annotation.txt"

_PIECES = re.compile(r"\(|\)|[^\s()]+")
_TOKENS = re.compile(r"[A-Za-z0-9']+|[^\sA-Za-z0-9']")


def tokens_of(sentence: str) -> tuple[str, ...]:
    """Split a sentence as the annotation counts it: words and punctuation marks are tokens.

    A sentence is split at every character that is neither a letter, a digit nor an apostrophe.
    """
    return tuple(_TOKENS.findall(sentence))


def word_tokens(sentence: str) -> tuple[int, ...]:
    """Numbers, from 1, of the tokens that are words: the learner's n-th word is token `word_tokens(s)[n - 1]`."""
    return tuple(
        number
        for number, token in enumerate(tokens_of(sentence), start=1)
        if any(character.isalnum() for character in token)
    )


def load_annotations(directory: str | Path) -> dict[int, PublicNode] | None:
    """Read the trees of a release by command id, or None when the directory has no `annotation.txt`.

    Raises ReleaseError that names file, line and what is wrong.
    """
    path = Path(directory) / ANNOTATION_FILE
    if not path.exists():
        return None
    trees: dict[int, PublicNode] = {}
    for line in read_lines(path):
        if not line.text:
            continue
        identifier, kind, text = line.columns(3, "command id, rcl, tree")
        line.choice(kind, "kind of annotation", ("rcl",))
        number = line.integer(identifier, "command id")
        if number in trees:
            raise line.error(f"command id {number} stands twice; ids must differ")
        trees[number] = _TreeReader(line, text).tree()
    return trees


def annotations_of(release: Release) -> dict[int, PublicNode] | None:
    """Read the trees of a release by command id, with what its extension changed; None without `annotation.txt`.

    Leaves that words stand for change with their words; what the annotation only implies stays as it is.

    Raises ReleaseError that names file, line and what is wrong.
    """
    trees = load_annotations(release.directory)
    if trees is None or not release.changes:
        return trees
    scene_of = {command.id: command.scene for command in release.commands}
    return {number: _changed(tree, release.changes.get(scene_of.get(number, 0), ())) for number, tree in trees.items()}


def _changed(node: PublicNode, changes: Sequence[Change]) -> PublicNode:
    value = node.value
    if value is not None and node.tokens is not None:
        kind, dash, rest = value.partition("-")
        for change in changes:
            if node.label == CHANGED_LABELS[change.what] and kind == change.old:
                value = change.new + dash + rest
                break
    return replace(node, value=value, children=tuple(_changed(child, changes) for child in node.children))


class _TreeReader:
    """Recursive descent over `(label: value (token: 4 6) (label: ...))`."""

    def __init__(self, line: Line, text: str) -> None:
        self._line = line
        self._pieces: list[str] = _PIECES.findall(text)
        self._next = 0

    def tree(self) -> PublicNode:
        """Read the one tree that the text holds."""
        node = self._node()
        if self._next < len(self._pieces):
            raise self._line.error(f"'{self._pieces[self._next]}' follows the end of the tree")
        return node

    def _node(self) -> PublicNode:
        self._expect("(")
        label = self._take()
        if not label.endswith(":") or len(label) == 1:
            raise self._line.error(f"'{label}' is not a label; expected a form such as 'color:'")
        value: str | None = None
        span: Span | None = None
        children: list[PublicNode] = []
        while (piece := self._peek()) != ")":
            if piece != "(":
                if value is not None:
                    raise self._line.error(f"'{label[:-1]}' has two values, '{value}' and '{piece}'")
                value = self._take()
            elif self._pieces[self._next + 1 : self._next + 2] == ["token:"]:
                span = self._token()
            else:
                children.append(self._node())
        self._expect(")")
        return PublicNode(label[:-1], value, span, tuple(children))

    def _token(self) -> Span:
        self._next += 2
        numbers: list[int] = []
        while self._peek() != ")":
            numbers.append(self._line.integer(self._take(), "token number"))
        self._expect(")")
        if len(numbers) not in (1, 2) or numbers[0] > numbers[-1]:
            raise self._line.error(f"token {numbers} is not one number or a rising pair")
        return numbers[0], numbers[-1]

    def _peek(self) -> str:
        if self._next == len(self._pieces):
            raise self._line.error("the tree ends before its brackets are closed")
        return self._pieces[self._next]

    def _take(self) -> str:
        piece = self._peek()
        self._next += 1
        return piece

    def _expect(self, wanted: str) -> None:
        piece = self._take()
        if piece != wanted:
            raise self._line.error(f"'{piece}' stands where '{wanted}' was expected")
