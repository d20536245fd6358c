"""How the words of a sentence may be read: by alignment at first, by what was validated more and more."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from learning.concept_id import ACTION_SPACE, Concept
from learning.grammar.innate import (
    ABOVE,
    BESIDE,
    COLLECTIVE,
    COLLECTIVES,
    COUNTS,
    EXTREMES,
    FURTHEST,
    GROUP,
    IT,
    NEAREST,
    ONE,
    REGION,
    SIDES,
    UNIT,
    WHOLE,
)
from learning.grammar.phrase import Feature
from learning.grammar.phrase_chart import Use
from learning.grammar.weights import Weights
from learning.grounding.alignment import Alignment, Meaning
from learning.grounding.grounding import Grounding
from learning.grounding.slips import near_words

PRIOR_WEIGHT = 5.0
"""How many validations the alignment of a word is worth before any came."""
PRIOR_SHARE = 0.1
"""Weight of the alignment beside each validation, so that what is validated by chance does not keep itself alive."""
MOST_MEANINGS = 7
"""Meanings tried of one word."""
LEAST_PROBABILITY = 0.02
"""Meanings rarer than this are not tried."""
HOPELESS = 5.0
"""A meaning whose weight is this much below that of passing the word over is not tried."""
PASSED = -1.2
"""Weight of passing any word over, beside how likely it is to mean nothing: words are said for a reason."""
DOUBT = 0.25
"""Probability that is added to that of any word to mean nothing, so that one use in vain does not give it a meaning."""
UNMEASURED = (
    (IT, 20.0, math.inf),
    (ABOVE, 5.0, 100.0),
    (ONE, 5.0, 200.0),
    (UNIT, 5.0, 100.0),
    (BESIDE, 5.0, 60.0),
    (WHOLE, 5.0, 60.0),
    (REGION, 5.0, 60.0),
    (FURTHEST, 5.0, 60.0),
)
"""Kinds of meaning that no scene shows by itself, or nearly every scene does, with how often a word for them may have
been heard."""
IT_SHARE = 3.0
"""How much likelier a word is to mean "it" than any other of these: it stands in every other command."""
PLAIN = 0.5
"""A word that means something with this probability needs no such kind."""
ESTABLISHED = 3.0
"""A word that was heard so often is what one that was never heard, and looks like it, is taken for."""
RARE = 30.0
"""A word heard less often than this may be an action that is seldom called so, or a narrower relation."""
ANY_ACTION, OFTEN = 0.5, 50.0
"""How likely a word for one action is one for another, too, and after how many validations half as likely."""
ACTING = 0.1
"""A word that means some action with this probability may mean any."""
UNMEASURED_PROBABILITY = 0.02
MEASURING = 0.3
"""A word that is a unit of distance with this probability may have a number before it, and a side after it."""
DISPLACING = (*SIDES, *COUNTS, UNIT)
"""What is said of how far something moves: always together, so that few demos do not tell one from the next."""
SENTENCE_END = "."
"""Stands for the word after the last; words hold no punctuation."""
SHORTEST_STEM = 3
"""Letters of the shortest word that a longer one may be a form of."""
HEADING_SPACE = "heading"
"""Space under which alignment counts the direction in which something moved; the words are those of `SIDES`."""


@dataclass(frozen=True, slots=True)
class WordUses:
    """The words of a sentence that may mean something, and the weight of all others.

    Attributes:
        kept: Positions in the sentence of the words that may mean something.
        uses: How they may be read; positions count the kept words.
        passed: Weight of passing over each kept word.
    """

    kept: tuple[int, ...]
    uses: tuple[Use, ...]
    passed: tuple[float, ...]


class UseTable:
    """Makes lexical entries from what was learned of words."""

    def __init__(self, alignment: Alignment, grounding: Grounding, weights: Weights) -> None:
        """Use these; they are read anew at every call."""
        self.alignment = alignment
        self.grounding = grounding
        self.weights = weights
        self.least_probability = LEAST_PROBABILITY

    def meanings(self, word: str) -> dict[Meaning, float]:
        """P(meaning | word): what was validated, with the alignment as prior."""
        aligned: dict[Meaning, float] = {}
        kin = self._kin_of_shape(word)
        for meaning, share in self.alignment.meanings(word).items():
            if meaning is not None and meaning.space == HEADING_SPACE:
                meaning = SIDES[meaning.number]
            elif meaning in COLLECTIVES:
                meaning = GROUP if kin else COLLECTIVE
            aligned[meaning] = aligned.get(meaning, 0.0) + share
        validated: Mapping[Meaning, float] | None = self.grounding.counts.get(word)
        if not validated:
            return aligned
        if not kin and GROUP in validated:
            # What things that stand on one another are called is a name of its own unless it resembles theirs.
            validated = {**validated, COLLECTIVE: validated.get(COLLECTIVE, 0.0) + validated[GROUP], GROUP: 0.0}
        total = max(0.0, sum(validated.values()))
        prior = PRIOR_WEIGHT + PRIOR_SHARE * total
        known = dict.fromkeys((*validated, *aligned))
        return {m: (max(0.0, validated.get(m, 0.0)) + prior * aligned.get(m, 0.0)) / (total + prior) for m in known}

    def _kin_of_shape(self, word: str) -> bool:
        """Whether a word is a longer form of one that names a shape, as plurals are in many languages."""
        for length in (len(word) - 1, len(word) - 2):
            stem = self.grounding.counts.get(word[:length]) if length >= SHORTEST_STEM else None
            if stem and sum(n for m, n in stem.items() if m is not None and m.space == "shape") > 0.5 * sum(
                stem.values()
            ):
                return True
        return False

    def of(self, words: Sequence[str], actions: Sequence[int], open_minded: bool = False) -> WordUses:
        """List how the words of a sentence may be read.

        Args:
            words: The sentence.
            actions: Numbers of the known actions, one of each sort.
            open_minded: Whether any word that has no plain meaning may be an action.
        """
        kept: list[int] = []
        uses: list[Use] = []
        passed: list[float] = []
        words = [self._as_heard(word) for word in words]
        of_words = [self.meanings(word) for word in words]
        measuring = [means.get(UNIT, 0.0) > MEASURING for means in of_words]
        for position, (word, means) in enumerate(zip(words, of_words, strict=True)):
            before_unit = measuring[position + 1] if position + 1 < len(words) else False
            after_unit = measuring[position - 1] if position else False
            skip = self._passed(word, means)
            after = words[position + 1] if position + 1 < len(words) else SENTENCE_END
            found = [
                use
                for use in self._uses(word, after, means, actions, len(kept), open_minded, before_unit, after_unit)
                if use.score > skip - HOPELESS
            ]
            if found:
                kept.append(position)
                uses += found
                passed.append(skip)
        return WordUses(tuple(kept), tuple(uses), tuple(passed))

    def _as_heard(self, word: str) -> str:
        """The word, or, where it was never heard, the heard one that it is most likely a slip for."""
        heard = self.alignment.word_counts
        if heard.get(word, 0.0) > 0.0:
            return word
        established = {other: times for other, times in heard.items() if times >= ESTABLISHED}
        near = near_words(word, established)
        return max(near[min(near)], key=lambda other: (established[other], other)) if near else word

    def _passed(self, word: str, means: dict[Meaning, float]) -> float:
        return math.log(means.get(None, 0.0) + DOUBT) + PASSED + self.weights.learned.get(passed_feature(word), 0.0)

    def _uses(
        self,
        word: str,
        after: str,
        means: dict[Meaning, float],
        actions: Sequence[int],
        position: int,
        open_minded: bool,
        before_unit: bool,
        after_unit: bool,
    ) -> list[Use]:
        count = self.alignment.word_counts.get(word, 0.0)
        likely = [(p, meaning) for meaning, p in means.items() if meaning is not None and p > self.least_probability]
        likely.sort(key=lambda pair: (-pair[0], pair[1]))
        chosen: dict[Concept, float] = {meaning: p for p, meaning in likely[:MOST_MEANINGS]}
        kin = self._kin_of_shape(word)
        plain = bool(likely) and likely[0][0] > PLAIN
        for meaning, least, most in UNMEASURED:
            if least <= count <= most and not kin and not plain:
                probability = UNMEASURED_PROBABILITY * (IT_SHARE if meaning == IT else 1.0)
                chosen[meaning] = max(chosen.get(meaning, 0.0), probability)
        near = chosen.get(NEAREST, 0.0)
        if near > ACTING and count <= RARE:
            # What is beside a thing is nearest to it, too: only all uses together tell "next to" from "closest to".
            chosen[BESIDE] = max(chosen.get(BESIDE, 0.0), 0.5 * near)
        extreme = sum(means.get(each, 0.0) for each in EXTREMES)
        if extreme > LEAST_PROBABILITY:
            # Said of what is furthest to some side: beside a word for that side it means no more than "furthest".
            chosen[FURTHEST] = max(chosen.get(FURTHEST, 0.0), extreme)
        acting = sum(p for meaning, p in means.items() if meaning is not None and meaning.space == ACTION_SPACE)
        if count < RARE or acting > ACTING or (open_minded and not plain):
            for number in actions:
                chosen.setdefault(Concept(ACTION_SPACE, number), UNMEASURED_PROBABILITY / 2)
        if before_unit:
            for meaning in COUNTS:
                chosen.setdefault(meaning, UNMEASURED_PROBABILITY)
        if after_unit:
            # "Up" of "two squares up" is no word for a side anywhere else.
            for meaning in SIDES:
                chosen.setdefault(meaning, UNMEASURED_PROBABILITY)
        if count < RARE and sum(p for meaning, p in means.items() if meaning in DISPLACING) > ACTING:
            for meaning in DISPLACING:
                chosen.setdefault(meaning, UNMEASURED_PROBABILITY / 2)
        learned = self.weights.learned
        any_action = ANY_ACTION / (1.0 + self.grounding.total(word) / OFTEN)
        found = []
        for meaning, p in chosen.items():
            features: tuple[Feature, ...] = (("means", word, str(meaning)),)
            if meaning.space == ACTION_SPACE:
                # Words for one action are often words for another: "put" on its own, "put" after "take".
                p += any_action * (acting / max(1, len(actions)) - p)
                features = (*features, ("means", word, ACTION_SPACE))
            score = math.log(p + 0.01) + sum(learned.get(feature, 0.0) for feature in features)
            found.append(Use(position, position + 1, meaning, score, features, word, after))
        return found


def passed_feature(word: str) -> Feature:
    """Name the feature "this word is passed over"."""
    return ("passed", word)
