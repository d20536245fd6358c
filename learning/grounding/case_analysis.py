"""Filtering of grounding hypotheses by case analysis of n-grams (thesis 4.5, rules 4.3 to 4.6)."""

from learning.concept_id import Concept
from learning.grounding.integer_program import Pair


def filter_hypotheses(hypotheses: set[Pair]) -> set[Pair]:
    """Drop hypotheses that a longer or a shorter n-gram explains better.

    For every n-gram ab made of a and b, concept by concept: assigned to ab, a and b, only ab stays (4.3: "pick up"
    over "pick" and "up"); assigned to ab and one of a, b, the longer goes (4.4, 4.5: "red" over "the red"); all
    different, all stay (4.6). Longer n-grams are decided first, so that what they subsume is gone when shorter ones
    are looked at.
    """
    kept = set(hypotheses)
    by_ngram: dict[str, set[Concept]] = {}
    for ngram, concept in hypotheses:
        by_ngram.setdefault(ngram, set()).add(concept)
    for ngram in sorted(by_ngram, key=lambda text: (-text.count(" "), text)):
        words = ngram.split(" ")
        for cut in range(1, len(words)):
            left, right = " ".join(words[:cut]), " ".join(words[cut:])
            for concept in by_ngram[ngram]:
                if (ngram, concept) not in kept:
                    continue
                in_left = (left, concept) in hypotheses
                in_right = (right, concept) in hypotheses
                if in_left and in_right:
                    kept -= {(left, concept), (right, concept)}
                elif in_left or in_right:
                    kept.discard((ngram, concept))
    return kept
