"""Sentences about tables in two languages, learned from what annotators say: understood again as they are meant."""

import numpy as np
import pytest

from learning.concept_id import Concept
from learning.grounding.scripts import script_of
from learning.grounding.tongue import Tongue
from learning.saying.phrasing import Phrasing
from learning.saying.table_references import TableReferences
from learning.saying.table_speaker import TableSpeaker
from learning.saying.wording import marked
from tests.learning.table_talk import COLOURS, SHAPES, table_talk

DEMOS = 45


@pytest.fixture(scope="module", params=["en", "ar"])
def speaker(request: pytest.FixtureRequest) -> TableSpeaker:
    tongue, phrasing = Tongue(), Phrasing()
    for said, record, scene, _ in table_talk(np.random.default_rng(5), DEMOS, request.param, people=3):
        tongue.learn(said, record, scene)
    tongue.settle()
    for pieces, origin, tree in tongue.heard_lately(DEMOS * 3):
        if tree is not None:
            phrasing.hear(marked(pieces, origin), tree)
    return TableSpeaker(tongue, phrasing)


def test_sentences_are_understood_as_what_was_shown(speaker: TableSpeaker) -> None:
    said = asked = 0
    for _, _, scene, _ in table_talk(np.random.default_rng(11), 25, "en"):
        alike = [looks for looks in scene.looks if looks == scene.looks[0]]
        if len(alike) > 1:
            continue  # nothing tells the thing from its double
        asked += 1
        found = speaker.event(scene)
        if found is not None:
            said += 1
            denotation = TableReferences(scene, (), frozenset(), frozenset()).denotation
            heard = speaker.understand(tuple(found.text.split(" ")), denotation)
            assert heard is not None and heard.action == scene.action and heard.things == 1
    assert said > 0.9 * asked


def test_a_thing_with_a_double_cannot_be_told_by_looks_alone(speaker: TableSpeaker) -> None:
    for _, _, scene, _ in table_talk(np.random.default_rng(3), 60, "en"):
        doubles = [i for i, looks in enumerate(scene.looks) if scene.looks.count(looks) > 1]
        if doubles:
            assert speaker.thing(scene, doubles[0]) is None
            return
    pytest.fail("no scene holds two things that look alike")


def test_only_its_own_language_is_spoken(speaker: TableSpeaker) -> None:
    scripts = set()
    for _, _, scene, _ in table_talk(np.random.default_rng(2), 10, "en"):
        found = speaker.event(scene)
        if found is not None:
            scripts.add(script_of(tuple(found.text.split(" "))))
    assert len(scripts) == 1


def test_adjectives_stand_where_they_were_heard(speaker: TableSpeaker) -> None:
    """English says colour before shape, Arabic after."""
    words = {
        "LATIN": ("red", "apple"),
        "ARABIC": ("التفاحة", "الحمراء"),
    }
    looks = {Concept("colour", COLOURS.index("red")), Concept("shape", SHAPES.index("apple"))}
    for _, _, scene, _ in table_talk(np.random.default_rng(8), 80, "en"):
        index = next((i for i, each in enumerate(scene.looks) if looks <= each), None)
        found = None if index is None or scene.looks.count(scene.looks[index]) > 1 else speaker.thing(scene, index)
        if found is not None and len(found.tree.children) == 2:
            said = found.text.split(" ")
            first, second = words[script_of(tuple(said))]
            assert said.index(first) < said.index(second)
            return
    pytest.fail("no scene holds a single red apple")
