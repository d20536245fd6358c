"""From K to grounding hypotheses: selected by the integer program (4.2), filtered by case analysis (4.3 to 4.6)."""

from collections.abc import Mapping

from learning.grounding.case_analysis import filter_hypotheses
from learning.grounding.integer_program import EPSILON, Pair, select_groundings
from learning.grounding.ngrams import parts_of

COMPARABLE = 0.85
"""A part of an n-gram with this share of its strength or more is a hypothesis too."""


def supposed(strengths: Mapping[Pair, float], epsilon: float = EPSILON) -> dict[Pair, float]:
    """Hypotheses with their strengths, out of those of all pairs of n-grams and concepts at hand; in their order."""
    chosen = select_groundings(strengths, epsilon)
    # The program takes the strongest pairs up to its bound, so of "red" and "the red", equally strong, it may have
    # taken the longer alone; the cases of 4.3 to 4.6 are about both.
    chosen |= {
        (part, concept)
        for ngram, concept in chosen
        for part in parts_of(ngram)
        if strengths.get((part, concept), 0.0) >= COMPARABLE * strengths[ngram, concept]
    }
    return {pair: strengths[pair] for pair in sorted(filter_hypotheses(chosen))}
