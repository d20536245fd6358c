"""Sentences for demos at a table that were not learned from: are they understood, and are they true?"""

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from learning.errors import PerceptionError
from learning.evaluation.concepts_truth import TrueDemo, table_side
from learning.evaluation.describe_report import EVENT, OBJECT, Described
from learning.evaluation.public_tree import PublicNode
from learning.evaluation.table_exam import SpokenDemo
from learning.evaluation.table_gold import gold_sentence
from learning.evaluation.table_vocabulary import CLOSE
from learning.grounding.ngrams import words_of
from learning.knowledge import Knowledge
from learning.saying.speaker import shown_scene, still_scene
from learning.saying.table_speaker import TableSpeaker
from learning.saying.table_understanding import TableDenotation
from robots.pose import FloatArray
from teleop.annotators import arabic, english, place_at

LANGUAGES = {"LATIN": "en", "ARABIC": "ar"}
"""Tag by which annotators know the language of a script."""
BESIDE = 0.26
"""What annotators call beside is no farther away than this [m]."""
OVER = 0.06
"""What is on or in a thing is so near to it, seen from above [m]."""
NO_SENTENCE = "no sentence was found that is read back as it is meant"
MISREAD = "it is read otherwise"
UNTRUE = "by the annotators' words it is not true, or of more than one thing"
NO_WORD = "annotators do not speak so"
NOT_SEEN = "what was done was not seen"


class TableDescriber:
    """Describes demos in one language and scores what is said."""

    def __init__(self, knowledge: Knowledge, script: str) -> None:
        """Use what was learned from other demos."""
        self.knowledge = knowledge
        self.speaker = TableSpeaker(knowledge.table_language.tongues[script], knowledge.phrasings.by_script[script])
        self.language = LANGUAGES.get(script, script.lower())

    def event(self, spoken: SpokenDemo, source: str) -> Described:
        """Say what a demo shows."""
        demo = spoken.demo
        sort = demo.truth.action or ""
        try:
            scene = shown_scene(self.knowledge, demo.observation)
        except PerceptionError as error:
            return Described(EVENT, self.language, source, "", False, False, False, f"{NOT_SEEN}: {error}", sort)
        said = self.speaker.event(scene)
        if said is None:
            return Described(EVENT, self.language, source, "", False, False, False, NO_SENTENCE, sort)
        denotation = TableDenotation(scene)
        heard, meant = (
            self.speaker.understand(words_of(said.text), denotation),
            denotation.understand(said.tree),
        )
        same = heard is not None and (heard.action, heard.things, heard.goal) == (
            scene.action,
            1 << scene.moved,
            meant.goal,
        )
        why = _event_is_untrue(said.text, self.language, demo.truth)
        return Described(
            EVENT, self.language, source, said.text, same, not why, not why, MISREAD if not same else why, sort
        )

    def thing(self, spoken: SpokenDemo, index: int, source: str) -> Described:
        """Say where a thing is before the action."""
        scene = still_scene(self.knowledge, spoken.demo.observation)
        said = self.speaker.thing(scene, index)
        if said is None:
            return Described(OBJECT, self.language, source, "", False, False, False, NO_SENTENCE)
        same = self.speaker.denoted(words_of(said.text), TableDenotation(scene)) == 1 << index
        why = _thing_is_untrue(said.text, self.language, spoken.demo.truth, index)
        cause = why if same else MISREAD
        return Described(OBJECT, self.language, source, said.text, same, not why, not why, cause)


def describe_demos(
    knowledge: Knowledge,
    demos: Sequence[tuple[int, SpokenDemo]],
    *,
    objects: int,
    rng: np.random.Generator,
    on_done: Callable[[], None] = lambda: None,
) -> list[Described]:
    """Describe demos, and so many random things seen in them, in every language.

    Args:
        knowledge: What was learned from other demos.
        demos: Numbered demos.
        objects: Number of things.
        rng: Chooses things.
        on_done: Called after each demo and each thing.
    """
    describers = [TableDescriber(knowledge, script) for script in sorted(knowledge.phrasings.by_script)]
    found = []
    for number, demo in demos:
        found += [each.event(demo, f"demo {number}") for each in describers]
        on_done()
    for turn in range(objects if demos else 0):
        number, demo = demos[turn % len(demos)]
        seen = [index for index, colour in enumerate(demo.demo.truth.properties["colour"]) if colour is not None]
        if seen:
            index = seen[int(rng.integers(len(seen)))]
            found += [each.thing(demo, index, f"demo {number}, object {index}") for each in describers]
        on_done()
    return found


def _event_is_untrue(text: str, language: str, truth: TrueDemo) -> str:
    """Say in what way a sentence is not true of a demo, by the words of the annotators; empty when it is true."""
    moved = int(np.nanargmax(np.linalg.norm(truth.last - truth.first, axis=1)))
    reasons = [_command(tree, truth, moved) for tree in _trees(text, language, truth.action or "")]
    if not reasons:
        return NO_WORD
    return "" if "" in reasons else UNTRUE


def _thing_is_untrue(text: str, language: str, truth: TrueDemo, index: int) -> str:
    verb = {"en": "pick up", "ar": "التقط"}[language]
    found = False
    for tree in _trees(f"{verb} {text}", language, "pick up"):
        found = True
        entity = next((child for child in tree.children if child.label == "entity"), None)
        if entity is not None and _things(entity, truth) == {index}:
            return ""
    return UNTRUE if found else NO_WORD


def _trees(text: str, language: str, action: str) -> Iterator[PublicNode]:
    """Trees of a sentence as each annotator of a language would mean it, if they would say it of that action."""
    people = english.ANNOTATORS if language == "en" else arabic.ANNOTATORS
    verbs = {verb for each in people for verb in each.verbs.get(action, ())} | {
        verb for each in people for verb in each.verbs.get("pick up", ())
    }
    if not any(f" {verb} " in f" {text} " for verb in verbs):
        return
    for each in people:
        for template in ("", "two steps"):
            said = {"text": text, "language": language, "annotator": each.name, "template": template}
            tree = gold_sentence(said, action).tree
            if tree is not None:
                yield tree


def _command(tree: PublicNode, truth: TrueDemo, moved: int) -> str:
    """Why a command does not tell what was done; empty when it does."""
    events = [node for node in tree.nodes() if node.label == "event"]
    entity = next((child for child in events[0].children if child.label == "entity"), None) if events else None
    if entity is None or _things(entity, truth) != {moved}:
        return UNTRUE
    if truth.action not in tree.values("action"):
        return UNTRUE
    for event in events:
        for child in event.children:
            if child.label == "destination" and not _holds(child.children[0], truth, moved, truth.last):
                return UNTRUE
    return ""


def _things(entity: PublicNode, truth: TrueDemo) -> set[int]:
    """Things that an entity is true of before the action; sizes are not looked at."""
    found = set(range(len(truth.first)))
    for child in entity.children:
        if child.label in ("colour", "shape"):
            found &= {index for index, value in enumerate(truth.properties[child.label]) if value == child.value}
        elif child.label == "spatial-relation":
            found = {index for index in found if _holds(child, truth, index, truth.first)}
    return found


def _holds(where: PublicNode, truth: TrueDemo, index: int, places: FloatArray) -> bool:
    """Whether a thing is in a place, or in a relation to the one thing that is told of."""
    here = places[index]
    values = where.values("location")
    if values:
        row, column = place_at(float(here[0]), float(here[1]))
        return all(value in (row, column) or (value == "centre" and column == "middle") for value in values)
    relations = where.values("relation")
    ground = next((child for child in where.children if child.label == "entity"), None)
    grounds = set() if ground is None else _things(ground, truth) - {index}
    if len(grounds) != 1 or not relations:
        return False
    offset = here - places[next(iter(grounds))]
    flat = float(np.linalg.norm(offset[:2]))
    if relations[0] == CLOSE:
        return flat <= BESIDE
    if relations[0] == "above":
        return table_side(offset) == "above" or flat <= OVER
    return table_side(offset) == relations[0]
