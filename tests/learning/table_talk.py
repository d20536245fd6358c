"""Symbolic scenes of tables with what annotators say of them, for tests: no physics, no pictures."""

from collections.abc import Iterator

import numpy as np

from learning.concept_id import Concept
from learning.grounding.ngrams import words_of
from learning.grounding.table_scene import BESIDE, OVER, SIDE_PLACES, TableRecord, TableScene
from teleop.annotators.facts import Destination, Relation, TableAction, TableFacts, Thing
from teleop.annotators.telling import tell_table

COLOURS = ("red", "blue", "green", "yellow")
SHAPES = ("cube", "apple", "bowl", "mug", "fork")
ACTIONS: dict[TableAction, tuple[int, tuple[int, ...]]] = {
    "pick up": (1, (1,)),
    "put down": (2, (2,)),
    "move": (3, (1, 2, 3)),
}
SIDES: tuple[Relation, ...] = ("left", "right", "front", "behind")


def table_talk(
    rng: np.random.Generator, count: int, language: str, people: int = 4, inside: float = 0.0
) -> Iterator[tuple[list[tuple[str, ...]], TableRecord, TableScene, TableAction]]:
    """Words of sentences, what was shown (nothing measured, and in symbols), and the action, of some demos.

    A share `inside` of the things that are not brought to a corner is brought into another.
    """
    nothing = np.zeros((0, 3))
    for _ in range(count):
        things = tuple(
            Thing(index, str(rng.choice(SHAPES)), str(rng.choice(COLOURS)), 0.65, 0.4 * index) for index in range(4)
        )
        action = list(ACTIONS)[int(rng.integers(len(ACTIONS)))]
        side = int(rng.integers(4))
        by_place = rng.random() < 0.3
        into = inside > 0.0 and rng.random() < inside
        relation: Relation = "in" if into else SIDES[side]
        goal = Destination(place=("top", "left")) if by_place else Destination(relation=relation, reference=1)
        reached = frozenset((OVER,)) if into else frozenset((Concept("direction", side), BESIDE))
        facts = TableFacts(action, things[0], things, None if action == "pick up" else goal, action == "put down")
        number, parts = ACTIONS[action]
        goes = action != "pick up"
        scene = TableScene(
            looks=tuple(
                frozenset((Concept("colour", COLOURS.index(each.colour)), Concept("shape", SHAPES.index(each.shape))))
                for each in things
            ),
            places=(frozenset(),) * 4,
            relations={},
            moved=0,
            action=number,
            parts=parts,
            goal=frozenset((SIDE_PLACES[0], SIDE_PLACES[2])) if goes and by_place else frozenset(),
            goal_relations={1: reached} if goes and not by_place else {},
            ground=1 if goes and not by_place else None,
            unseen={},
        )
        record = TableRecord({}, nothing, nothing, 0, action == "put down", goes, number, parts)
        said = [words_of(told.text) for told in tell_table(facts, people, language, rng)]
        yield said, record, scene, action
