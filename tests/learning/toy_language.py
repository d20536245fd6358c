"""A toy language over hand-made boards, in two word orders, that takes a learner a hundred demos."""

from dataclasses import dataclass

import numpy as np

from learning.grammar.actions import ActionTable
from learning.grammar.scene import SceneSets
from learning.grounding.language_learner import LanguageLearner
from learning.percept import Percept, ShownAction
from tests.learning.scenes import DROP, MOVE, SIDE, TAKE, Block, percept_of_blocks, shown

ACTIONS = ActionTable(
    starts_held={TAKE: False, DROP: True, MOVE: False},
    ends_held={TAKE: True, DROP: False, MOVE: False},
    composed={(TAKE, DROP): MOVE},
)
COLOURS = ("rosso", "blu", "verde", "giallo")
SHAPES = ("cubo", "prisma")


@dataclass(frozen=True)
class Lesson:
    """A sentence about a scene and what was shown."""

    words: tuple[str, ...]
    percept: Percept
    shown: ShownAction


def random_blocks(rng: np.random.Generator, count: int = 6) -> list[Block]:
    """Blocks of different looks in columns of their own."""
    looks = [(c, s) for c in range(len(COLOURS)) for s in range(len(SHAPES))]
    cells = rng.permutation(SIDE * SIDE)[:count]
    chosen = rng.permutation(len(looks))[:count]
    return [(int(c) // SIDE, int(c) % SIDE, 0, *looks[k]) for c, k in zip(cells, chosen, strict=True)]


def random_lesson(rng: np.random.Generator, verb_last: bool = False) -> Lesson:
    """A take, or a move of one block onto another, in words."""
    blocks = random_blocks(rng)
    cubes = [i for i, block in enumerate(blocks) if block[4] == 0]
    moved = int(rng.integers(len(blocks)))
    grounds = [i for i in cubes if i != moved]
    if rng.random() < 0.3 or not grounds:
        words = ("la", *_noun(blocks[moved]), "prendi") if verb_last else ("prendi", "la", *_noun(blocks[moved]))
        return Lesson(words, percept_of_blocks(blocks), shown(blocks, moved, None, TAKE))
    ground = grounds[int(rng.integers(len(grounds)))]
    x, y = blocks[ground][:2]
    taken = {block[:2] for block in blocks}
    beside = rng.random() < 0.5 and y + 1 < SIDE and (x, y + 1) not in taken
    onto, where = ((x, y + 1), "accanto") if beside else ((x, y), "sopra")
    if verb_last:
        words = ("la", *_noun(blocks[moved]), "la", *_noun(blocks[ground]), where, "metti")
    else:
        words = ("metti", "la", *_noun(blocks[moved]), where, "la", *_noun(blocks[ground]))
    return Lesson(words, percept_of_blocks(blocks), shown(blocks, moved, onto))


def teach(learner: LanguageLearner, lessons: list[Lesson]) -> int:
    """Give lessons; tell how many were validated."""
    return sum(learner.learn(le.words, le.percept, le.shown, SceneSets(le.percept), ACTIONS) for le in lessons)


def _noun(block: Block) -> tuple[str, str]:
    return COLOURS[block[3]], SHAPES[block[4]]
