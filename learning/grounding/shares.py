"""Probabilities of readings out of their scores."""

import math
from collections.abc import Sequence


def shares_of(scores: Sequence[float]) -> list[float]:
    """Probability of each reading, out of the logarithms of their weights; none for none."""
    if not scores:
        return []
    top = max(scores)
    shares = [math.exp(score - top) for score in scores]
    total = sum(shares)
    return [share / total for share in shares]
