"""What is known of one language: K, Φ and Π, learned from sentences about what was shown at a table.

A demo's sentences are first counted in K (eq. 4.1); an integer program and case analysis pick hypotheses (4.2 to 4.6);
then all readings of each sentence that do in the scene what was shown are weighed by words (P(δ | v), eq. 5.2) and
rules, and words and rules are counted by how much they are expected: online EM (thesis 7.2.2) in its incremental form
(Neal and Hinton 1998). A bounded number of recent sentences is read again later, when more is known, and what they
counted before is taken back; all older counts stay. Words that no reading needs gather weight as meaning nothing, so
function words come out without a meaning (habituation, 4.9.4).
"""

import math
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from learning.concept_id import ACTION_SPACE, REFERENCE, Concept
from learning.grammar.pcfg import Pcfg
from learning.grammar.rcl import RclNode
from learning.grammar.table_chart import END, Expected, Rule, TableChart, WordUse
from learning.grounding.correlation import CorrelationMatrix, wilson
from learning.grounding.grounding import Grounding
from learning.grounding.hypotheses import supposed
from learning.grounding.integer_program import Pair
from learning.grounding.joined_words import JoinedWords
from learning.grounding.ngrams import ngrams_of, parts_of
from learning.grounding.saved_correlation import packed, unpacked
from learning.grounding.table_scene import BESIDE, NAMED, OVER, TableRecord, TableScene

MEMORY = 1200
"""Sentences that are kept with their scenes to be read again."""
AGAIN = 15
"""Of those, so many are read again after each demo."""
LEAST_STRENGTH = 0.08
"""Pairs with a weaker correlation are no hypotheses."""
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
LEAST_USE = 0.3
"""Readings that a meaning needs to be tried where it is no hypothesis."""
LEAST_LIFT = 1.5
"""A meaning must go with its n-gram so much more often than with any that are about the same feature space,"""
FEW_TIMES = 4
"""once that was heard so many times."""
LEAST_TRUE = 0.25
"""and what it means must be there so often when something of that feature space is,"""
ACTION_LIFT = 2.0
"""For actions so much more often, as moving goes with words about places;"""
FIRST_SENTENCES = 30
"""Sentences before it is known what is usual."""
MEASURED = 0.3
"""An n-gram that goes with a concept so strongly has no meaning of another kind."""
RAREST = 0.05
"""No concept tells more than one that is salient so seldom."""
LEAST_RULE = 0.02
"""No rule is less likely: what was learned first must not shut out what comes later."""
OF_ACTIONS = 0.5
"""except that an n-gram that mostly says an action may say any that goes with it"""
LEAST_ACTION = 0.1
"""so often."""
COHESION = 0.7
"""Words mean something together where each of them comes with the others so often."""
ANY = "any "
"""Before the name of a feature space: the pseudo-concept in K that anything of that space is salient."""
UNMEASURED = frozenset((REFERENCE, BESIDE))
"""Kinds of meaning that are always at hand, so that K says nothing of them; only readings do."""
RELATING = {REFERENCE: 0.3, BESIDE: 0.05}
"""Probability of any one word to have such a meaning, until it had."""
UNSEEN = math.log(0.1)
"""Log probability that a thing of which it was not seen what it is like is what a word says"""
SURELY, MAINLY = 3.0, 0.5
"""that was read so often, and so much of all times, as that."""
LONGEST_SENTENCE = 60
"""Longer sentences are not read."""
LEAST_MEANING = 0.12
"""A meaning that an n-gram has less often is none,"""
LEAST_SPACE = 0.2
"""nor one in a feature space that it is read in less often,"""
LEAST_HEARD = 0.9
"""nor one that was read less often."""


@dataclass(slots=True, eq=False)
class Heard:
    """A sentence that is kept for a while.

    Attributes:
        words: Its words.
        record: What was shown.
        scene: The same in symbols.
        counted: What it counted when it was read last.
    """

    words: tuple[str, ...]
    record: TableRecord
    scene: TableScene
    counted: Expected | None = None


class Tongue:
    """K, Φ and Π of one language."""

    def __init__(self) -> None:
        """Start without a word."""
        self.joined = JoinedWords()
        self.correlation = CorrelationMatrix()
        self.grounding = Grounding()
        self.grammar = Pcfg()
        self.junctures = Pcfg()
        self._memory: deque[Heard] = deque()
        self._hypotheses: dict[str, dict[Concept, float]] = {}
        self._weights: dict[tuple[str, tuple[str, ...]], float] = {}
        self._kinds: dict[Concept, tuple[float, float]] = {}

    def learn(self, sentences: Iterable[tuple[str, ...]], record: TableRecord, scene: TableScene) -> int:
        """Learn from all sentences about one demo; returns how many could be read so that they do what was shown."""
        heard = [Heard(words, record, scene) for words in sentences if 0 < len(words) <= LONGEST_SENTENCE]
        for each in heard:
            self.joined.hear(each.words)
        salient = scene.salient() - UNMEASURED
        for each in heard:
            self.correlation.observe(ngrams_of(self.joined.split(each.words)[0]), _with_spaces(salient))
        self._suppose({ngram for each in heard for ngram in ngrams_of(self.joined.split(each.words)[0])}, salient)
        read = sum(self._read(each) for each in heard)
        self._memory.extend(heard)
        while len(self._memory) > MEMORY:
            self._memory.popleft()
        for _ in range(min(AGAIN, len(self._memory) - len(heard))):
            self._read(self._memory[0])
            self._memory.rotate(-1)
        return read

    def settle(self) -> None:
        """Read all that is kept in memory again."""
        for each in self._memory:
            self._read(each)

    def refresh(self, scene_of: Callable[[TableRecord], TableScene]) -> None:
        """Put all that is kept in memory into symbols again, as concepts have changed, and count it anew in K."""
        scenes: dict[int, TableScene] = {}
        changed: dict[int, set[str]] = {}
        for each in self._memory:
            if id(each.record) not in scenes:
                scenes[id(each.record)] = scene_of(each.record)
            before, each.scene = each.scene, scenes[id(each.record)]
            old, new = before.salient() - UNMEASURED, each.scene.salient() - UNMEASURED
            if old != new:
                ngrams = set(ngrams_of(self.joined.split(each.words)[0]))
                _recount(self.correlation, ngrams, _with_spaces(old), _with_spaces(new))
                changed.setdefault(id(each.record), set()).update(ngrams)
        for record, ngrams in changed.items():
            self._suppose(ngrams, scenes[record].salient() - UNMEASURED)

    def parse(self, words: tuple[str, ...], scene: TableScene | None = None) -> RclNode | None:
        """The most likely tree of a sentence over its words counted from 1; None where it cannot be read.

        Args:
            words: The sentence.
            scene: What was shown, if the tree must do that there.
        """
        if not 0 < len(words) <= LONGEST_SENTENCE:
            return None
        pieces, origin = self.joined.split(words)
        tree = self._chart(pieces, scene).best()
        return None if tree is None else _over_words(tree, origin)

    def heard_lately(self, count: int) -> Iterator[tuple[tuple[str, ...], tuple[int, ...], RclNode | None]]:
        """The last so many sentences in memory: pieces, the word that each belongs to, and how they are read now.

        The order of memory does not matter: sentences that are read again go to its end.
        """
        for each in list(self._memory)[max(0, len(self._memory) - count) :] if count > 0 else ():
            pieces, origin = self.joined.split(each.words)
            yield pieces, origin, self._chart(pieces, each.scene).best()

    def name_of_thing(self, words: tuple[str, ...], space: str) -> str | None:
        """The n-gram by which a sentence tells what the thing that it is about is like, in one space of looks."""
        if not 0 < len(words) <= LONGEST_SENTENCE:
            return None
        pieces, _ = self.joined.split(words)
        tree = self._chart(pieces, None).best()
        if tree is None:
            return None
        event = tree.children[0] if tree.label == "sequence" else tree
        thing = next((child for child in event.children if child.label == "entity"), None)
        leaf = next((each for each in thing.children if each.label == space), None) if thing is not None else None
        return None if leaf is None else " ".join(pieces[leaf.first - 1 : leaf.last])

    def meanings(self, ngram: str) -> dict[Concept, float]:
        """What an n-gram means: concepts with Φ, the share of its readings; empty for a function word."""
        pieces, _ = self.joined.split(tuple(ngram.split(" ")))
        found: dict[Concept, float] = {}
        for known in {" ".join(pieces), *pieces} if " " not in ngram else {" ".join(pieces)}:
            row = self._readings(known)
            total = sum(row.values())
            if not self._coheres(known):
                continue
            for concept, count in row.items():
                if concept is None or count < LEAST_HEARD or count < LEAST_MEANING * total:
                    continue
                if self._share_of_space(known, concept.space) >= LEAST_SPACE and self._borne_out(known, concept):
                    found[concept] = max(found.get(concept, 0.0), count / total)
        return found

    def rename(self, old: Concept, new: Concept) -> None:
        """Carry over all that was learned of a concept that turned out to be another."""
        self.correlation.rename(old, new)
        self.grounding.rename(old, new)
        for right, count in list(self.grammar.rules.get(str(old), {}).items()):
            self.grammar.add_rule(str(new), right, count)
            self.grammar.add_rule(str(old), right, -count)
        for each in self._memory:
            if each.counted is not None:
                uses: dict[tuple[str, Concept], float] = {}
                for (ngram, concept), share in each.counted.uses.items():
                    pair = ngram, new if concept == old else concept
                    uses[pair] = uses.get(pair, 0.0) + share
                rules: dict[Rule, float] = {}
                for (left, right), share in each.counted.rules.items():
                    rule = str(new) if left == str(old) else left, right
                    rules[rule] = rules.get(rule, 0.0) + share
                each.counted = replace(each.counted, uses=uses, rules=rules)

    def to_json(self) -> dict[str, Any]:
        """Plain numbers, lists and strings; sentences in memory are not kept, nor what in K is no more than chance."""
        correlation = self.correlation.to_json()
        ngrams: dict[str, list[Any]] = {}
        for ngram, entry in sorted(correlation["ngrams"].items(), key=lambda one: one[0].count(" ")):
            if all(part in ngrams for part in parts_of(ngram)) and self._coheres(ngram) and self._is_saved(ngram):
                ngrams[ngram] = entry
        correlation["ngrams"] = dict(sorted(ngrams.items()))
        grammar = self.grammar.to_json()
        return {
            "words": self.joined.to_json(),
            "correlation": packed(correlation, ANY, self._kept),
            "grounding": self.grounding.to_json(),
            "rules": grammar["rules"],
            "junctures": self.junctures.to_json()["terminals"],
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "Tongue":
        """Rebuild; raises KeyError, TypeError, ValueError or AttributeError for what `to_json` did not write."""
        tongue = cls()
        tongue.joined = JoinedWords.from_json(data["words"])
        tongue.correlation = CorrelationMatrix.from_json(unpacked(data["correlation"]))
        tongue.grounding = Grounding.from_json(data["grounding"])
        rules = data["rules"] if "rules" in data else data["grammar"]["rules"]  # older files
        tongue.grammar = Pcfg.from_json({"rules": rules, "terminals": {}})
        for ngram, row in tongue.grounding.counts.items():
            for concept, count in row.items():
                if concept is not None:
                    tongue.grammar.add_terminal(concept.space, ngram, count)
        tongue.junctures = Pcfg.from_json({"rules": {}, "terminals": data.get("junctures", {})})
        return tongue

    def _kept(self, ngram: str, concept: Concept) -> bool:
        """Whether a count of K is saved: that of a pair that was read, or that goes together far beyond chance."""
        if round(self._readings(ngram).get(concept, 0.0), 3) >= LEAST_USE:
            return True
        return self.correlation.strength_beyond_chance(ngram, concept) >= MEASURED

    def _is_saved(self, ngram: str) -> bool:
        """Whether an n-gram is saved: any word, and longer ones of which something is."""
        row: Mapping[Concept, float] = self.correlation.joint_counts.get(ngram, {})
        return " " not in ngram or any(self._kept(ngram, concept) for concept in list(row) if ANY not in concept.space)

    def _suppose(self, ngrams: set[str], salient: frozenset[Concept]) -> None:
        """Select (4.2) and filter (4.3 to 4.6) hypotheses for the n-grams of a demo and its salient concepts."""
        strengths: dict[Pair, float] = {}
        for ngram in sorted(ngrams):
            for concept in sorted(salient):
                strength = self.correlation.strength_beyond_chance(ngram, concept)
                strengths[ngram, concept] = strength if strength >= LEAST_STRENGTH else 0.0
                self._hypotheses.get(ngram, {}).pop(concept, None)
        for (ngram, concept), strength in supposed(strengths).items():
            self._hypotheses.setdefault(ngram, {})[concept] = strength

    def _read(self, heard: Heard) -> bool:
        """Read a sentence with what is known now, and count that in the place of what it counted before."""
        if heard.counted is not None:
            self._count(heard.counted, -1.0)
        pieces, _ = self.joined.split(heard.words)
        heard.counted = self._chart(pieces, heard.scene).expected()
        if heard.counted is None:
            return False
        self._count(heard.counted, 1.0)
        return True

    def _count(self, expected: Expected, sign: float) -> None:
        for (ngram, concept), share in expected.uses.items():
            self.grounding.add(ngram, concept, sign * share)
            self.grammar.add_terminal(concept.space, ngram, sign * share)
        for piece, share in expected.passed.items():
            self.grounding.add(piece, None, sign * share)
        for (left, right), share in expected.rules.items():
            self.grammar.add_rule(left, right, sign * share)
        for (place, piece), share in expected.junctures.items():
            self.junctures.add_terminal(place, piece, sign * share)

    def _chart(self, pieces: tuple[str, ...], scene: TableScene | None) -> TableChart:
        self._weights.clear()
        uses = self._uses(pieces, scene)
        return TableChart(pieces, uses, self._skip(pieces), self._rule_weight, self._juncture_weight, scene)

    def _uses(self, pieces: tuple[str, ...], scene: TableScene | None) -> list[WordUse]:
        """Ways to read the n-grams of a sentence: hypotheses, and what they were read as before."""
        uses = []
        possible = None if scene is None else _possible(scene)
        for ngram, spans in ngrams_of(pieces).items():
            if not self._coheres(ngram):
                continue
            known = self._readings(ngram)
            lent = self._hypotheses.get(ngram, {}) if scene is not None else {}
            concepts = {
                concept
                for concept, count in known.items()
                if concept is not None
                and count >= (LEAST_USE if scene is not None else self._least_use(ngram, concept))
            }
            concepts |= set(lent)
            if scene is not None:
                # A new word may say what was done, what the thing is like or where, as grammar expects there (7.3.3).
                concepts |= {Concept(ACTION_SPACE, scene.action)} | scene.goal
                concepts |= {each for relation in scene.goal_relations.values() for each in relation}
                if not any(concept in looks for looks in scene.looks for concept in lent):
                    concepts |= scene.looks[scene.moved]
            concepts = {concept for concept in concepts if self._borne_out(ngram, concept)}
            if " " not in ngram and scene is not None:
                concepts |= UNMEASURED  # a guess, which what was shown bears out or not
            if possible is not None:
                weights = {
                    concept: self._word_weight(ngram, concept, lent.get(concept, 0.0)) + self._told(concept)
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
        row = self._readings(ngram)
        total = sum(row.values())
        return {
            concept
            for concept in concepts
            if concept.space in scene.unseen
            and row.get(concept, 0.0) >= max(SURELY, MAINLY * total)
            and not any(concept in looks for looks in scene.looks)
        }

    def _borne_out(self, ngram: str, concept: Concept) -> bool:
        """Whether K, once it has seen enough, has the n-gram go with the concept at all."""
        matrix = self.correlation
        if concept in UNMEASURED:
            return max(self._hypotheses.get(ngram, {}).values(), default=0.0) < MEASURED
        if concept == OVER and self._mostly_passed(ngram) and not self._everywhere(ngram):
            return True  # "in" is heard with corners and fronts, too: only readings tell where it says more than they
        heard, every = matrix.ngram_counts.get(ngram, 0.0), _any_like(concept)
        usual = self._usual(concept)
        if matrix.demos > FIRST_SENTENCES and usual > 1.0 / LEAST_LIFT:
            return False  # what is true of nearly everything tells nothing
        if heard < FEW_TIMES:
            return True
        row = matrix.joint_counts[ngram]
        share = row.get(concept, 0.0) / max(row.get(every, 0.0), 1.0)
        if concept.space == ACTION_SPACE and self._share_of_space(ngram, ACTION_SPACE) < OF_ACTIONS:
            return share >= ACTION_LIFT * usual
        if concept.space == ACTION_SPACE:
            return share >= LEAST_ACTION
        sure = wilson(row.get(concept, 0.0), row.get(every, 0.0), self._by_chance(every)) > usual
        return sure and share >= max(LEAST_TRUE, LEAST_LIFT * usual)

    def _everywhere(self, ngram: str) -> bool:
        """Whether an n-gram is said in nearly all sentences, so that it tells nothing."""
        matrix = self.correlation
        heard = matrix.ngram_counts.get(ngram, 0.0)
        return matrix.demos > FIRST_SENTENCES and heard > matrix.row_demos(ngram) / LEAST_LIFT

    def _least_use(self, ngram: str, concept: Concept) -> float:
        """Readings that a meaning needs to be tried where nothing shows whether it is right.

        An odd sentence may have made "the" say a relation once, as another word was misspelt; that is no meaning of it.
        """
        return SURELY if concept == OVER and self._mostly_passed(ngram) else LEAST_USE

    def _mostly_passed(self, ngram: str) -> bool:
        """Whether an n-gram was passed over in most of its uses, so that K tells of its neighbours more than of it."""
        row = self._readings(ngram)
        return " " not in ngram and row.get(None, 0.0) > MAINLY * sum(row.values())

    def _told(self, concept: Concept) -> float:
        """Log of how much likelier what is shown becomes when it is said: the rarer a concept is, the more it tells.

        A word that is passed over tells nothing of what is shown, and one that has a meaning must be worth that.
        """
        return 0.0 if concept in UNMEASURED else -math.log(min(1.0, max(self._usual(concept), RAREST)))

    def _usual(self, concept: Concept) -> float:
        """How often a concept is salient when anything of its feature space is."""
        counts = self.correlation.concept_counts
        return counts.get(concept, 0.0) / max(counts.get(_any_like(concept), 0.0), 1.0)

    def _by_chance(self, every: Concept) -> float:
        """Standard errors by which the best of all meanings of one kind exceeds its share by chance."""
        known = self._kinds.get(every)
        if known is None or known[0] != self.correlation.demos:
            count = sum(1 for concept in self.correlation.concept_counts if _any_like(concept) == every)
            known = self._kinds[every] = self.correlation.demos, math.sqrt(2.0 * math.log(max(count, 2)))
        return known[1]

    def _readings(self, ngram: str) -> Mapping[Concept | None, float]:
        """How often an n-gram was read as what, without making an entry of one never heard."""
        row = self.grounding.counts.get(ngram)
        return {} if row is None else row

    def _share_of_space(self, ngram: str, space: str) -> float:
        """Share of an n-gram's readings that are of one feature space."""
        row = self._readings(ngram)
        total = sum(row.values())
        same = sum(
            count
            for concept, count in row.items()
            if concept is not None and concept.space.removeprefix(NAMED) == space.removeprefix(NAMED)
        )
        return same / total if total >= LEAST_HEARD else 0.0

    def _coheres(self, ngram: str) -> bool:
        """Whether the words of an n-gram belong together: its parts seldom come without the rest."""
        words = ngram.split(" ")
        counts = self.correlation.ngram_counts
        whole = counts.get(ngram, 0.0)
        if len(words) == 1:
            return True
        if whole < FEW_TIMES or not (self._coheres(" ".join(words[1:])) and self._coheres(" ".join(words[:-1]))):
            return False
        parts = counts.get(" ".join(words[1:]), whole), counts.get(" ".join(words[:-1]), whole)
        return whole >= COHESION * max(parts)

    def _word_weight(self, ngram: str, concept: Concept, strength: float) -> float:
        """Log P(δ | v): counts, the hypothesis, and a little for any n-gram."""
        said = max(0.0, self.grounding.counts[ngram][concept]) if ngram in self.grounding.counts else 0.0
        total = max(0.0, self.grounding.concept_totals.get(concept, 0.0))
        new = RELATING.get(concept, NEW_WORD)
        rare = LONGER ** ngram.count(" ")
        return math.log((said + (PRIOR * strength + new) * rare) / (total + PRIOR + 1.0))

    def _space_weights(self, ngram: str, concepts: set[Concept]) -> dict[Concept, float]:
        """Without a scene: for each space the concept that the n-gram means most, with log P(δ | space)."""
        best: dict[str, tuple[float, Concept]] = {}
        said: dict[str, float] = {}
        for concept in sorted(concepts):
            count = max(0.0, self.grounding.counts[ngram][concept]) if ngram in self.grounding.counts else 0.0
            said[concept.space] = said.get(concept.space, 0.0) + count
            best[concept.space] = max(best.get(concept.space, (-1.0, concept)), (count, concept))
        new = NEW_WORD * LONGER ** ngram.count(" ") * 0.1
        return {
            concept: math.log((said[space] + new) / (max(0.0, self.grammar.total(space)) + 1.0))
            for space, (_, concept) in best.items()
        }

    def _skip(self, pieces: tuple[str, ...]) -> list[float]:
        """Log probability of each piece as one that is passed over."""
        return [PASSED + math.log(self._passed(piece)) for piece in pieces]

    def _passed(self, piece: str) -> float:
        """Probability of a piece among all that are passed over."""
        total = max(0.0, self.grounding.concept_totals.get(None, 0.0))
        passed = max(0.0, self.grounding.counts[piece][None]) if piece in self.grounding.counts else 0.0
        usual = (self.joined.counts.get(piece, 0.0) + 0.5) / (self.joined.total + 1.0)
        return (passed + usual) / (total + 1.0)

    def _juncture_weight(self, place: str, pieces: tuple[str, ...]) -> float:
        """Log probability of passing over some pieces, and no more, in a place between two parts."""
        row: Mapping[str, float] = self.junctures.terminals.get(place, {})
        total = max(0.0, self.junctures.total(place)) + PRIOR_JUNCTURES
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
            row: Mapping[tuple[str, ...], float] = self.grammar.rules.get(left, {})
            total = sum(max(0.0, count) for count in row.values())
            share = (max(0.0, row.get(right, 0.0)) + NEW_RULE) / (total + POSSIBLE * NEW_RULE)
            known = self._weights[left, right] = math.log(max(share, LEAST_RULE))
        return known


def _recount(matrix: CorrelationMatrix, ngrams: Iterable[str], old: set[Concept], new: set[Concept]) -> None:
    """Count a sentence with other concepts than it was counted with before."""
    for concept in old - new:
        matrix.concept_counts[concept] = max(1.0, matrix.concept_counts[concept] - 1.0)  # rows may still hold it
    for concept in new - old:
        matrix.concept_counts[concept] += 1.0
    for ngram in ngrams:
        row = matrix.joint_counts.get(ngram)
        if row is None or ngram in matrix.frozen_at:
            continue
        for concept in old - new:
            row[concept] = max(0.0, row.get(concept, 0.0) - 1.0)
        for concept in new - old:
            row[concept] += 1.0


def _with_spaces(salient: Iterable[Concept]) -> set[Concept]:
    """Salient concepts, and for each of their spaces that anything of it is salient."""
    found = set(salient)
    return found | {_any_like(concept) for concept in found}


def _any_like(concept: Concept) -> Concept:
    """The pseudo-concept that anything of a concept's feature space is salient; sorts are of the space they sort."""
    space = "direction" if concept == OVER else concept.space.removeprefix(NAMED)
    return Concept(f"{ANY}{space}", 0)


def _possible(scene: TableScene) -> set[Concept]:
    """Concepts that something in a scene can be said to be."""
    found = {Concept(ACTION_SPACE, part) for part in scene.parts} | {REFERENCE} | scene.goal
    for concepts in (*scene.looks, *scene.places, *scene.relations.values(), *scene.goal_relations.values()):
        found |= concepts
    return found


def _over_words(node: RclNode, origin: tuple[int, ...]) -> RclNode:
    """A tree over pieces as one over words."""
    return RclNode(
        node.label,
        node.concept,
        origin[node.first - 1] + 1,
        origin[node.last - 1] + 1,
        tuple(_over_words(child, origin) for child in node.children),
    )
