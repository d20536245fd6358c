"""True values of table concepts for scoring: what a concept stands for most often in the demos learned from."""

from collections import Counter, defaultdict
from collections.abc import Iterable

import numpy as np

from learning.concept_id import ACTION_SPACE, Concept
from learning.concepts.table_spaces import ADJACENT
from learning.errors import PerceptionError
from learning.evaluation.concepts import ScoredDemo
from learning.evaluation.concepts_truth import band_of, table_side
from learning.graphs.action_states import shown_action
from learning.grounding.kind_sizes import LARGER, SMALLER
from learning.grounding.table_scene import BESIDE, MIDDLE, NAMED, OVER, SIDE_PLACES, looks_of
from learning.knowledge import Knowledge
from learning.percept import NO_CONCEPT

PLACE_NAMES = dict(zip((*SIDE_PLACES, MIDDLE), ("top", "bottom", "left", "right", "centre"), strict=True))
"""What the innate places are called; the robot looks along +x, and left is +y."""


def concept_values(knowledge: Knowledge, demos: Iterable[ScoredDemo]) -> dict[Concept, str]:
    """Most frequent true value of each concept (the first in the alphabet of equals).

    Args:
        knowledge: What was learned.
        demos: Demos that it was learned from, with their truth.
    """
    counts: defaultdict[Concept, Counter[str]] = defaultdict(Counter)
    for demo in demos:
        _count(knowledge, demo, counts)
    named = {concept: min(row, key=lambda value: (-row[value], value)) for concept, row in counts.items()}
    return {**named, **PLACE_NAMES, BESIDE: "close", OVER: "above", SMALLER: "small", LARGER: "large"}


def _count(knowledge: Knowledge, demo: ScoredDemo, counts: defaultdict[Concept, Counter[str]]) -> None:
    spaces, truth = knowledge.spaces, demo.truth
    for name, numbers in looks_of(demo.observation, spaces, knowledge.table_language.sorts).items():
        for number, value in zip(numbers, truth.properties.get(name.removeprefix(NAMED), ()), strict=False):
            if value is not None and number != NO_CONCEPT:
                counts[Concept(name, int(number))][value] += 1
    for places in (truth.first, truth.last):
        for offset in (places[:, None] - places[None]).reshape(-1, 3):
            length = float(np.linalg.norm(offset))
            if not 0.0 < length <= ADJACENT:  # nan, of a track of nothing, is neither
                continue
            for name, value in (("direction", table_side(offset)), ("distance", band_of(length))):
                if value is not None and spaces.mixtures[name].components:
                    counts[Concept(name, int(spaces.predicates(name, offset[None])[0]))][value] += 1
    if truth.action is None:
        return
    try:
        graphlet, measures, _ = shown_action(demo.observation, spaces)
    except PerceptionError:
        return
    found = spaces.actions.find(graphlet, measures)
    if found is not None:
        counts[Concept(ACTION_SPACE, found)][truth.action] += 1
