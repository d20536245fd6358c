"""Knowledge made by hand: concepts at the board's own looks and places, and what a few words mean."""

from itertools import product

import numpy as np
import pytest

from learning import Knowledge
from learning.concept_id import Concept
from learning.concepts.feature_space import FEATURE_SPACES
from learning.concepts.gaussian import Gaussian
from learning.graphs import ActionGraphlet
from learning.perception.board_noise import hsl
from learning.perception.descriptors import board_descriptors
from tests.executor.graphlets import APART, CARRIED, GRIP, LEFT, MOVE, PUT, TOUCH
from twin import board

TAKE = ActionGraphlet((APART, TOUCH, GRIP, CARRIED))
DROP = ActionGraphlet((GRIP, CARRIED, PUT, LEFT))
UP = 4
"""Number of the direction straight up."""


def _gaussian(mean: np.ndarray, deviation: float) -> Gaussian:
    return Gaussian(mean, deviation**2 * np.eye(len(mean)), count=1000.0, demos=50)


@pytest.fixture(scope="session")
def actions() -> dict[str, ActionGraphlet]:
    return {"take": TAKE, "drop": DROP, "move": MOVE}


@pytest.fixture(scope="session")
def knowledge() -> Knowledge:
    """Someone who knows `take`, `drop`, `put`, the colours, cube, prism, block and on."""
    known = Knowledge(method="thesis")
    directions = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    means = {
        "colour": [FEATURE_SPACES["colour"].embed(np.array(hsl(rgb))) for rgb in board.COLOURS_RGB.values()],
        "shape": [board_descriptors()[shape] for shape in board.SHAPES],
        "location": [board.cell_centre(x, y, 0)[:2] for x, y in product(range(8), range(8))],
        "direction": [np.array(each, dtype=float) for each in directions],
        "distance": [np.array([metres]) for metres in (0.004, 0.038, 0.050, 0.070, 0.13)],
    }
    deviations = {"colour": 0.08, "shape": 0.004, "location": 0.008, "direction": 0.1, "distance": 0.006}
    for space, values in means.items():
        for value in values:  # one at a time: components of one update that are alike would be one concept
            known.spaces.mixtures[space].update([_gaussian(value, deviations[space])])
    meanings = {"take": [("action", 1)], "drop": [("action", 2)], "put": [("action", 3)], "on": [("direction", UP)]}
    meanings |= {colour: [("colour", number)] for number, colour in enumerate(board.COLOURS_RGB)}
    meanings |= {"cube": [("shape", 0)], "prism": [("shape", 1)], "the": [], "block": []}
    for graphlet in (TAKE, DROP, MOVE):
        known.spaces.actions.match_or_add(graphlet)
    for word, concepts in meanings.items():
        known.language.correlation.observe([word], [Concept(*each) for each in concepts])
        known.language.grounding.add(word, Concept(*concepts[0]) if concepts else None, 50.0)
    rules = {
        "command": [("event",)],
        "event": [("action", "entity", "destination"), ("action", "entity")],
        "entity": [("colour", "shape"), ("colour",), ("shape",)],
        "destination": [("spatial-relation",)],
        "spatial-relation": [("direction", "entity")],
    }
    for left, rights in rules.items():
        for right in rights:
            known.language.grammar.add_rule(left, right, 100.0)
    known.demos = 50
    for shape, bears in enumerate((30.0, 0.0)):  # cubes were seen to bear others, prisms never
        known.seen[shape], known.bearing[shape] = 100.0, bears
    return known


@pytest.fixture(scope="session")
def knowledge_file(knowledge: Knowledge, tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("knowledge") / "k.json"
    knowledge.save(path)
    return str(path)
