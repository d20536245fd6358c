"""From a sentence and a percept to a goal, by whichever method the knowledge was learned with."""

import unicodedata
from dataclasses import replace

from learning.grounding.language_learner import LanguageLearner
from learning.grounding.ngrams import words_of
from learning.interpretation.interpretation import Interpretation, listed, refusal
from learning.interpretation.reading_interpreter import ReadingInterpreter
from learning.interpretation.thesis_interpreter import ThesisInterpreter
from learning.knowledge import Knowledge
from learning.percept import Percept

SIGNS = ("So", "Sm", "Sc")
"""Unicode categories of pictures, mathematical signs and currencies."""


class Interpreter:
    """Reads sentences with what was learned."""

    def __init__(self, knowledge: Knowledge) -> None:
        """Use this knowledge; it is not changed."""
        self.knowledge = knowledge

    def interpret(self, sentence: str, percept: Percept) -> Interpretation:
        """Find the most probable reading that the scene allows.

        Never raises for what a sentence says: what is not understood is explained.
        """
        words = words_of(sentence)
        signs = _signs(sentence)
        if not words:
            why = f"the sentence holds no word, only {listed(signs)}" if signs else "the sentence is empty"
            return refusal(words, why, signs)
        found = self._interpret(words, percept)
        if signs:
            explanation = f"{found.explanation}; nothing is known of {listed(signs)}"
            found = replace(found, unknown=(*found.unknown, *signs), explanation=explanation)
        return found

    def _interpret(self, words: tuple[str, ...], percept: Percept) -> Interpretation:
        language = self.knowledge.language
        if isinstance(language, LanguageLearner):
            return ThesisInterpreter(self.knowledge, language).interpret(words, percept)
        return ReadingInterpreter(self.knowledge, language).interpret(words, percept)


def _signs(sentence: str) -> tuple[str, ...]:
    """Signs that stand for something but are no part of a word, such as emoji: each once."""
    return tuple(dict.fromkeys(sign for sign in sentence if unicodedata.category(sign) in SIGNS))
