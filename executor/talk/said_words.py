"""The words of a command with what each was taken to mean."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from executor.execution.spelling import taken_words
from executor.execution.steps import marked_words
from executor.lexicon import entry_of
from executor.word_kinds import WordKind, kind_of

if TYPE_CHECKING:
    from executor.report import ExecutionReport
    from learning import Knowledge
    from learning.concept_id import Concept


@dataclass(frozen=True, slots=True)
class SaidWord:
    """One word.

    Attributes:
        text: The word.
        kind: What it is about.
        meaning: Id of the concept, or empty.
    """

    text: str
    kind: WordKind
    meaning: str = ""


def words_of_report(report: "ExecutionReport", knowledge: "Knowledge") -> list[SaidWord]:
    """The words of a command as they were read; those that no reading uses as they are known by themselves.

    Words that were taken as others mean what those mean.
    """
    typed, taken = marked_words(report.sentence)[0], taken_words(report.spelling)
    words = tuple(taken.get(word, word) for word in typed)
    meant = _meant(report, words)
    unknown = set(report.unknown)
    read = report.tree is not None or any(step.tree is not None for step in report.steps)
    found = []
    for position, (text, word) in enumerate(zip(typed, words, strict=True)):
        if word in unknown:
            found.append(SaidWord(text, entry_of(knowledge, word).kind))
        elif position in meant:
            found.append(SaidWord(text, kind_of(meant[position]), str(meant[position])))
        elif read and not unknown:
            found.append(SaidWord(text, WordKind.FUNCTION))
        else:
            entry = entry_of(knowledge, word)
            found.append(SaidWord(text, entry.kind, "" if entry.concept is None else str(entry.concept)))
    return found


def _meant(report: "ExecutionReport", words: tuple[str, ...]) -> "dict[int, Concept]":
    """Position of each word of a leaf to what it means; steps are found in the sentence one after the other."""
    meant: dict[int, Concept] = {}
    after = 0
    for step in report.steps or (report,):
        start = next((at for at in range(after, len(words)) if words[at : at + len(step.words)] == step.words), after)
        for node in step.tree.nodes() if step.tree is not None else ():
            if node.concept is not None:
                meant |= dict.fromkeys(range(start + node.first - 1, start + node.last), node.concept)
        after = start + len(step.words)
    return meant
