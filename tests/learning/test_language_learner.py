"""The whole of chapters 4 and 5 on a toy language: grounding, grammar, reading of new sentences."""

from dataclasses import replace

import numpy as np
import pytest

from learning.concept_id import Concept
from learning.grammar.chart import Chart, Reading
from learning.grammar.scene import SceneSets
from learning.grounding.language_learner import LanguageLearner, VisionTree
from learning.grounding.lexicon import lexical_entries
from tests.learning.hypothesis_graphs import is_validated
from tests.learning.scenes import ABOVE, MOVE, TAKE, percept_of_blocks, shown
from tests.learning.toy_language import ACTIONS, COLOURS, Lesson, random_lesson, teach

LESSONS = 150


def lessons(seed: int, count: int, verb_last: bool = False) -> list[Lesson]:
    rng = np.random.default_rng(seed)
    return [random_lesson(rng, verb_last) for _ in range(count)]


@pytest.fixture(scope="module", params=[False, True], ids=["verb first", "verb last"])
def taught(request: pytest.FixtureRequest) -> tuple[LanguageLearner, bool]:
    learner = LanguageLearner()
    teach(learner, lessons(1, LESSONS, request.param))
    return learner, request.param


def readings(learner: LanguageLearner, lesson: Lesson) -> list[Reading]:
    entries, skip = lexical_entries(lesson.words, learner.grounding, learner.preferences)
    chart = Chart(
        len(lesson.words), entries, skip, learner.grammar, SceneSets(lesson.percept), ACTIONS, learner.preferences
    )
    return sorted(chart.readings(), key=lambda reading: -learner.log_weight(reading))


def test_colours_are_grounded_in_the_colours_they_name(taught: tuple[LanguageLearner, bool]) -> None:
    learner, _ = taught
    for number, word in enumerate(COLOURS):
        meanings = learner.grounding.meanings(word)
        assert max(meanings, key=meanings.__getitem__) == Concept("colour", number)


def test_new_sentences_about_new_scenes_do_what_they_say(taught: tuple[LanguageLearner, bool]) -> None:
    learner, verb_last = taught
    right = 0
    asked = lessons(2, 60, verb_last)
    for lesson in asked:
        found = readings(learner, lesson)
        truth = VisionTree.of(lesson.shown)
        right += bool(found) and truth.matches(found[0]) and found[0].moves == 1
    assert right >= 0.9 * len(asked)


def test_probabilities_of_rules_sum_to_one(taught: tuple[LanguageLearner, bool]) -> None:  # equation 5.3
    grammar = taught[0].grammar
    for left in {*grammar.rules, *grammar.terminals}:
        total = sum(grammar.probability(left, right) for right in grammar.rules.get(left, {}))
        total += sum(grammar.terminal_probability(left, ngram) for ngram in grammar.terminals.get(left, {}))
        assert total == pytest.approx(1.0, abs=1e-9)


def test_the_order_of_words_is_learned(taught: tuple[LanguageLearner, bool]) -> None:
    learner, verb_last = taught
    order = ("entity", "direction") if verb_last else ("direction", "entity")
    rules = learner.grammar.rules["spatial-relation"]
    assert max(rules, key=rules.__getitem__) == order


def test_masks_agree_with_induced_subgraphs(taught: tuple[LanguageLearner, bool]) -> None:
    """Validation by masks (5.3.4) and by NetworkX on hypothesis graphs (4.6) give the same verdict on single events."""
    learner, verb_last = taught
    verdicts = set()
    for lesson in lessons(3, 12, verb_last):
        count, places = len(lesson.percept.object_ids), len(lesson.percept.placements)
        others = [
            replace(lesson.shown, moved=(lesson.shown.moved + 1) % count),
            replace(lesson.shown, placement=((lesson.shown.placement or 0) + 1) % places, action=MOVE),
        ]
        for reading in readings(learner, lesson)[:3]:
            tree = reading.item.tree()
            if tree.label != "event" or any(node.label in ("location", "reference") for node in tree.nodes()):
                continue
            for show in (lesson.shown, *others):
                if show.placement is not None and lesson.percept.support[show.placement] == show.moved:
                    continue  # nothing is put onto itself
                verdict = VisionTree.of(show).matches(reading)
                assert verdict == is_validated(tree, lesson.percept, show), tree.draw(lesson.words)
                verdicts.add(verdict)
    assert verdicts == {True, False}


def test_learning_is_the_same_again_from_saved_language() -> None:
    first, second = lessons(5, 40), lessons(6, 20)
    straight = LanguageLearner()
    teach(straight, first + second)
    half = LanguageLearner()
    teach(half, first)
    resumed = LanguageLearner.from_json(half.to_json())
    teach(resumed, second)
    for word in COLOURS:
        # Saved counts are rounded to a thousandth.
        assert resumed.grounding.meanings(word) == pytest.approx(straight.grounding.meanings(word), abs=0.05)


def test_a_sequence_reads_as_the_action_it_amounts_to() -> None:
    learner = LanguageLearner()
    red, blue = Concept("colour", 0), Concept("colour", 1)
    for word, concept in (
        ("take", Concept("action", TAKE)), ("drop", Concept("action", 2)), ("red", red), ("blue", blue),
        ("on", Concept("direction", ABOVE)), ("it", Concept("reference", 1)),
    ):  # fmt: skip
        learner.grounding.add(word, concept, 20.0)
    learner.grammar.add_rule("command", ("sequence",), 5.0)
    learner.grammar.add_rule("event", ("action", "entity", "destination"), 5.0)
    blocks = [(0, 0, 0, 0, 0), (2, 2, 0, 1, 0)]
    lesson = Lesson(("take", "red", "drop", "it", "on", "blue"), percept_of_blocks(blocks), shown(blocks, 0, (2, 2)))
    best = readings(learner, lesson)[0]
    assert (best.action, best.moved, best.item.label) == (MOVE, 0b01, "sequence")
    assert VisionTree.of(lesson.shown).matches(best)
    assert [leaf.concept and leaf.concept.space for leaf in best.item.leaves()] == [
        "action", "colour", "action", "reference", "direction", "colour",
    ]  # fmt: skip


def test_only_clear_objects_are_moved_and_nothing_onto_itself() -> None:
    learner = LanguageLearner()
    for word, concept in (
        ("move", Concept("action", MOVE)), ("red", Concept("colour", 0)), ("on", Concept("direction", ABOVE)),
    ):  # fmt: skip
        learner.grounding.add(word, concept, 20.0)
    # Two red blocks, one of them under a blue one: only the clear one can be moved, and not onto itself.
    blocks = [(0, 0, 0, 0, 0), (0, 0, 1, 1, 0), (2, 2, 0, 0, 0)]
    percept = percept_of_blocks(blocks)
    for reading in readings(learner, Lesson(("move", "red"), percept, shown(blocks, 2, None))):
        assert reading.moved == 0b100
    assert readings(learner, Lesson(("move", "red", "on", "red"), percept, shown(blocks, 2, None))) == []
