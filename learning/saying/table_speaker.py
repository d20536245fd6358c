"""Sentences about tables in any language heard there, said only if they are understood as they are meant."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import islice
from typing import TypeVar

from learning.concept_id import ACTION_SPACE, REFERENCE, Concept
from learning.grammar.rcl import RclNode
from learning.grounding.table_scene import TableScene
from learning.grounding.tongue import Tongue
from learning.saying.ordering import meaning, said_together
from learning.saying.phrasing import Phrasing
from learning.saying.reference import Destination, Reference
from learning.saying.saying import Saying
from learning.saying.table_references import TableReferences, leaf
from learning.saying.table_understanding import TableDenotation, TableUnderstanding
from learning.saying.wording import Wording, different, wording

TRIED = 16
"""Sentences that are read back before one is given up."""
COMBINED = 6
"""Ways to tell each part that are combined."""
PUT_INTO_WORDS = 80
"""Ways to tell a part that are put into words."""
Part = TypeVar("Part", Reference, Destination)
WHERE = 10.0
"""How much better, in log probability, a phrase is that tells where a thing is, when that is asked."""


class TableSpeaker:
    """Says in one language what was shown at a table, and where things are."""

    def __init__(self, tongue: Tongue, phrasing: Phrasing) -> None:
        """Speak by what was learned of a language; it is not changed."""
        self.tongue = tongue
        self.phrasing = phrasing
        self._named = frozenset(concept for concept in phrasing.names if phrasing.names_of(concept))
        self._together = said_together(tongue.grammar, "entity")
        self._placed = said_together(tongue.grammar, "spatial-relation")

    def event(self, scene: TableScene) -> Saying | None:
        """Say what was shown; None where no sentence was found that is understood so."""
        references = self._references(scene)
        moved, denotation = scene.moved, references.denotation
        things = self._likeliest(each for each in references.of_thing(moved) if each.mask == 1 << moved)
        goals: list[Destination | None] = [*self._goals(references)] or [None]
        wordings = (
            said
            for thing in things
            for goal in goals
            for tree in _commands(scene, thing, goal)
            if (said := self._say(tree)) is not None
        )
        for number, said in enumerate(different(wordings, TRIED), start=1):
            meant, heard = denotation.understand(said.tree), self.understand(said.words, denotation)
            if heard is not None and same_event(heard, meant):
                return Saying(said.text, said.tree, said.score, 1.0, number)
        return None

    def _goals(self, references: TableReferences) -> list[Destination]:
        """The likeliest ways to tell where the moved thing goes: by what it ends on or nearest to, if that can be."""
        scene = references.scene
        found = references.destinations(scene.moved)
        near = [each for each in found if scene.ground is not None and each.mask == 1 << scene.ground]
        return self._likeliest(near) or self._likeliest(found)

    def thing(self, scene: TableScene, thing: int) -> Saying | None:
        """Say where a thing is, so that it is told from all others; None where no phrase was found that does."""
        references = self._references(scene)
        wordings = []
        for each in islice((r for r in references.of_thing(thing) if r.mask == 1 << thing), PUT_INTO_WORDS):
            said = self._say(each.tree)
            if said is not None:
                wordings.append(replace(said, score=said.score + WHERE) if each.located else said)
        for number, said in enumerate(different(wordings, TRIED), start=1):
            if self.denoted(said.words, references.denotation) == 1 << thing:
                return Saying(said.text, said.tree, said.score, 1.0, number)
        return None

    def understand(self, words: tuple[str, ...], denotation: TableDenotation) -> TableUnderstanding | None:
        """What a command says in a scene, by its likeliest tree; None where it has none."""
        tree = self.tongue.parse(words)
        return None if tree is None else denotation.understand(tree)

    def denoted(self, words: tuple[str, ...], denotation: TableDenotation) -> int:
        """What a phrase about a thing denotes, as a mask: it is heard as what an action is done to."""
        verb = next((name for name in self._verbs()), None)
        tree = None if verb is None else self.tongue.parse((verb, *words))
        return 0 if tree is None else denotation.understand(tree).things

    def _verbs(self) -> Iterator[str]:
        """Names of actions that are done to a thing where it is, the most frequent first."""
        actions = [concept for concept in self._named if concept.space == ACTION_SPACE]
        actions.sort(key=lambda concept: -sum(self.phrasing.names[concept].values()))
        for concept in actions:
            yield from (name for name, _ in self.phrasing.names_of(concept) if " " not in name)

    def _references(self, scene: TableScene) -> TableReferences:
        return TableReferences(scene, self._named, self._together, self._placed)

    def _say(self, tree: RclNode) -> Wording | None:
        return wording(tree, self.tongue.grammar, self.phrasing)

    def _likeliest(self, parts: Iterable[Part]) -> list[Part]:
        rated = [(said.score, part) for part in islice(parts, PUT_INTO_WORDS) if (said := self._say(part.tree))]
        return [part for _, part in sorted(rated, key=lambda each: -each[0])[:COMBINED]]


def same_event(one: TableUnderstanding, other: TableUnderstanding) -> bool:
    """Whether two understandings are of one event: action, thing and where it goes."""
    return (one.action, one.things, one.goal) == (other.action, other.things, other.goal)


def _commands(scene: TableScene, thing: Reference, goal: Destination | None) -> Iterator[RclNode]:
    where = () if goal is None else (meaning("destination", goal.tree),)
    yield meaning("event", leaf(Concept(ACTION_SPACE, scene.action)), thing.tree, *where)
    if goal is None:
        return
    # A part of the action first, then the whole of it with what was spoken of before.
    for part in scene.parts:
        if part != scene.action:
            taking = meaning("event", leaf(Concept(ACTION_SPACE, part)), thing.tree)
            it = meaning("entity", leaf(REFERENCE))
            for whole in scene.parts:
                yield meaning("sequence", taking, meaning("event", leaf(Concept(ACTION_SPACE, whole)), it, *where))
