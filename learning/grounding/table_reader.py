"""Reading a sentence about a table with what is counted of its language: what its n-grams may say, and how likely.

A hypothesis of K lends a word a meaning until it was read; from then on readings say what it means (P(δ | v), eq. 5.2).
"""

import math
from collections.abc import Mapping

from learning.concept_id import ACTION_SPACE, REFERENCE, Concept
from learning.grammar.pcfg import Pcfg
from learning.grammar.table_chart import END, TableChart, WordUse
from learning.grounding.evidence import LEAST_USE, MAINLY, SURELY, UNMEASURED, Evidence
from learning.grounding.joined_words import JoinedWords
from learning.grounding.ngrams import ngrams_of
from learning.grounding.table_scene import BESIDE, TableScene

PRIOR = 2.0
"""How many readings a hypothesis of strength 1 is worth before any came."""
NEW_WORD = 0.02
"""Probability of any one n-gram that a concept was never called,"""
LONGER = 0.1
"""and this times less for every further word."""
NEW_RULE = 0.3
"""What every rule counts that was never used."""
POSSIBLE = 12
"""Rules of an element that are possible, used or not."""
PASSED = math.log(0.4)
"""Log probability that one more word is passed over before the next that means something."""
PRIOR_JUNCTURES = 4.0
"""How many words passed over between two parts what is passed over anywhere is worth."""
RELATING = {REFERENCE: 0.3, BESIDE: 0.05}
"""Probability of any one word to have such a meaning, until it had."""
UNSEEN = math.log(0.1)
"""Log probability that a thing of which it was not seen what it is like is what a word says."""
LEAST_RULE = 0.02
"""No rule is less likely: what was learned first must not shut out what comes later."""


class TableReader:
    """Weighs the ways to read the sentences of one language."""

    def __init__(self, evidence: Evidence, joined: JoinedWords, grammar: Pcfg, junctures: Pcfg) -> None:
        """Use these; they are read anew at every call.

        Args:
            evidence: What n-grams may mean.
            joined: How often words were heard.
            grammar: Rules of elements, and how often each element was said by each n-gram.
            junctures: Place between two parts to what is passed over there.
        """
        self._evidence = evidence
        self._joined = joined
        self._grammar = grammar
        self._junctures = junctures
        self._weights: dict[tuple[str, tuple[str, ...]], float] = {}

    def chart(self, pieces: tuple[str, ...], scene: TableScene | None) -> TableChart:
        """All readings of a sentence, of which those count that do in a scene what was shown, where one is given."""
        self._weights.clear()
        uses = self._uses(pieces, scene)
        return TableChart(pieces, uses, self._skip(pieces), self._rule_weight, self._juncture_weight, scene)

    def _uses(self, pieces: tuple[str, ...], scene: TableScene | None) -> list[WordUse]:
        """Ways to read the n-grams of a sentence: hypotheses, and what they were read as before."""
        uses = []
        possible = None if scene is None else _possible(scene)
        outdone = set() if scene is None else self._evidence.outdone(pieces)
        for ngram, spans in ngrams_of(pieces).items():
            if not self._evidence.coheres(ngram):
                continue
            known = self._evidence.readings(ngram)
            lent = self._evidence.hypotheses.get(ngram, {}) if scene is not None else {}
            concepts = {
                concept
                for concept, count in known.items()
                if concept is not None
                and count >= (LEAST_USE if scene is not None else self._evidence.least_use(ngram, concept))
            }
            concepts |= set(lent)
            if scene is not None:
                # A new word may say what was done, what the thing is like or where, as grammar expects there (7.3.3).
                concepts |= {Concept(ACTION_SPACE, scene.action)} | scene.goal
                concepts |= {each for relation in scene.goal_relations.values() for each in relation}
                if not any(concept in looks for looks in scene.looks for concept in lent):
                    concepts |= scene.looks[scene.moved]
            concepts = {
                concept
                for concept in concepts
                if (ngram, concept) not in outdone and self._evidence.borne_out(ngram, concept)
            }
            if " " not in ngram and scene is not None:
                concepts |= UNMEASURED  # a guess, which what was shown bears out or not
            if possible is not None:
                weights = {
                    concept: self._word_weight(ngram, concept, lent.get(concept, 0.0)) + self._evidence.told(concept)
                    for concept in concepts & possible
                }
            else:
                weights = self._space_weights(ngram, concepts)
            uses += [
                WordUse(first, after, concept, ngram, weight)
                for concept, weight in sorted(weights.items())
                for first, after in spans
            ]
            if scene is not None:
                for concept in sorted(self._of_the_unseen(ngram, concepts, scene)):
                    weight = self._word_weight(ngram, concept, 0.0) + UNSEEN
                    uses += [WordUse(first, after, concept, ngram, weight, True) for first, after in spans]
        return uses

    def _of_the_unseen(self, ngram: str, concepts: set[Concept], scene: TableScene) -> set[Concept]:
        """Looks that an n-gram mainly means and that nothing in a scene has that was seen well: others may."""
        row = self._evidence.readings(ngram)
        total = sum(row.values())
        return {
            concept
            for concept in concepts
            if concept.space in scene.unseen
            and row.get(concept, 0.0) >= max(SURELY, MAINLY * total)
            and not any(concept in looks for looks in scene.looks)
        }

    def _word_weight(self, ngram: str, concept: Concept, strength: float) -> float:
        """Log P(δ | v): counts, the hypothesis, and a little for any n-gram."""
        said = self._said(ngram, concept)
        total = max(0.0, self._evidence.grounding.concept_totals.get(concept, 0.0))
        new = RELATING.get(concept, NEW_WORD)
        rare = LONGER ** ngram.count(" ")
        return math.log((said + (PRIOR * strength + new) * rare) / (total + PRIOR + 1.0))

    def _space_weights(self, ngram: str, concepts: set[Concept]) -> dict[Concept, float]:
        """Without a scene: for each space the concept that the n-gram means most, with log P(δ | space)."""
        best: dict[str, tuple[float, Concept]] = {}
        said: dict[str, float] = {}
        for concept in sorted(concepts):
            count = self._said(ngram, concept)
            said[concept.space] = said.get(concept.space, 0.0) + count
            best[concept.space] = max(best.get(concept.space, (-1.0, concept)), (count, concept))
        new = NEW_WORD * LONGER ** ngram.count(" ") * 0.1
        return {
            concept: math.log((said[space] + new) / (max(0.0, self._grammar.total(space)) + 1.0))
            for space, (_, concept) in best.items()
        }

    def _said(self, ngram: str, concept: Concept | None) -> float:
        """How often an n-gram was read as a concept, or passed over."""
        return max(0.0, self._evidence.readings(ngram).get(concept, 0.0))

    def _skip(self, pieces: tuple[str, ...]) -> list[float]:
        """Log probability of each piece as one that is passed over."""
        return [PASSED + math.log(self._passed(piece)) for piece in pieces]

    def _passed(self, piece: str) -> float:
        """Probability of a piece among all that are passed over."""
        total = max(0.0, self._evidence.grounding.concept_totals.get(None, 0.0))
        passed = self._said(piece, None)
        usual = (self._joined.counts.get(piece, 0.0) + 0.5) / (self._joined.total + 1.0)
        return (passed + usual) / (total + 1.0)

    def _juncture_weight(self, place: str, pieces: tuple[str, ...]) -> float:
        """Log probability of passing over some pieces, and no more, in a place between two parts."""
        row: Mapping[str, float] = self._junctures.terminals.get(place, {})
        total = max(0.0, self._junctures.total(place)) + PRIOR_JUNCTURES
        going_on = math.exp(PASSED)
        weight = math.log((max(0.0, row.get(END, 0.0)) + PRIOR_JUNCTURES * (1.0 - going_on)) / total)
        for piece in pieces:
            weight += math.log(
                (max(0.0, row.get(piece, 0.0)) + PRIOR_JUNCTURES * going_on * self._passed(piece)) / total
            )
        return weight

    def _rule_weight(self, left: str, right: tuple[str, ...]) -> float:
        known = self._weights.get((left, right))
        if known is None:
            row: Mapping[tuple[str, ...], float] = self._grammar.rules.get(left, {})
            total = sum(max(0.0, count) for count in row.values())
            share = (max(0.0, row.get(right, 0.0)) + NEW_RULE) / (total + POSSIBLE * NEW_RULE)
            known = self._weights[left, right] = math.log(max(share, LEAST_RULE))
        return known


def _possible(scene: TableScene) -> set[Concept]:
    """Concepts that something in a scene can be said to be."""
    found = {Concept(ACTION_SPACE, part) for part in scene.parts} | {REFERENCE} | scene.goal
    for concepts in (*scene.looks, *scene.places, *scene.relations.values(), *scene.goal_relations.values()):
        found |= concepts
    return found
