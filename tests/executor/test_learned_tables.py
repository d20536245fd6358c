import numpy as np
import pytest

from executor.learned_tables import (
    action_rows,
    colour_of,
    concept_rows,
    described,
    function_words,
    part_sizes,
    rule_rows,
    spoken,
    words_of_concepts,
)
from learning import Knowledge
from learning.concept_id import Concept
from learning.concepts.feature_space import FEATURE_SPACES
from learning.concepts.table_spaces import TableColour, TableShape
from learning.grounding.tongue import Tongue
from learning.perception.board_noise import hsl
from twin.board import COLOURS_RGB


@pytest.mark.parametrize("name", COLOURS_RGB)
def test_a_patch_has_the_colour_of_the_concept(name: str) -> None:
    mean = FEATURE_SPACES["colour"].embed(np.array(hsl(COLOURS_RGB[name])))
    np.testing.assert_allclose(
        colour_of(mean), 255 * np.array(COLOURS_RGB[name]), atol=0.51
    )  # rounded to whole numbers


def test_a_patch_of_a_colour_seen_at_a_table_is_not_darker_than_it() -> None:
    mean = TableColour.embed(np.array(hsl(COLOURS_RGB["white"])))
    assert colour_of(mean, TableColour) == colour_of(
        FEATURE_SPACES["colour"].embed(np.array(hsl(COLOURS_RGB["white"])))
    )


def test_shapes_with_the_same_highest_bins_are_told_apart() -> None:
    bins = np.zeros(33)
    bins[[5, 16, 26]] = 0.3, 0.5, 0.2
    flat, tall = (TableShape.embed(np.array([*bins, *sides])) for sides in ((0.1, 0.1, 0.02), (0.1, 0.1, 0.2)))
    assert described("shape", flat) != described("shape", tall)
    assert described("shape", np.sqrt(bins)) != described("shape", np.sqrt(np.roll(bins[::-1], -1)))


def test_words_of_tables_stand_with_what_they_mean_too() -> None:
    learned = Knowledge("table")
    tongue = learned.table_language.tongues["LATIN"] = Tongue()
    tongue.grounding.add("red", Concept("colour", 2), 9.0)
    tongue.grounding.add("grab", Concept("action", 1), 5.0)
    words = words_of_concepts(learned)
    assert words[Concept("colour", 2)] == [("red", 1.0, 9.0)]
    assert words[Concept("action", 1)] == [("grab", 1.0, 5.0)]


@pytest.mark.parametrize(
    ("space", "mean", "words"),
    [
        ("location", (0.025, 0.375), "at (25, 375) mm"),
        ("distance", (0.05,), "50 mm"),
        ("direction", (0.0, 1.0, 0.0), "azimuth 90°, altitude 0°"),
        ("direction", (0.0, 0.0, 1.0), "altitude 90°"),
        ("size", (np.log(0.05),), "50 mm, mean of its sides"),
        ("weight", (0.12,), "120 g"),
    ],
)
def test_a_concept_is_described_by_its_mean(space: str, mean: tuple[float, ...], words: str) -> None:
    assert described(space, np.array(mean)) == words


def test_words_stand_with_what_they_mean(knowledge: Knowledge) -> None:
    words = words_of_concepts(knowledge)
    red = list(COLOURS_RGB).index("red")
    assert words[Concept("colour", red)] == [("red", 1.0, 50.0)]
    assert spoken(words[Concept("colour", red)]) == "red (1.00)"
    assert set(function_words(knowledge)) == {"the", "block"}
    rows = {str(concept): entries for concept, _, _, entries in concept_rows(knowledge)}
    assert rows["direction_4"][0][0] == "on"
    assert len([name for name in rows if name.startswith("location_")]) == 64
    assert [(str(concept), words[0][0]) for concept, _, words in action_rows(knowledge)] == [
        ("action_1", "take"),
        ("action_2", "drop"),
        ("action_3", "put"),
    ]


def test_rules_come_with_their_probability(knowledge: Knowledge) -> None:
    rows = rule_rows(knowledge, 100)
    events = {right: probability for left, right, probability, _ in rows if left == "event"}
    assert events == {"action entity destination": 0.5, "action entity": 0.5}
    assert len(rule_rows(knowledge, 2)) == 2


def test_sizes_name_every_part(knowledge: Knowledge) -> None:
    sizes = part_sizes(knowledge)
    assert {"concepts.spaces", "language.grounding", "language.grammar"} <= set(sizes)
    assert all(size > 0 for size in sizes.values())
