"""A command of several steps: cut where a step can begin, so that every part is understood in the world as it is then.

No word is known to join steps. A step begins with a word that was learned to name an action; what stands before it may
be words that were learned to mean nothing, and after such a word or a punctuation mark ones that were never heard.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Generic

from executor.execution.answer import Answer
from executor.execution.doer import Doer, View
from executor.execution.understood import Understood
from learning.grounding.ngrams import words_of

MOST_STEPS = 6
"""Steps of the longest command."""
MOST_JOINING = 4
"""Words that may stand between two steps."""
_MARKS = re.compile(r"[.,;:!?،؛。\n]+")


@dataclass(frozen=True, slots=True)
class Step:
    """One step of a command.

    Attributes:
        words: Its words.
        understood: How it was understood, in the scene as it would be then.
    """

    words: tuple[str, ...]
    understood: Understood


def marked_words(sentence: str) -> tuple[tuple[str, ...], frozenset[int]]:
    """Words of a sentence, and before which of them a punctuation mark stands (positions from 0)."""
    words: list[str] = []
    marks = set()
    for chunk in _MARKS.split(sentence):
        marks.add(len(words))
        words += words_of(chunk)
    return tuple(words), frozenset(mark for mark in marks if 0 < mark < len(words))


def steps_of(sentence: str, doer: Doer[Any], view: View, last: int | None, choice: int | None = None) -> list[Step]:
    """Split a command into as few steps as are all understood.

    Args:
        sentence: The command.
        doer: Who understands steps.
        view: The scene.
        last: Track number of what was handled last.
        choice: Track number of what was meant, as the answer to a question.

    Returns:
        The steps; only one, with its answer, where the command as a whole cannot be acted on and no cut helps.
    """
    words, marks = marked_words(sentence)
    splitter: _Splitter[View] = _Splitter(doer, marks, choice)
    return splitter.split(words, 0, view, last)


class _Splitter(Generic[View]):
    def __init__(self, doer: Doer[Any], marks: frozenset[int], choice: int | None) -> None:
        self.doer = doer
        self.marks = marks
        self.choice = choice

    def split(self, words: tuple[str, ...], offset: int, view: View, last: int | None, depth: int = 1) -> list[Step]:
        """Split words that begin at a position of the sentence."""
        whole = self.doer.understand(words, view, last, self.choice)
        if whole.clear or depth == MOST_STEPS:
            return [Step(words, whole)]
        best: list[Step] | None = None
        for before, after in self._cuts(words, offset):
            first = self.doer.understand(words[:before], view, last, self.choice)
            if not _makes_sense(first):
                continue
            handled = first.goals[0].object_id
            then = self.doer.imagine(view, first)
            rest = self.split(words[after:], offset + after, then, handled, depth + 1)
            if not all(_makes_sense(step.understood) for step in rest):
                continue
            found = [Step(words[:before], first), *rest]
            if best is None or _cost(found) < _cost(best):
                best = found
        return best or [Step(words, whole)]

    def _cuts(self, words: tuple[str, ...], offset: int) -> Iterator[tuple[int, int]]:
        """Where a step may end and the next begin: positions in the words."""
        for after in range(1, len(words)):
            if not self.doer.acts(words[after]) or self.doer.acts(words[after - 1]):
                continue
            before = after
            while (
                before > 1
                and after - before < MOST_JOINING
                and (self.doer.joins(words[before - 1]) or not self.doer.knows(words[before - 1]))
            ):
                before -= 1
            # A word that was never heard joins steps where it comes after one that does, or after a mark: before that
            # it is the end of the first step ("the red what-d'you-call-it and ...").
            while before < after and not self._opens_joint(words, before, offset):
                before += 1
            if all(self.doer.knows(word) for word in words[before:after]):
                yield after, after
            else:
                yield before, after

    def _opens_joint(self, words: tuple[str, ...], at: int, offset: int) -> bool:
        return self.doer.joins(words[at]) or offset + at in self.marks


def _makes_sense(understood: Understood) -> bool:
    """Whether a step is a command of its own, if perhaps one that cannot be done or needs a question."""
    return bool(understood.goals) and understood.answer in (None, Answer.AMBIGUOUS, Answer.IMPOSSIBLE)


def _cost(steps: list[Step]) -> tuple[int, int]:
    return sum(not step.understood.clear for step in steps), len(steps)
