"""Words that were never heard and look like ones that were: what a person may have meant to type.

A word is near another when a few letters are left out, put in, taken for others, or two neighbours changed places. Only
words whose meaning is known are offered.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from executor.lexicon import entry_of, heard_words
from executor.word_kinds import WordKind
from learning.grounding.ngrams import with_words
from learning.grounding.scripts import script_of
from learning.grounding.slips import near_words

if TYPE_CHECKING:
    from learning import Knowledge
    from learning.concept_id import Concept

RARELY = 0.1
"""What was heard less often than this share of the most frequent one is not offered beside it."""


@dataclass(frozen=True, slots=True)
class Spelling:
    """A word that was never heard, and heard ones that it may stand for.

    Attributes:
        word: The word.
        candidates: What it may stand for, the most frequent first; each means another thing.
        joins: Whether it is taken as a word that means nothing by itself.
    """

    word: str
    candidates: tuple[str, ...]
    joins: bool = False

    @property
    def taken(self) -> str | None:
        """The heard word that it is taken as; None where there are several."""
        return self.candidates[0] if len(self.candidates) == 1 else None

    def told(self) -> str:
        """What it is taken as, or may be."""
        named = [f"“{each}”" for each in self.candidates]
        if self.taken is not None:
            return f"I take “{self.word}” as {named[0]}"
        return f"I never heard “{self.word}”: perhaps you mean {', '.join(named[:-1])} or {named[-1]}"

    def to_dict(self) -> dict[str, object]:
        """Plain values for JSON."""
        return {"word": self.word, "taken": self.taken, "candidates": list(self.candidates)}


@dataclass(frozen=True, slots=True)
class Suggestion:
    """A sentence with a heard word in place of one that was not.

    Attributes:
        word: The heard word.
        sentence: The sentence with it.
    """

    word: str
    sentence: str


def suggestions(sentence: str, spellings: Iterable[Spelling]) -> tuple[Suggestion, ...]:
    """What may have been meant, by the first word that may stand for several."""
    asked = next((each for each in spellings if each.taken is None), None)
    if asked is None:
        return ()
    return tuple(Suggestion(word, with_words(sentence, {asked.word: word})) for word in asked.candidates)


def spellings_of(words: Iterable[str], knowledge: "Knowledge") -> tuple[Spelling, ...]:
    """Find what words that were never heard may stand for; those that look like no other are left out."""
    found = []
    for word in dict.fromkeys(words):
        if candidates := _candidates(word, knowledge):
            joins = len(candidates) == 1 and entry_of(knowledge, candidates[0]).concept is None
            found.append(Spelling(word, candidates, joins))
    return tuple(found)


def slips_put_right(words: Iterable[str], knowledge: "Knowledge") -> tuple[Spelling, ...]:
    """Words that were never heard and that the language of a table itself reads as others."""
    found = []
    for word in dict.fromkeys(words):
        tongue = knowledge.table_language.tongues.get(script_of((word,)))
        right = word if tongue is None else "".join(tongue.joined.pieces(word))
        if right != word and not heard_words(knowledge, word).get(word):
            found.append(Spelling(word, (right,)))
    return tuple(found)


def taken_words(spellings: Iterable[Spelling]) -> dict[str, str]:
    """The words that are taken as others."""
    return {each.word: each.taken for each in spellings if each.taken is not None}


def _candidates(word: str, knowledge: "Knowledge") -> tuple[str, ...]:
    """Heard words that are nearest to a word, one of each meaning."""
    heard = heard_words(knowledge, word)
    near = near_words(word, heard)
    for slips in sorted(near):
        if meant := _of_each_meaning(near[slips], heard, knowledge):
            return meant
    return ()


def _of_each_meaning(words: Iterable[str], heard: Mapping[str, float], knowledge: "Knowledge") -> tuple[str, ...]:
    """Of the words that are known to mean something, or nothing by themselves, the most frequent of each meaning."""
    often: dict[Concept | None, str] = {}
    for word in sorted(words, key=lambda each: (-heard[each], each)):
        entry = entry_of(knowledge, word)
        if entry.kind not in (WordKind.UNKNOWN, WordKind.UNSURE):
            often.setdefault(entry.concept, word)
    most = max((heard[word] for word in often.values()), default=0.0)
    return tuple(word for word in often.values() if heard[word] >= RARELY * most)
