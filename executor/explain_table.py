"""How a sentence about a table is understood: its words, what they denote, and what the words could mean besides."""

from collections.abc import Iterator, Mapping

from executor.explanation import Alternative, Explanation, Referent, WordRow, bracketed, on_one_line, usual_meanings
from executor.table_words import main_words
from learning.concept_id import Concept
from learning.grammar.scene import bits
from learning.grounding.ngrams import words_of
from learning.grounding.scripts import script_of
from learning.grounding.table_scene import BESIDE, MIDDLE, OVER, SIDE_PLACES, TableScene
from learning.grounding.tongue import Tongue
from learning.interpretation.table_interpreter import TableInterpreter, TableReading
from learning.knowledge import Knowledge
from learning.perception import Observation
from learning.perception.tracks import anchors
from learning.saying.speaker import Speaker
from learning.saying.table_understanding import TableDenotation
from learning.saying.word_grammar import without_passed
from learning.saying.wording import marked

MEASURED = {
    **dict(zip(SIDE_PLACES, ("towards +x", "towards -x", "towards +y", "towards -y"), strict=True)),
    MIDDLE: "in the middle",
    BESIDE: "close to it",
    OVER: "on or in it",
}
"""What innate concepts of a table measure."""
OTHERS = 3
"""Other meanings of words that are told."""
LEAST_OTHER = 0.08
"""Rarer ones are not."""


class TableExplainer:
    """Explains sentences about one table."""

    def __init__(self, knowledge: Knowledge, observation: Observation) -> None:
        """Look at a table with what was learned."""
        self.knowledge = knowledge
        self.observation = observation
        self.interpreter = TableInterpreter(knowledge)
        self.scene: TableScene = self.interpreter.scene(observation)
        self._places = anchors(observation)[1]

    def explain(self, sentence: str) -> Explanation:
        """Tell how a sentence is understood."""
        words = words_of(sentence)
        reading = self.interpreter.interpret(words, self.observation)
        tongue = self.knowledge.table_language.tongues.get(script_of(words))
        if tongue is None:
            rows = tuple(WordRow(word, "", "never heard") for word in words)
            return Explanation(False, reading.explanation, rows, None, unknown=reading.unknown)
        self._names = main_words(tongue)
        return Explanation(
            understood=reading.understood,
            summary=reading.explanation,
            words=tuple(self._words(tongue, reading)),
            tree=None if reading.tree is None else reading.tree.draw(words),
            referents=tuple(self._referents(reading)),
            alternatives=tuple(self._alternatives(tongue, reading)),
            plain=self._plain(words),
            unknown=reading.unknown,
        )

    def told(self, concept: Concept) -> str:
        """A concept with what it measures, if it is innate."""
        return f"{concept}: {MEASURED[concept]}" if concept in MEASURED else str(concept)

    def thing(self, index: int) -> str:
        """A thing by its number, in words that were learned, and where it is."""
        named = " ".join(self._names.get(concept, str(concept)) for concept in sorted(self.scene.looks[index]))
        x, y = self._places[index, :2]
        return f"object {index} ({named}, at {1000 * x:.0f}, {1000 * y:.0f} mm)"

    def _words(self, tongue: Tongue, reading: TableReading) -> Iterator[WordRow]:
        meant: dict[int, list[Concept]] = {}
        for node in reading.tree.nodes() if reading.tree is not None else ():
            for position in range(node.first - 1, node.last) if node.concept is not None else ():
                if node.concept is not None:
                    meant.setdefault(position, []).append(node.concept)
        for position, word in enumerate(reading.words):
            pieces = tongue.joined.pieces(word)
            usual = " + ".join(
                f"{'' if len(pieces) == 1 else f'{piece}: '}{usual_meanings(tongue.grounding.counts.get(piece, {}))}"
                for piece in pieces
            )
            told = on_one_line(self.told(concept) for concept in meant.get(position, ())) if position in meant else ""
            yield WordRow(word, told, "never heard" if word in reading.unknown else usual)

    def _referents(self, reading: TableReading) -> Iterator[Referent]:
        denotation = TableDenotation(self.scene)
        for node in reading.tree.nodes() if reading.tree is not None else ():
            text = " ".join(reading.words[node.first - 1 : node.last])
            if node.label == "entity":
                if any(child.label == "reference" for child in node.children):
                    yield Referent(text, "entity", "what was spoken of before")
                else:
                    yield Referent(text, "entity", self._some(denotation.things(node)))
            elif node.label == "spatial-relation":
                concepts = [child.concept for child in node.children if child.concept is not None]
                yield Referent(text, "where", on_one_line(self.told(concept) for concept in concepts))
        yield Referent("(all of it)", "what is handled", self._listed(reading.things))
        if reading.goal is not None:
            goal = on_one_line(self.told(concept) for concept in sorted(reading.goal.concepts))
            grounds = f" of {self._listed(reading.goal.grounds)}" if reading.goal.grounds else ""
            yield Referent("(all of it)", "where to", f"{goal}{grounds}")

    def _some(self, mask: int) -> str:
        return self._listed(tuple(bits(mask)))

    def _listed(self, things: tuple[int, ...]) -> str:
        return on_one_line(self.thing(index) for index in things) if things else "nothing that is here"

    def _alternatives(self, tongue: Tongue, reading: TableReading) -> Iterator[Alternative]:
        """Other meanings of words that have several: what the sentence would be about then."""
        if reading.tree is None:
            return
        found = []
        for leaf in (node for node in reading.tree.nodes() if node.concept is not None):
            ngram = " ".join(reading.words[leaf.first - 1 : leaf.last])
            row: Mapping[Concept | None, float] = tongue.grounding.counts.get(ngram, {})
            total = sum(max(0.0, count) for count in row.values())
            for concept, count in row.items():
                if concept not in (None, leaf.concept) and total and count / total >= LEAST_OTHER:
                    found.append((count / total, ngram, leaf, concept, row.get(leaf.concept, 0.0) / total))
        for share, ngram, leaf, concept, own in sorted(found, key=lambda each: -each[0])[:OTHERS]:
            holders = [index for index, looks in enumerate(self.scene.looks) if concept in looks]
            does = self._listed(tuple(holders)) if leaf.label not in ("action", "reference") else "another action"
            why = f"read as {leaf.concept} in {own:.2f} of all times, as {concept} in {share:.2f}"
            yield Alternative(f"“{ngram}” as {self.told(concept)}", does, share, why)

    def _plain(self, words: tuple[str, ...]) -> str | None:
        script = script_of(words)
        if script not in self.knowledge.phrasings.by_script:
            return None
        tongue = self.knowledge.table_language.tongues[script]
        pieces = marked(*tongue.joined.split(words))
        parsed = Speaker(self.knowledge, script).word_grammar().parse(pieces)
        tree = None if parsed is None else without_passed(parsed[1])
        return None if parsed is None or tree is None else f"{bracketed(tree, pieces)}, log probability {parsed[0]:.1f}"


def explain_table(knowledge: Knowledge, sentence: str, observation: Observation) -> Explanation:
    """Tell how a sentence is understood about a table."""
    return TableExplainer(knowledge, observation).explain(sentence)
