"""Who says things: for a board or a table, in each language that was heard."""

from learning.concepts.space_set import BOARD
from learning.errors import KnowledgeError, PerceptionError
from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import BoardElements
from learning.grammar.viterbi import ViterbiGrammar
from learning.graphs.action_states import shown_action
from learning.grounding.ngrams import words_of
from learning.grounding.reading_learner import ReadingLearner
from learning.grounding.table_scene import TableScene, still_record, table_record
from learning.knowledge import Knowledge
from learning.perception import Observation, perceive, percept_of
from learning.perception.tracks import anchors
from learning.saying.board_speaker import BoardSpeaker, read_thing
from learning.saying.saying import Saying
from learning.saying.table_speaker import TableSpeaker
from learning.saying.word_grammar import word_grammar


class Speaker:
    """Says what demos show and where things are, in words that were learned."""

    def __init__(self, knowledge: Knowledge, script: str | None = None) -> None:
        """Speak one language.

        Args:
            knowledge: What was learned; it is not changed.
            script: Script of the language to speak, such as `LATIN`; None speaks the one that was heard most.

        Raises:
            KnowledgeError: No language was learned, or none in this script, or not by readings.
        """
        phrasings = knowledge.phrasings.by_script
        if not phrasings:
            raise KnowledgeError(
                "this knowledge does not say how a language is spoken: learn again with `showtell learn` (by readings)"
            )
        if script is None:
            script = max(phrasings, key=lambda each: phrasings[each].sentences)
        if script not in phrasings:
            raise KnowledgeError(f"no language in the script '{script}' was heard; heard were {', '.join(phrasings)}")
        self.knowledge = knowledge
        self.script = script
        self.at_table = knowledge.spaces.space_set.name != BOARD.name
        self._board: BoardSpeaker | None = None
        self._table: TableSpeaker | None = None
        if self.at_table:
            self._table = TableSpeaker(knowledge.table_language.tongues[script], phrasings[script])
        elif isinstance(knowledge.language, ReadingLearner):
            self._board = BoardSpeaker(knowledge, knowledge.language, phrasings[script])
        else:
            raise KnowledgeError("the thesis's method learns no words to speak by: learn by readings")

    def event(self, observation: Observation) -> Saying | None:
        """Say what a demo shows; None where no sentence was found that is understood so.

        Raises:
            PerceptionError: Nothing was done in it, or something that was never learned.
        """
        if self._table is not None:
            return self._table.event(shown_scene(self.knowledge, observation))
        percept, shown = perceive(observation, self.knowledge.spaces, learn_action=False)
        if self._board is None or shown.action < 0:
            raise PerceptionError("the demo shows an action that was never learned")
        return self._board.event(Arrangement.of(percept), shown.action, shown.moved, shown.placement)

    def thing(self, observation: Observation, index: int) -> Saying | None:
        """Say where a thing is at the beginning, so that it is told from all others.

        Args:
            observation: A demo, or a scene that stands still.
            index: Index of the thing among the tracks.

        Raises:
            PerceptionError: There is no such thing.
        """
        count = len(observation.object_ids)
        if not 0 <= index < count:
            raise PerceptionError(f"there is no object {index}; {count} are seen, counted from 0")
        if self._table is not None:
            return self._table.thing(still_scene(self.knowledge, observation), index)
        if self._board is None:
            return None
        return self._board.thing(Arrangement.of(percept_of(observation, self.knowledge.spaces)), index)

    def word_grammar(self) -> ViterbiGrammar:
        """The language's learned grammar down to its words."""
        speaker = self._table.tongue if self._table is not None else self.knowledge.language
        return word_grammar(speaker.grammar, self.knowledge.phrasings.by_script[self.script])

    def heard_thing(self, phrase: str, scene: BoardElements) -> dict[int, float]:
        """What a phrase denotes on a board: sets of elements, as masks, with the shares of the readings."""
        if self._board is None:
            return {}
        return read_thing(self.knowledge, self._board.language, words_of(phrase), scene)


def shown_scene(knowledge: Knowledge, observation: Observation) -> TableScene:
    """What a demo at a table shows, in symbols.

    Raises:
        PerceptionError: No object was handled, or in a way that was never learned.
    """
    spaces, language = knowledge.spaces, knowledge.table_language
    graphlet, measures, moved = shown_action(observation, spaces)
    number = spaces.actions.find_like(graphlet, measures)
    if number is None:
        raise PerceptionError("the demo shows an action that was never learned")
    record = table_record(observation, spaces, number, graphlet, moved)
    return language.scene(record, spaces)


def still_scene(knowledge: Knowledge, observation: Observation) -> TableScene:
    """How things are at a table at the beginning, in symbols; nothing is moved."""
    record = still_record(observation, knowledge.spaces, anchors(observation)[0])
    return knowledge.table_language.scene(record, knowledge.spaces)
