"""What counts say for and against a meaning of an n-gram, in one language heard at tables.

K tells what goes with what (eq. 4.1), Φ as what n-grams were read. An n-gram has a meaning where both bear it out, and
words mean something together where they seldom come apart.
"""

import math
from collections.abc import Iterable, Mapping

from learning.concept_id import ACTION_SPACE, REFERENCE, Concept
from learning.grounding.correlation import CorrelationMatrix, wilson
from learning.grounding.grounding import Grounding
from learning.grounding.table_scene import BESIDE, NAMED, OVER

LEAST_USE = 0.3
"""Readings that a meaning needs to be tried where it is no hypothesis."""
LEAST_LIFT = 1.5
"""A meaning must go with its n-gram so much more often than with any that are about the same feature space,"""
FEW_TIMES = 4
"""once that was heard so many times."""
LEAST_TRUE = 0.25
"""and what it means must be there so often when something of that feature space is,"""
CALLED_SO = 0.8
"""unless it is seldom there without the n-gram: what perception divides into many kinds has one name."""
ACTION_LIFT = 2.0
"""For actions so much more often, as moving goes with words about places; a word that is mostly passed over may say an
action that it goes with surely more often than any does,"""
OF_ACTIONS = 0.5
"""except that an n-gram whose readings are actions in so many cases may say any action that goes with it"""
LEAST_ACTION = 0.1
"""so often."""
LEAST_SAID = 0.1
"""A word with something joined on does not mean what its stem means when it goes with that so seldom."""
FIRST_SENTENCES = 30
"""Sentences before it is known what is usual."""
MEASURED = 0.3
"""An n-gram that goes with a concept so strongly has no meaning of another kind."""
RAREST = 0.05
"""No concept tells more than one that is salient so seldom."""
COHESION = 0.7
"""Words mean something together where each of them comes with the others so often."""
ANY = "any "
"""Before the name of a feature space: the pseudo-concept in K that anything of that space is salient."""
UNMEASURED = frozenset((REFERENCE, BESIDE))
"""Kinds of meaning that are always at hand, so that K says nothing of them; only readings do."""
SURELY, MAINLY = 3.0, 0.5
"""An n-gram surely means what it was read as so often, and mainly what it was read as in so many of all cases."""
LEAST_HEARD = 0.9
"""Readings before it is told what an n-gram means."""


class Evidence:
    """What was counted of the n-grams of one language.

    Attributes:
        correlation: K.
        grounding: Φ, and how often n-grams were passed over.
        hypotheses: N-gram to the concepts that it may mean, with the strength of each.
    """

    def __init__(
        self,
        correlation: CorrelationMatrix,
        grounding: Grounding,
        hypotheses: Mapping[str, Mapping[Concept, float]],
    ) -> None:
        """Use these; they are read anew at every call."""
        self.correlation = correlation
        self.grounding = grounding
        self.hypotheses = hypotheses
        self._kinds: dict[Concept, tuple[float, float]] = {}

    def borne_out(self, ngram: str, concept: Concept) -> bool:
        """Whether K, once it has seen enough, has the n-gram go with the concept at all."""
        matrix = self.correlation
        if concept in UNMEASURED:
            return max(self.hypotheses.get(ngram, {}).values(), default=0.0) < MEASURED
        if concept == OVER and self._mostly_passed(ngram) and not self._everywhere(ngram):
            return True  # "in" is heard with corners and fronts, too: only readings tell where it says more than they
        heard, every = matrix.ngram_counts.get(ngram, 0.0), any_like(concept)
        usual = self._usual(concept)
        if matrix.demos > FIRST_SENTENCES and usual > 1.0 / LEAST_LIFT:
            return False  # what is true of nearly everything tells nothing
        if heard < FEW_TIMES:
            return True
        row = matrix.joint_counts[ngram]
        share = row.get(concept, 0.0) / max(row.get(every, 0.0), 1.0)
        sure = wilson(row.get(concept, 0.0), row.get(every, 0.0), self._by_chance(every)) > usual
        if concept.space == ACTION_SPACE and self.share_of_space(ngram, ACTION_SPACE) < OF_ACTIONS:
            return share >= ACTION_LIFT * usual or (sure and self._mostly_passed(ngram))
        if concept.space == ACTION_SPACE:
            return share >= LEAST_ACTION
        if not sure or share < LEAST_LIFT * usual:
            return False
        together = row.get(concept, 0.0)
        only = together >= FEW_TIMES and together >= CALLED_SO * matrix.concept_counts.get(concept, 0.0)
        return share >= LEAST_TRUE or only

    def outdone(self, words: Iterable[str]) -> set[tuple[str, Concept]]:
        """Words of a sentence with the directions that another word of it goes with more surely: that one says them.

        In "in front of" each word goes with the direction, and "in" is heard with others, too.
        """
        matrix = self.correlation
        shares: dict[tuple[str, Concept], float] = {}
        surest: dict[Concept, float] = {}
        for word in dict.fromkeys(words):
            if matrix.ngram_counts.get(word, 0.0) < FEW_TIMES:
                continue
            row = matrix.joint_counts[word]
            every = row.get(any_like(OVER), 0.0)
            for concept, count in row.items():
                if concept.space == "direction" and every > 0.0:
                    surely = wilson(count, every, self._by_chance(any_like(OVER)))
                    shares[word, concept] = count / every
                    surest[concept] = max(surest.get(concept, 0.0), surely)
        return {pair for pair, share in shares.items() if share < surest[pair[1]]}

    def denied(self, ngram: str, concept: Concept) -> bool:
        """Whether an n-gram was heard often enough to know that it does not mean what a part of it may mean."""
        heard = self.correlation.ngram_counts.get(ngram, 0.0)
        if heard < FEW_TIMES or concept in UNMEASURED:
            return False
        row = self.correlation.joint_counts[ngram]
        return row.get(concept, 0.0) < LEAST_SAID * row.get(any_like(concept), 0.0)

    def readings(self, ngram: str) -> Mapping[Concept | None, float]:
        """How often an n-gram was read as what, without making an entry of one never heard."""
        row = self.grounding.counts.get(ngram)
        return {} if row is None else row

    def coheres(self, ngram: str) -> bool:
        """Whether the words of an n-gram belong together: its parts seldom come without the rest."""
        words = ngram.split(" ")
        counts = self.correlation.ngram_counts
        whole = counts.get(ngram, 0.0)
        if len(words) == 1:
            return True
        if whole < FEW_TIMES or not (self.coheres(" ".join(words[1:])) and self.coheres(" ".join(words[:-1]))):
            return False
        parts = counts.get(" ".join(words[1:]), whole), counts.get(" ".join(words[:-1]), whole)
        return whole >= COHESION * max(parts)

    def share_of_space(self, ngram: str, space: str) -> float:
        """Share of an n-gram's readings that are of one feature space."""
        row = self.readings(ngram)
        total = sum(row.values())
        same = sum(
            count
            for concept, count in row.items()
            if concept is not None and concept.space.removeprefix(NAMED) == space.removeprefix(NAMED)
        )
        return same / total if total >= LEAST_HEARD else 0.0

    def least_use(self, ngram: str, concept: Concept) -> float:
        """Readings that a meaning needs to be tried where nothing shows whether it is right.

        An odd sentence may have made "the" say a relation once, as another word was misspelt; that is no meaning of it.
        """
        return SURELY if concept == OVER and self._mostly_passed(ngram) else LEAST_USE

    def told(self, concept: Concept) -> float:
        """Log of how much likelier what is shown becomes when it is said: the rarer a concept is, the more it tells.

        A word that is passed over tells nothing of what is shown, and one that has a meaning must be worth that.
        """
        return 0.0 if concept in UNMEASURED else -math.log(min(1.0, max(self._usual(concept), RAREST)))

    def _mostly_passed(self, ngram: str) -> bool:
        """Whether an n-gram was passed over in most of its uses, so that K tells of its neighbours more than of it."""
        row = self.readings(ngram)
        return " " not in ngram and row.get(None, 0.0) > MAINLY * sum(row.values())

    def _usual(self, concept: Concept) -> float:
        """How often a concept is salient when anything of its feature space is."""
        counts = self.correlation.concept_counts
        return counts.get(concept, 0.0) / max(counts.get(any_like(concept), 0.0), 1.0)

    def _everywhere(self, ngram: str) -> bool:
        """Whether an n-gram is said in nearly all sentences, so that it tells nothing."""
        matrix = self.correlation
        heard = matrix.ngram_counts.get(ngram, 0.0)
        return matrix.demos > FIRST_SENTENCES and heard > matrix.row_demos(ngram) / LEAST_LIFT

    def _by_chance(self, every: Concept) -> float:
        """Standard errors by which the best of all meanings of one kind exceeds its share by chance."""
        known = self._kinds.get(every)
        if known is None or known[0] != self.correlation.demos:
            count = sum(1 for concept in self.correlation.concept_counts if any_like(concept) == every)
            known = self._kinds[every] = self.correlation.demos, math.sqrt(2.0 * math.log(max(count, 2)))
        return known[1]


def with_spaces(salient: Iterable[Concept]) -> set[Concept]:
    """Salient concepts, and for each of their spaces that anything of it is salient."""
    found = set(salient)
    return found | {any_like(concept) for concept in found}


def any_like(concept: Concept) -> Concept:
    """The pseudo-concept that anything of a concept's feature space is salient; sorts are of the space they sort."""
    space = "direction" if concept == OVER else concept.space.removeprefix(NAMED)
    return Concept(f"{ANY}{space}", 0)
