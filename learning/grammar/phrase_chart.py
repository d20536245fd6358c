"""Bottom-up chart over the content words of a sentence: phrases and what they denote in the scene.

Every phrase denotes something that exists: what denotes nothing is dropped at once. Phrases of one label, span and
meaning differ only in how they came about, and the best alone is kept. A lexical phrase may take in words after it that
are passed over, so that composed phrases always touch.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import cast

from learning.concept_id import ACTION_SPACE, Concept
from learning.grammar.board_elements import BoardElements
from learning.grammar.description import Description, Sense, fits, senses
from learning.grammar.innate import ABOVE, BESIDE, NEAREST, NEAREST_ONE, SIDES, UNIT, WITHIN
from learning.grammar.phrase import Feature, Phrase

JOINED = ("action", "relation", "word", "heading")
"""Labels of lexical phrases that words in a row may make up together."""
PLACING = (ABOVE, WITHIN, BESIDE)
"""Relations that a word for a side may be said with: "on the left of", "in front of" are that side alone."""
MAX_PASSED = 3
"""Most words in a row that are passed over inside a phrase."""
BEAMS = {"word": 8, "relation": 5, "heading": 4, "number": 3, "unit": 2, "action": 4}
BEAM = 5
"""Phrases kept of one label over one span."""
IN_VAIN: Feature = ("ranked", "in vain")
"""Of an entity with a rank or side that rules nothing out."""
GAP = 6.0
"""A phrase this much worse than the best of its label and span is dropped."""


@dataclass(frozen=True, slots=True)
class Use:
    """One way to read a run of words.

    Attributes:
        first: Position of the first word.
        after: Position after the last.
        concept: What it means.
        score: Weight of reading it so.
        features: Features that the weight is made of.
        ngram: The words.
        following: The word after them in the sentence, "" when that is not told.
    """

    first: int
    after: int
    concept: Concept
    score: float
    features: tuple[Feature, ...]
    ngram: str
    following: str = ""


@dataclass(frozen=True, slots=True)
class Modifier:
    """Meaning of a modifier: in which relation to which elements; or so many steps to one side of them.

    Attributes:
        relation: Relation or side.
        ground: Elements, as a mask; 0 for a shift from where the moved thing stands.
        nearest: Whether the nearest of `ground` is meant.
        steps: Number of steps, 0 for a plain relation.
    """

    relation: Concept
    ground: int
    nearest: bool = False
    steps: int = 0


Denotation = tuple[int, bool, bool]
"""Meaning of an entity: elements, whether the nearest of them is meant, whether it is what was spoken of before."""
Cell = dict[str, list[Phrase]]


class PhraseChart:
    """All phrases of a sentence in a scene."""

    def __init__(
        self,
        length: int,
        uses: Sequence[Use],
        passed: Sequence[float],
        weight: Callable[[Feature], float],
        scene: BoardElements,
        senses_of: dict[Description, list[Sense]] | None = None,
    ) -> None:
        """Fill the chart.

        Args:
            length: Number of words.
            uses: Lexical entries.
            passed: Weight of passing over each word, (length,).
            weight: Weight of a feature.
            scene: What there is.
            senses_of: Senses of descriptions in this scene known from other sentences about it; added to.
        """
        self.length = length
        self.scene = scene
        self._weight = weight
        self._senses = {} if senses_of is None else senses_of
        self.passed = [0.0]
        for cost in passed:
            self.passed.append(self.passed[-1] + cost)
        self.cells: list[list[Cell | None]] = [[None] * (length + 1) for _ in range(length + 1)]
        lexical: dict[tuple[int, int], list[Phrase]] = {}
        for use in uses:
            for phrase in self._lexical(use):
                lexical.setdefault((phrase.first, phrase.after), []).append(phrase)
        for width in range(1, length + 1):
            for first in range(length - width + 1):
                self._fill(first, first + width, lexical.get((first, first + width), []))

    def _lexical(self, use: Use) -> list[Phrase]:
        concept = use.concept
        space = concept.space
        labels: tuple[str, ...]
        if space == ACTION_SPACE:
            labels = ("action",)
        elif concept == NEAREST:
            # "The block nearest to the corner", "the nearest block": one measure, in two places of a sentence.
            labels = ("relation", "word")
        elif space == "relation":
            labels = ("relation",)
        elif space == "side":
            labels = ("word", "relation", "heading")
        elif space == "count":
            labels = ("word", "number")
        elif concept == UNIT:
            labels = ("unit",)
        else:
            labels = ("word",)
        found = []
        used = tuple(range(use.first, use.after))
        for label in labels:
            meaning = NEAREST_ONE if label == "word" and concept == NEAREST else concept
            score, features = use.score, use.features
            if len(labels) > 1:
                extra: tuple[Feature, ...] = (("used", use.ngram, label), ("used", space, label))
                if use.following:
                    # "On the left block" or "on the left of the block": the next word tells.
                    extra = (*extra, ("followed", label, use.following))
                score += sum(map(self._weight, extra))
                features = (*features, *extra)
            for after in range(use.after, min(use.after + MAX_PASSED, self.length) + 1):
                gap = self.passed[after] - self.passed[use.after]
                found.append(Phrase(label, use.first, after, score + gap, meaning, features, (), meaning, used))
        return found

    def _fill(self, first: int, after: int, lexical: list[Phrase]) -> None:
        found: dict[tuple[str, object], Phrase] = {}
        for phrase in lexical:
            _keep(found, phrase)
        row = self.cells[first]
        for middle in range(first + 1, after):
            left = row[middle]
            if left is None:
                continue
            right = self.cells[middle][after]
            if right is not None:
                self._join(found, left, right)
        if not found:
            return
        for phrase in [p for (label, _), p in found.items() if label == "word"]:
            if phrase.concept is not None:
                _keep(
                    found,
                    Phrase(
                        "description",
                        first,
                        after,
                        phrase.score,
                        frozenset((phrase.concept,)),
                        (),
                        (phrase,),
                    ),
                )
        descriptions = _best([p for (label, _), p in found.items() if label == "description"], BEAM)
        for phrase in descriptions:
            self._close(found, phrase)
        cell: Cell = {}
        for (label, _), phrase in found.items():
            if label != "description":
                cell.setdefault(label, []).append(phrase)
        for label, phrases in cell.items():
            cell[label] = _best(phrases, BEAMS.get(label, BEAM))
        if descriptions:
            cell["description"] = descriptions
        row[after] = cell

    def _join(self, found: dict[tuple[str, object], Phrase], left: Cell, right: Cell) -> None:
        for label in JOINED:
            nexts = right.get(label)
            if nexts:
                for phrase in left.get(label, ()):
                    for following in nexts:
                        if phrase.concept == following.concept:
                            self._merge(found, phrase, following)
                        elif label == "relation" and phrase.concept in PLACING and following.concept in SIDES:
                            self._merge(found, phrase, following, "relation to a side")
        words = right.get("word")
        if words:
            for whole in left.get("description", ()):
                self._describe(found, whole, words)
        entities = right.get("entity")
        if entities:
            for relation in left.get("relation", ()):
                for ground in entities:
                    self._relate(found, relation, ground, (relation, ground), "before")
            for shift in left.get("shift", ()):
                for ground in entities:
                    self._anchor(found, shift, ground)
        modifiers = right.get("modifier")
        if modifiers:
            for whole in left.get("entity", ()):
                for modifier in modifiers:
                    self._restrict(found, whole, modifier)
        units = right.get("unit")
        if units:
            for number in left.get("number", ()):
                for unit in units:
                    _keep(found, self._phrase("measure", (number, unit), number.concept, ()))
        headings = right.get("heading")
        if headings:
            for measure in left.get("measure", ()):
                for heading in headings:
                    self._shift(found, measure, heading, (measure, heading))
        measures = right.get("measure")
        if measures:
            for heading in left.get("heading", ()):
                for measure in measures:
                    self._shift(found, measure, heading, (heading, measure))

    def _merge(self, found: dict[tuple[str, object], Phrase], left: Phrase, right: Phrase, how: str = "") -> None:
        """Make one phrase of words in a row, of one meaning ("pick up"), or relation and side ("on the left")."""
        feature: Feature = ("joined", how or (left.concept.space if left.concept else ""))
        merged = Phrase(
            left.label,
            left.first,
            right.after,
            left.score + right.score + self._weight(feature),
            right.meaning,
            (*left.features, *right.features, feature),
            (),
            right.concept,
            (*left.used, *right.used),
        )
        _keep(found, merged)

    def _phrase(
        self, label: str, children: tuple[Phrase, ...], meaning: object, features: tuple[Feature, ...]
    ) -> Phrase:
        score = 0.0
        for child in children:
            score += child.score
        for feature in features:
            score += self._weight(feature)
        return Phrase(label, children[0].first, children[-1].after, score, meaning, features, children)

    def _describe(self, found: dict[tuple[str, object], Phrase], whole: Phrase, words: list[Phrase]) -> None:
        description = cast(Description, whole.meaning)
        before = whole.children[-1].concept
        for word in words:
            concept = word.concept
            if concept is None or before is None or not fits(description, concept):
                continue
            more = description | {concept}
            features: tuple[Feature, ...] = (("order", before.space, concept.space),)
            score = whole.score + word.score + self._weight(features[0])
            key = ("description", more)
            known = found.get(key)
            if known is None or known.score < score:
                found[key] = Phrase(
                    "description",
                    whole.first,
                    word.after,
                    score,
                    more,
                    (*whole.features, *features),
                    (*whole.children, word),
                )

    def _close(self, found: dict[tuple[str, object], Phrase], phrase: Phrase) -> None:
        description = cast(Description, phrase.meaning)
        known = self._senses.get(description)
        if known is None:
            known = self._senses[description] = senses(description, self.scene)
        ranks: tuple[Feature, ...] = tuple(("ranked", str(each)) for each in description if each.space == "rank")
        for sense in known:
            features: tuple[Feature, ...] = (("sense", sense.feature), *ranks)
            if sense.idle:
                features = (*features, IN_VAIN)
            score = phrase.score + sum(map(self._weight, features))
            denotation = (sense.elements, sense.nearest, sense.refers)
            features = (*phrase.features, *features)
            _keep(
                found,
                Phrase("entity", phrase.first, phrase.after, score, denotation, features, phrase.children),
            )

    def _relate(
        self,
        found: dict[tuple[str, object], Phrase],
        relation: Phrase,
        ground: Phrase,
        children: tuple[Phrase, Phrase],
        order: str,
    ) -> None:
        concept = relation.concept
        elements, nearest, refers = cast(Denotation, ground.meaning)
        if concept is None or refers:
            return
        is_place = elements & self.scene.places
        kind = "place" if is_place else "thing" if elements & self.scene.blocks else "collective"
        features: tuple[Feature, ...] = (("relation", str(concept), kind), ("relation", order))
        _keep(found, self._phrase("modifier", children, Modifier(concept, elements, nearest), features))

    def _anchor(self, found: dict[tuple[str, object], Phrase], shift: Phrase, ground: Phrase) -> None:
        meaning = cast(Modifier, shift.meaning)
        elements, nearest, refers = cast(Denotation, ground.meaning)
        if meaning.ground or refers or not elements & self.scene.things:
            return
        anchored = Modifier(meaning.relation, elements & self.scene.things, nearest, meaning.steps)
        _keep(found, self._phrase("shift", (shift, ground), anchored, (("shift", "anchored"),)))

    def _restrict(self, found: dict[tuple[str, object], Phrase], whole: Phrase, modifier: Phrase) -> None:
        head, nearest, refers = cast(Denotation, whole.meaning)
        meaning = cast(Modifier, modifier.meaning)
        if refers:
            return
        ground = meaning.ground
        if meaning.nearest:
            ground = self.scene.nearest_to_robot(ground)
        variants = self.scene.related(meaning.relation, ground, head)
        for number, elements in enumerate(variants):
            features: list[Feature] = [("modified", str(meaning.relation))]
            if elements == head:
                features.append(("modified", "in vain"))
            elif nearest and not self.scene.open_to_choice(elements):
                features.append(IN_VAIN)
            if number:
                features.append(("modified", f"variant {number}"))
            if len(whole.children) and whole.children[-1].label == "modifier":
                features.append(("modified", "again"))
            _keep(found, self._phrase("entity", (whole, modifier), (elements, nearest, False), tuple(features)))

    def _shift(
        self,
        found: dict[tuple[str, object], Phrase],
        measure: Phrase,
        heading: Phrase,
        children: tuple[Phrase, Phrase],
    ) -> None:
        number = cast(Concept, measure.meaning)
        if heading.concept is None:
            return
        meaning = Modifier(heading.concept, 0, False, number.number)
        _keep(found, self._phrase("shift", children, meaning, (("shift", children[0].label),)))


def _keep(found: dict[tuple[str, object], Phrase], phrase: Phrase) -> None:
    key = (phrase.label, phrase.meaning)
    known = found.get(key)
    if known is None or known.score < phrase.score:
        found[key] = phrase


def _best(phrases: list[Phrase], count: int) -> list[Phrase]:
    if len(phrases) > 1:
        phrases.sort(key=_score, reverse=True)
        lowest = phrases[0].score - GAP
        phrases = [phrase for phrase in phrases[:count] if phrase.score >= lowest]
    return phrases


def _score(phrase: Phrase) -> float:
    return phrase.score
