"""The order in which a language says the parts of a meaning: the likeliest rule of Π for them (thesis 5.4)."""

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import replace

from learning.grammar.pcfg import Pcfg
from learning.grammar.rcl import RclNode

LEAST_SEEN = 1.5
"""Sightings of a rule before anything is said by it."""


def meaning(label: str, *children: RclNode) -> RclNode:
    """A part of a meaning that is not in words yet."""
    return RclNode(label, None, 0, 0, children)


def said_together(grammar: Pcfg, label: str) -> frozenset[tuple[str, ...]]:
    """What a part may consist of, whatever the order: labels of children, sorted."""
    row: Mapping[tuple[str, ...], float] = grammar.rules.get(label, {})
    return frozenset(tuple(sorted(right)) for right, count in row.items() if count >= LEAST_SEEN)


def ordered(tree: RclNode, grammar: Pcfg) -> tuple[RclNode, float] | None:
    """Put the children of every part in their likeliest order.

    Args:
        tree: A meaning; the order of its children says nothing, but for those of equal labels.
        grammar: Π.

    Returns:
        The tree in the order of speech, and the log probability of its rules; None where a part was never said so.
    """
    score = 0.0
    if tree.concept is None:
        right = _likeliest(tree, grammar)
        if right is None:
            return None
        share = grammar.rules[tree.label][right] / sum(grammar.rules[tree.label].values())
        score += math.log(share)
        waiting = list(tree.children)
        children = []
        for label in right:
            child = next(each for each in waiting if each.label == label)
            waiting = [each for each in waiting if each is not child]
            inner = ordered(child, grammar)
            if inner is None:
                return None
            children.append(inner[0])
            score += inner[1]
        tree = replace(tree, children=tuple(children))
    return tree, score


def _likeliest(tree: RclNode, grammar: Pcfg) -> tuple[str, ...] | None:
    wanted = Counter(child.label for child in tree.children)
    row: Mapping[tuple[str, ...], float] = grammar.rules.get(tree.label, {})
    fitting = [(count, right) for right, count in row.items() if count >= LEAST_SEEN and Counter(right) == wanted]
    return max(fitting)[1] if fitting else None
