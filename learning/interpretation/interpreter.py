"""From a sentence and a percept to a goal, by whichever method the knowledge was learned with."""

from learning.grounding.language_learner import LanguageLearner
from learning.grounding.ngrams import words_of
from learning.interpretation.interpretation import Interpretation, refusal
from learning.interpretation.reading_interpreter import ReadingInterpreter
from learning.interpretation.thesis_interpreter import ThesisInterpreter
from learning.knowledge import Knowledge
from learning.percept import Percept


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
        if not words:
            return refusal(words, "the sentence is empty")
        language = self.knowledge.language
        if isinstance(language, LanguageLearner):
            return ThesisInterpreter(self.knowledge, language).interpret(words, percept)
        return ReadingInterpreter(self.knowledge, language).interpret(words, percept)
