"""How a sentence about the board is understood: its words, what they denote, and what else it could have meant."""

from collections.abc import Iterator, Mapping
from typing import cast

from executor.explanation import (
    Alternative,
    Explanation,
    Referent,
    WordRow,
    bracketed,
    main_meaning,
    on_one_line,
    usual_meanings,
)
from executor.learned_tables import words_of_concepts
from learning.concept_id import Concept
from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import BoardElements
from learning.grammar.clauses import CommandReading
from learning.grammar.innate import MEASURED
from learning.grammar.phrase import Phrase
from learning.grammar.phrase_chart import Denotation, Modifier
from learning.grammar.rcl import RclNode
from learning.grammar.reading_tree import tree_of
from learning.grammar.scene import bits
from learning.grounding.ngrams import words_of
from learning.grounding.reading_learner import ReadingLearner, Readings
from learning.interpretation import Interpretation, Interpreter
from learning.interpretation.reading_interpreter import moves_of
from learning.knowledge import Knowledge
from learning.percept import Percept
from learning.saying.speaker import Speaker
from learning.saying.word_grammar import without_passed
from twin.board import CELLS

ALTERNATIVES = 3
"""Other readings that are told."""
REASONS = 3
"""Reasons that are told for each."""
LEAST_REASON = 0.15
"""Differences that matter less, in log probability, are not told."""
SHOWN = 6
"""Most things that are listed of what a part denotes."""


class BoardExplainer:
    """Explains sentences in one scene."""

    def __init__(self, knowledge: Knowledge, language: ReadingLearner, percept: Percept) -> None:
        """Look at a scene with what was learned."""
        self.knowledge = knowledge
        self.language = language
        self.percept = percept
        self.scene = BoardElements(Arrangement.of(percept), knowledge.bearing_shapes())
        self._names = {concept: entries[0][0] for concept, entries in words_of_concepts(knowledge).items() if entries}

    def explain(self, sentence: str) -> Explanation:
        """Tell how a sentence is understood."""
        words = words_of(sentence)
        reading = Interpreter(self.knowledge).interpret(sentence, self.percept)
        found = self.language.read(words, self.scene, self.knowledge.action_table())
        best = self._best(found)
        return Explanation(
            understood=reading.understood,
            summary=reading.explanation,
            words=tuple(self._words(words, reading.tree)),
            tree=None if reading.tree is None else reading.tree.draw(words),
            referents=tuple(self._referents(words, found, best)),
            alternatives=tuple(self._alternatives(words, found, best)),
            plain=self._plain(words),
            notes=tuple(self._notes(words, reading.tree)),
            unknown=reading.unknown,
            confidence=reading.confidence if reading.understood else None,
        )

    def _notes(self, words: tuple[str, ...], tree: RclNode | None) -> Iterator[str]:
        """Words that are taken otherwise than usual, though something is understood."""
        meant = _meant(tree)
        for position, word in enumerate(words) if tree is not None else ():
            usual, here = main_meaning(self.language.grounding.counts.get(word, {})), meant.get(position)
            if usual is not None and here != usual:
                taken = "it is passed over" if here is None else f"it is taken as {self.told(here)}"
                yield f"“{word}” usually means {self.told(usual)}, but what says so fits this scene less well: {taken}"

    def _best(self, found: Readings) -> CommandReading | None:
        votes = moves_of(found)
        if not votes:
            return None
        move = max(votes, key=lambda each: votes[each])
        return next(reading for reading in found.readings if reading.does(*move))

    def _words(self, words: tuple[str, ...], tree: RclNode | None) -> Iterator[WordRow]:
        meant = _meant(tree)
        for position, word in enumerate(words):
            concept = meant.get(position)
            usual = usual_meanings(self.language.grounding.counts.get(word, {}))
            if not self.language.knows(word):
                usual = "never heard"
            yield WordRow(word, "" if concept is None else self.told(concept), usual)

    def told(self, concept: Concept) -> str:
        """A concept with what it measures, if it is innate."""
        return f"{concept}: {MEASURED[concept]}" if concept in MEASURED else str(concept)

    def _referents(self, words: tuple[str, ...], found: Readings, reading: CommandReading | None) -> Iterator[Referent]:
        if reading is None:
            return
        for clause in reading.clauses:
            for part in clause.parts:
                what = "destination" if part is clause.goal else part.label
                yield from self._told(words, found, part, what)
        moved = [self.thing(thing) for thing, _ in reading.moves]
        yield Referent("(all of it)", "what moves", self._some(moved))
        places = sorted({place for _, mask in reading.moves for place in bits(mask)})
        if reading.ends_held:
            yield Referent("(all of it)", "where to", "stays in the gripper")
        else:
            yield Referent("(all of it)", "where to", self._some([self.cell(place) for place in places]))

    def _told(self, words: tuple[str, ...], found: Readings, phrase: Phrase, what: str) -> Iterator[Referent]:
        """A phrase and the phrases in it that denote something."""
        text = " ".join(words[found.kept[phrase.first] : found.kept[phrase.after - 1] + 1])
        if phrase.label == "entity":
            elements, nearest, refers = cast(Denotation, phrase.meaning)
            told = "what was spoken of before" if refers else self._elements(elements)
            yield Referent(text, what, f"the nearest of: {told}" if nearest else told)
        elif phrase.label in ("modifier", "shift"):
            meaning = cast(Modifier, phrase.meaning)
            steps = f"{meaning.steps} steps " if meaning.steps else ""
            yield Referent(text, what, f"{steps}{self.told(meaning.relation)}")
        for child in phrase.children:
            if child.label in ("entity", "modifier"):
                yield from self._told(words, found, child, "modifier" if child.label == "modifier" else "landmark")

    def _elements(self, mask: int) -> str:
        things = bits(mask & self.scene.blocks)
        places = bits(mask & self.scene.places)
        stacks = len(bits(mask)) - len(things) - len(places)
        told = [self.thing(thing) for thing in things]
        told += [self._place(place) for place in places]
        if stacks:
            told.append(f"{stacks} stack(s)")
        return self._some(told)

    def _place(self, bit: int) -> str:
        place = self.scene.place(bit)
        if place is None:
            return "?"
        return f"{self._names.get(place.kind, str(place.kind))} of {place.cells.bit_count()} cell(s)"

    def _some(self, told: list[str]) -> str:
        more = len(told) - SHOWN
        return on_one_line([*told[:SHOWN], *([f"and {more} more"] if more > 0 else [])])

    def thing(self, index: int) -> str:
        """A block by its number, in words that were learned, and where it is."""
        looks = sorted(self.scene.looks(index))
        named = " ".join(self._names.get(concept, str(concept)) for concept in looks)
        free = "" if (self.scene.clear | self.scene.held) >> index & 1 else ", something on it"
        held = ", held" if self.scene.held >> index & 1 else ""
        cell = self.cell(self.scene.columns[index])
        return f"object {int(self.percept.object_ids[index])} ({named}, {cell}{free}{held})"

    def cell(self, column: int) -> str:
        """A column of cells."""
        x, y = divmod(column, CELLS)
        return f"cell {x}, {y}"

    def _alternatives(
        self, words: tuple[str, ...], found: Readings, chosen: CommandReading | None
    ) -> Iterator[Alternative]:
        if chosen is None:
            return
        kept = tuple(words[position] for position in found.kept)
        for reading, share in list(zip(found.readings, found.shares(), strict=True))[: ALTERNATIVES + 1]:
            if reading is chosen:
                continue
            why = self._why(kept, chosen, reading)
            tree = _line(tree_of(reading, found.kept), words)
            yield Alternative(tree, self._does(reading), share, on_one_line(why))

    def _does(self, reading: CommandReading) -> str:
        things = self._some([self.thing(thing) for thing, _ in reading.moves])
        if reading.ends_held:
            return f"takes {things}"
        places = sorted({place for _, mask in reading.moves for place in bits(mask)})
        return f"moves {things} to {self._some([self.cell(place) for place in places])}"

    def _why(self, kept: tuple[str, ...], chosen: CommandReading, other: CommandReading) -> list[str]:
        """What counts most for the chosen reading, next to another."""
        mine, theirs = self._counted(kept, chosen), self._counted(kept, other)
        lead = {key: mine.get(key, 0.0) - theirs.get(key, 0.0) for key in {**mine, **theirs}}
        best = sorted(lead.items(), key=lambda entry: -entry[1])
        told = [
            f"{key} {'is likelier' if key in mine else 'is unlikely'} (+{worth:.1f})"
            for key, worth in best[:REASONS]
            if worth >= LEAST_REASON
        ]
        return told or ["the other is nearly as likely: both do the same or fit as well"]

    def _counted(self, kept: tuple[str, ...], reading: CommandReading) -> dict[str, float]:
        """What a reading is made of, with weights: words and their meanings, rules, words that are passed over."""
        uses = self.language.uses_of(kept, self.knowledge.action_table())
        passed = dict(zip((kept[position] for position in uses.kept), uses.passed, strict=True))
        weight = self.language.weights.of
        counted: dict[str, float] = {}
        used: set[int] = set()
        for phrase in reading.phrases():
            for leaf in phrase.leaves():
                used.update(leaf.used)
                word = " ".join(kept[position] for position in leaf.used)
                after = kept[leaf.used[-1] + 1 : leaf.after]
                _add(counted, f"“{word}” as {leaf.concept}", leaf.score - sum(passed.get(each, 0.0) for each in after))
            for inner in _inner(phrase):
                for feature in inner.features:
                    _add(counted, _said_of(feature), weight(feature))
        for feature in reading.features:
            _add(counted, _said_of(feature), weight(feature))
        for position, word in enumerate(kept):
            if position not in used:
                _add(counted, f"passing over “{word}”", passed.get(word, 0.0))
        return counted

    def _plain(self, words: tuple[str, ...]) -> str | None:
        if not self.knowledge.phrasings.by_script:
            return None
        parsed = Speaker(self.knowledge).word_grammar().parse(words)
        tree = None if parsed is None else without_passed(parsed[1])
        return None if parsed is None or tree is None else f"{bracketed(tree, words)}, log probability {parsed[0]:.1f}"


def explain_board(knowledge: Knowledge, language: ReadingLearner, sentence: str, percept: Percept) -> Explanation:
    """Tell how a sentence is understood on a board."""
    return BoardExplainer(knowledge, language, percept).explain(sentence)


def explain_plainly(reading: Interpretation) -> Explanation:
    """What can be told of a sentence that was understood by the thesis's method."""
    words = reading.words
    rows = tuple(WordRow(word, "", "never heard" if word in reading.unknown else "-") for word in words)
    return Explanation(
        understood=reading.understood,
        summary=reading.explanation,
        words=rows,
        tree=None if reading.tree is None else reading.tree.draw(words),
        unknown=reading.unknown,
        confidence=reading.confidence if reading.understood else None,
    )


def _meant(tree: RclNode | None) -> dict[int, Concept]:
    """Position of each word of a leaf to what it means."""
    meant: dict[int, Concept] = {}
    for node in tree.nodes() if tree is not None else ():
        if node.concept is not None:
            meant |= dict.fromkeys(range(node.first - 1, node.last), node.concept)
    return meant


def _inner(phrase: Phrase) -> Iterator[Phrase]:
    """A phrase and its parts that are not single words."""
    if phrase.concept is None:
        yield phrase
    for child in phrase.children:
        yield from _inner(child)


def _add(counted: dict[str, float], key: str, amount: float) -> None:
    counted[key] = counted.get(key, 0.0) + amount


_TOLD: Mapping[tuple[str, ...], str] = {
    ("modified", "in vain"): "a relation that rules nothing out",
    ("ranked", "in vain"): "a rank that rules nothing out",
}


def _said_of(feature: tuple[str, ...]) -> str:
    """A feature in words."""
    if feature in _TOLD:
        return _TOLD[feature]
    kind, *rest = feature
    if kind == "moves":
        return f"leaving {rest[0]} move(s) open"
    if kind == "clause":
        order = " ".join({"a": "action", "e": "entity", "g": "destination"}.get(each, each) for each in rest[-1])
        return f"a clause in the order {order or 'of nothing'}"
    if kind == "sense":
        return f"a description as {rest[0]}"
    return f"{kind} {' '.join(rest)}"


def _line(tree: RclNode, words: tuple[str, ...]) -> str:
    if tree.concept is not None:
        return f"{tree.concept} “{' '.join(words[tree.first - 1 : tree.last])}”"
    return f"{tree.label}({', '.join(_line(child, words) for child in tree.children)})"
