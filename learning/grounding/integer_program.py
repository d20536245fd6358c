"""Grounding hypotheses by an integer program (thesis 4.4, equation 4.2), solved by HiGHS through PuLP."""

from collections.abc import Mapping

import pulp

from learning.concept_id import Concept

EPSILON = 0.05
"""Largest share of all pairs that may be selected (thesis 6.4.3)."""

Pair = tuple[str, Concept]


def select_groundings(strengths: Mapping[Pair, float], epsilon: float = EPSILON) -> set[Pair]:
    """Choose the pairs A(δ, v) = 1 that maximise Σ A(δ, v) K(δ, v) (equation 4.2).

    Constraints: at most a share `epsilon` of all pairs is chosen (sparsity), every concept gets one n-gram or more.
    Where both cannot hold (fewer pairs allowed than there are concepts) the sparsity bound gives way.

    Args:
        strengths: K(δ, v) of all pairs of n-grams and concepts at hand, in 0..1. Pairs of strength 0 count for the
            size of the matrix and are never chosen.
        epsilon: Share in 0..1.
    """
    columns: dict[Concept, list[Pair]] = {}
    for pair, strength in strengths.items():
        if strength > 0:
            columns.setdefault(pair[1], []).append(pair)
    if not columns:
        return set()
    limit = max(int(epsilon * len(strengths)), len(columns))
    problem = pulp.LpProblem("groundings", pulp.LpMaximize)
    pairs = [pair for column in columns.values() for pair in column]
    chosen = {pair: problem.add_variable(f"a{index}", cat=pulp.LpBinary) for index, pair in enumerate(pairs)}
    problem += pulp.lpSum(strengths[pair] * variable for pair, variable in chosen.items())
    problem += pulp.lpSum(chosen.values()) <= limit
    for column in columns.values():
        problem += pulp.lpSum(chosen[pair] for pair in column) >= 1
    problem.solve(pulp.HiGHS(msg=False, threads=1))
    return {pair for pair, variable in chosen.items() if (variable.value() or 0.0) > 0.5}
