"""What words nearly say, where nothing is just what they say."""

from collections.abc import Mapping

import numpy as np
import pytest

from learning.concept_id import Concept
from learning.concepts import TABLE, ConceptSpaces
from learning.concepts.gaussian import Gaussian
from learning.grammar.rcl import RclNode
from learning.grounding.table_scene import TableScene
from learning.grounding.tongue import Tongue
from learning.interpretation.also_meant import also_meant
from learning.interpretation.nearly import NearlyDenotation

MEANS = {"red": [0.6, 0.0, 0.4], "blue": [-0.5, -0.4, 0.4], "green": [-0.3, 0.6, 0.4]}


def colours() -> tuple[ConceptSpaces, dict[str, Concept]]:
    """Three colours, seen often."""
    spaces = ConceptSpaces(TABLE)
    for _ in range(6):
        spaces.mixtures["colour"].update([Gaussian(np.array(m), 4e-4 * np.eye(3), 10.0) for m in MEANS.values()])
    mixture = spaces.mixtures["colour"]
    names = {name: Concept("colour", int(mixture.classify(np.array([mean]))[0])) for name, mean in MEANS.items()}
    return spaces, names


def denoted(
    values: list[list[float]],
    word: Concept,
    spaces: ConceptSpaces,
    also: Mapping[Concept, frozenset[Concept]] | None = None,
) -> int:
    """Things that a colour word denotes, as a mask."""
    numbers = [int(spaces.mixtures["colour"].classify(np.array([v]))[0]) if np.isfinite(v[0]) else None for v in values]
    scene = TableScene(
        looks=tuple(frozenset() if n is None else frozenset({Concept("colour", n)}) for n in numbers),
        places=(frozenset(),) * len(values),
        relations={},
        moved=-1,
        action=0,
        parts=(),
        goal=frozenset(),
        goal_relations={},
        ground=None,
        unseen={},
    )
    entity = RclNode("entity", None, 1, 1, (RclNode("colour", word, 1, 1),))
    return NearlyDenotation(scene, {"colour": np.array(values)}, spaces, {}, also).things(entity)


def test_what_is_just_so_is_meant_alone() -> None:
    spaces, names = colours()
    assert denoted([MEANS["red"], MEANS["blue"]], names["red"], spaces) == 0b01


def test_a_thing_between_two_colours_is_meant_where_none_is_just_so() -> None:
    spaces, names = colours()
    between = (0.49 * np.array(MEANS["red"]) + 0.51 * np.array(MEANS["blue"])).tolist()
    assert denoted([between, MEANS["green"]], names["red"], spaces) == 0b01


def test_nothing_is_meant_where_all_is_far_from_what_is_said() -> None:
    spaces, names = colours()
    assert denoted([MEANS["blue"], MEANS["green"]], names["red"], spaces) == 0


def test_what_was_not_seen_may_be_anything() -> None:
    spaces, names = colours()
    assert denoted([MEANS["blue"], [np.nan] * 3], names["red"], spaces) == 0b10


def test_a_word_for_two_concepts_means_things_of_both() -> None:
    spaces, names = colours()
    also = {names["red"]: frozenset({names["blue"]})}
    assert denoted([MEANS["red"], MEANS["blue"], MEANS["green"]], names["red"], spaces, also) == 0b011
    assert denoted([MEANS["green"], MEANS["blue"]], names["red"], spaces, also) == 0b10
    assert denoted([MEANS["red"], MEANS["blue"], MEANS["green"]], names["red"], spaces) == 0b001
    nearly_blue = (0.49 * np.array(MEANS["green"]) + 0.51 * np.array(MEANS["blue"])).tolist()
    assert denoted([nearly_blue, MEANS["green"]], names["red"], spaces, also) == 0b01


@pytest.mark.parametrize(("uses", "both"), [(8.0, True), (1.0, False)])
def test_a_concept_is_also_meant_where_a_word_was_often_used_for_it(uses: float, both: bool) -> None:
    one, other, elsewhere = Concept("shape", 1), Concept("shape", 2), Concept("size", 0)
    tongue = Tongue()
    for _ in range(30):
        tongue.joined.hear(("tub",))
    for concept, amount in ((one, 13.0), (other, uses), (elsewhere, 9.0)):
        tongue.grounding.add("tub", concept, amount)
    tree = RclNode("entity", None, 1, 1, (RclNode("shape", one, 1, 1),))
    found = also_meant(tongue, ("tub",), tree, {"shape", "size"})
    assert found == ({one: frozenset({other})} if both else {})
    assert also_meant(tongue, ("tub",), tree, {"size"}) == {}
    tongue.grounding.add("bucket", other, 20.0)  # a name of its own
    assert also_meant(tongue, ("tub",), tree, {"shape", "size"}) == {}
