"""What is known of one language: K, Φ and Π, learned from sentences about what was shown at a table.

A demo's sentences are first counted in K (eq. 4.1); an integer program and case analysis pick hypotheses (4.2 to 4.6);
then all readings of each sentence that do in the scene what was shown are weighed by words (P(δ | v), eq. 5.2) and
rules, and words and rules are counted by how much they are expected: online EM (thesis 7.2.2) in its incremental form
(Neal and Hinton 1998). A bounded number of recent sentences is read again later, when more is known, and what they
counted before is taken back; all older counts stay. Words that no reading needs gather weight as meaning nothing, so
function words come out without a meaning (habituation, 4.9.4).
"""

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

from learning.concept_id import Concept
from learning.grammar.pcfg import Pcfg
from learning.grammar.rcl import RclNode
from learning.grammar.table_chart import Expected, Rule
from learning.grounding.correlation import CorrelationMatrix
from learning.grounding.evidence import ANY, LEAST_HEARD, LEAST_USE, MEASURED, UNMEASURED, Evidence, with_spaces
from learning.grounding.grounding import Grounding
from learning.grounding.hypotheses import supposed
from learning.grounding.integer_program import Pair
from learning.grounding.joined_words import JoinedWords
from learning.grounding.ngrams import ngrams_of, parts_of
from learning.grounding.saved_correlation import packed, unpacked
from learning.grounding.table_reader import TableReader
from learning.grounding.table_scene import TableRecord, TableScene

MEMORY = 1200
"""Sentences that are kept with their scenes to be read again."""
AGAIN = 15
"""Of those, so many are read again after each demo."""
LEAST_STRENGTH = 0.08
"""Pairs with a weaker correlation are no hypotheses."""
LONGEST_SENTENCE = 60
"""Longer sentences are not read."""
LEAST_MEANING = 0.12
"""A meaning that an n-gram has less often is none,"""
LEAST_SPACE = 0.2
"""nor one in a feature space that it is read in less often."""


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

    def __init__(
        self,
        joined: JoinedWords | None = None,
        correlation: CorrelationMatrix | None = None,
        grounding: Grounding | None = None,
        grammar: Pcfg | None = None,
        junctures: Pcfg | None = None,
    ) -> None:
        """Go on from what was counted before; what is not given starts empty.

        Args:
            joined: How often words were heard.
            correlation: K.
            grounding: Φ.
            grammar: Π.
            junctures: Place between two parts of a sentence to what is passed over there.
        """
        self.joined = JoinedWords() if joined is None else joined
        self.correlation = CorrelationMatrix() if correlation is None else correlation
        self.grounding = Grounding() if grounding is None else grounding
        self.grammar = Pcfg() if grammar is None else grammar
        self.junctures = Pcfg() if junctures is None else junctures
        self._memory: deque[Heard] = deque()
        self._hypotheses: dict[str, dict[Concept, float]] = {}
        self._evidence = Evidence(self.correlation, self.grounding, self._hypotheses)
        self._reader = TableReader(self._evidence, self.joined, self.grammar, self.junctures)

    def learn(self, sentences: Iterable[tuple[str, ...]], record: TableRecord, scene: TableScene) -> int:
        """Learn from all sentences about one demo; returns how many could be read so that they do what was shown."""
        heard = [Heard(words, record, scene) for words in sentences if 0 < len(words) <= LONGEST_SENTENCE]
        for each in heard:
            self.joined.hear(each.words)
        salient = scene.salient() - UNMEASURED
        for each in heard:
            self.correlation.observe(self._counted_in_k(each.words), with_spaces(salient))
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
                _recount(self.correlation, self._counted_in_k(each.words), with_spaces(old), with_spaces(new))
                changed.setdefault(id(each.record), set()).update(ngrams_of(self.joined.split(each.words)[0]))
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
        tree = self._reader.chart(pieces, scene).best()
        return None if tree is None else _over_words(tree, origin)

    def heard_lately(self, count: int) -> Iterator[tuple[tuple[str, ...], tuple[int, ...], RclNode | None]]:
        """The last so many sentences in memory: pieces, the word that each belongs to, and how they are read now.

        The order of memory does not matter: sentences that are read again go to its end.
        """
        for each in list(self._memory)[max(0, len(self._memory) - count) :] if count > 0 else ():
            pieces, origin = self.joined.split(each.words)
            yield pieces, origin, self._reader.chart(pieces, each.scene).best()

    def name_of_thing(self, words: tuple[str, ...], space: str) -> str | None:
        """The n-gram by which a sentence tells what the thing that it is about is like, in one space of looks."""
        if not 0 < len(words) <= LONGEST_SENTENCE:
            return None
        pieces, _ = self.joined.split(words)
        tree = self._reader.chart(pieces, None).best()
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
            row = self._evidence.readings(known)
            total = sum(row.values())
            if not self._evidence.coheres(known):
                continue
            larger = [] if " " in ngram else self.joined.larger(ngram, known)
            for concept, count in row.items():
                if concept is None or count < LEAST_HEARD or count < LEAST_MEANING * total:
                    continue
                if any(self._evidence.denied(each, concept) for each in larger):
                    continue
                if self._evidence.share_of_space(known, concept.space) >= LEAST_SPACE and self._evidence.borne_out(
                    known, concept
                ):
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
        compounds = self.joined.compounds()
        ngrams: dict[str, list[Any]] = {}
        for ngram, entry in sorted(correlation["ngrams"].items(), key=lambda one: one[0].count(" ")):
            whole = all(part in ngrams for part in parts_of(ngram)) and self._evidence.coheres(ngram)
            if ngram in compounds or (whole and self._is_saved(ngram)):
                ngrams[ngram] = entry
        correlation["ngrams"] = dict(sorted(ngrams.items()))

        def kept(ngram: str, concept: Concept) -> bool:
            """Of a word that is taken apart also what tells whether it means what its parts mean."""
            parts = self.joined.pieces(ngram) if " " not in ngram else ngram.split(" ") if ngram in compounds else ()
            return self._kept(ngram, concept, parts)

        grammar = self.grammar.to_json()
        return {
            "words": self.joined.to_json(),
            "correlation": packed(correlation, ANY, kept),
            "grounding": self.grounding.to_json(),
            "rules": grammar["rules"],
            "junctures": self.junctures.to_json()["terminals"],
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "Tongue":
        """Rebuild; raises KeyError, TypeError, ValueError or AttributeError for what `to_json` did not write."""
        grounding = Grounding.from_json(data["grounding"])
        rules = data["rules"] if "rules" in data else data["grammar"]["rules"]  # older files
        grammar = Pcfg.from_json({"rules": rules, "terminals": {}})
        for ngram, row in grounding.counts.items():
            for concept, count in row.items():
                if concept is not None:
                    grammar.add_terminal(concept.space, ngram, count)
        return cls(
            JoinedWords.from_json(data["words"]),
            CorrelationMatrix.from_json(unpacked(data["correlation"])),
            grounding,
            grammar,
            Pcfg.from_json({"rules": {}, "terminals": data.get("junctures", {})}),
        )

    def _counted_in_k(self, words: tuple[str, ...]) -> set[str]:
        """What of a sentence K counts: n-grams of its pieces, and the words that are taken apart as they are."""
        pieces, origin = self.joined.split(words)
        apart = {words[at] for at, after in pairwise(origin) if at == after}
        return {*ngrams_of(pieces), *apart}

    def _kept(self, ngram: str, concept: Concept, parts: Iterable[str] = ()) -> bool:
        """Whether a count of K is saved: that of a pair that was read, or that goes together far beyond chance."""
        if any(round(self._evidence.readings(each).get(concept, 0.0), 3) >= LEAST_USE for each in (ngram, *parts)):
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
        heard.counted = self._reader.chart(pieces, heard.scene).expected()
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


def _over_words(node: RclNode, origin: tuple[int, ...]) -> RclNode:
    """A tree over pieces as one over words."""
    return RclNode(
        node.label,
        node.concept,
        origin[node.first - 1] + 1,
        origin[node.last - 1] + 1,
        tuple(_over_words(child, origin) for child in node.children),
    )
