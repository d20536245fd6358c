"""From what was counted to how likely a word means something: the lexical entries that a chart is filled with."""

import math
from collections.abc import Mapping

from learning.concept_id import REFERENCE, Concept
from learning.grammar.chart import LexicalEntry
from learning.grammar.preferences import Preferences, lexical_feature, skip_feature
from learning.grounding.grounding import Grounding
from learning.grounding.integer_program import Pair
from learning.grounding.ngrams import Span, ngrams_of

PRIOR_WEIGHT = 2.0
"""How many validations the correlation of a candidate is worth before any came."""
PRIOR_SHARE = 1.0
"""Weight of the correlation beside each validation: K is counted without regard to Φ, so it keeps Φ from drifting."""
NONE_WEIGHT = 1.0
"""Validations that "means nothing" starts with, for every n-gram."""
LEAST_PROBABILITY = 0.02
"""Meanings rarer than this are not tried any more, unless they are candidates."""
LEAST_COUNT = 0.2
"""Validations that a meaning needs before it is tried without a fresh correlation."""
DOUBT = 3.0
"""Power of 1 - K in the prior of meaning nothing: what goes with some concept half the time is no function word."""
LEAST_DOUBT = 0.02
"""The prior of meaning nothing never falls below this, however strong the association."""
SAID = 0.3
"""Weight of the other direction, P(δ | v) (equation 5.2), beside P(v | δ), for v = nothing alone. A word that is not
needed to single a thing out ("cube" among cubes) would slowly become a function word by Φ alone; but of all function
words it is a rare one."""
SMOOTH = 2.0
"""Added to how much was ever passed over, so that the first word that was does not stand for all function words."""
REFERENCE_PRIOR = 0.05
"""Correlation lent to every single word as a name for the thing spoken of before."""


def lexical_entries(
    words: tuple[str, ...],
    grounding: Grounding,
    preferences: Preferences,
    candidates: Mapping[Pair, float] | None = None,
    meant: Mapping[str, float] | None = None,
) -> tuple[list[LexicalEntry], list[float]]:
    """List how the words of a sentence may be read.

    Args:
        words: The sentence.
        grounding: Φ so far.
        preferences: Weights beside Φ.
        candidates: While learning, hypotheses that passed the filter, with their strength K; None when interpreting.
        meant: While learning, each word's strongest association; the stronger, the less it is a function word. None
            when interpreting.

    Returns:
        Lexical entries, and the weight of passing over each word, (n_words,): log probabilities, plus preferences.
    """
    entries: list[LexicalEntry] = []
    skip = [0.0] * len(words)
    by_ngram: dict[str, dict[Concept, float]] = {}
    for (ngram, concept), strength in (candidates or {}).items():
        by_ngram.setdefault(ngram, {})[concept] = strength
    for ngram, spans in ngrams_of(words).items():
        single = " " not in ngram
        prior = by_ngram.get(ngram, {})
        if candidates is not None and single:
            prior = {REFERENCE: REFERENCE_PRIOR, **prior}
        known: Mapping[Concept | None, float] = grounding.counts.get(ngram, {})
        total = grounding.total(ngram)
        weight = PRIOR_WEIGHT + PRIOR_SHARE * total if candidates is not None else 0.0
        nothing = NONE_WEIGHT + weight * max(
            LEAST_DOUBT, (1.0 - min(1.0, max(sum(prior.values()), (meant or {}).get(ngram, 0.0)))) ** DOUBT
        )
        mass = total + nothing + weight * sum(prior.values())
        meanings: set[Concept] = set(prior)
        meanings.update(c for c, n in known.items() if c is not None and n >= LEAST_COUNT)
        for concept in sorted(meanings):
            probability = (known.get(concept, 0.0) + weight * prior.get(concept, 0.0)) / mass
            if probability >= LEAST_PROBABILITY or concept in prior:
                entries.extend(
                    _at(spans, concept, math.log(probability) + preferences.of(lexical_feature(ngram, concept)))
                )
        if single:
            said = (known.get(None, 0.0) + nothing) / (grounding.concept_totals[None] + nothing + SMOOTH)
            cost = (
                math.log((known.get(None, 0.0) + nothing) / mass)
                + SAID * math.log(said)
                + preferences.of(skip_feature(ngram))
            )
            for first, _ in spans:
                skip[first] = cost
    return entries, skip


def _at(spans: list[Span], concept: Concept, log_probability: float) -> list[LexicalEntry]:
    return [LexicalEntry(first, after, concept, log_probability) for first, after in spans]
