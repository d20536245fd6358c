"""Commands that should be answered without a motion: ambiguous ones, impossible ones, and ones with an unknown word."""

from collections.abc import Callable, Collection
from dataclasses import replace

import numpy as np

from executor.errors import InputError
from executor.execution.answer import Answer
from executor.execution.evaluation.board_cases import NEW_SEEDS, board_cases
from executor.execution.evaluation.case import Case, Expected, Suite
from learning.grounding.ngrams import words_of
from teleop.referring import COLOUR_WORDS, DIRECTIONS, SHAPE_WORDS, Board, standing_position
from twin import ObjectSpec, SceneSpec, random_board

TRIES = 4000
SUITES: tuple[Suite, ...] = ("ambiguous", "impossible", "unknown-word")
SYLLABLES = ("bla", "dro", "fim", "gle", "kop", "mur", "nad", "pli", "sot", "vez")

Made = tuple[SceneSpec, str] | None
Maker = Callable[[SceneSpec, Board, np.random.Generator], Made]


def suite_cases(suite: Suite, count: int, seed: int, heard: Collection[tuple[str, ...]] = ()) -> list[Case]:
    """Make the commands of a suite, equally many of each of its kinds.

    Args:
        suite: Which suite.
        count: How many.
        seed: Seed of scenes and sentences.
        heard: Words of the sentences that were learned from.

    Raises:
        InputError: There is no such suite.
    """
    if suite == "unknown-word":
        return _unknown(count, seed, heard)
    if suite not in _MAKERS:
        raise InputError(f"there is no suite {suite!r}: choose from {', '.join(SUITES)}")
    makers = _MAKERS[suite]
    cases: list[Case] = []
    for number in range(TRIES):
        if len(cases) == count:
            break
        kind = list(makers)[len(cases) % len(makers)]
        rng = np.random.default_rng([seed + NEW_SEEDS, 7, number])
        scene = random_board(rng, seed=seed)
        made = makers[kind](scene, Board(scene), rng)
        if made is not None:
            cases.append(Case(number, made[0], made[1], Expected(answer=Answer(suite)), kind))
    return cases


# Ambiguous: two clear blocks that look alike.


def _two_alike(scene: SceneSpec, board: Board, rng: np.random.Generator) -> Made:
    found = _alike(board)
    return (scene, f"take {_look(found[0])}") if found else None


def _two_to_move(scene: SceneSpec, board: Board, rng: np.random.Generator) -> Made:
    found, ground = _alike(board), _only(board, rng, shape="cube")
    if not found or ground is None or _same(ground, found[0]):
        return None
    return scene, f"put {_look(found[0])} on {_look(ground)}"


def _two_to_put_on(scene: SceneSpec, board: Board, rng: np.random.Generator) -> Made:
    found, moved = [each for each in _alike(board) if each.shape == "cube"], _only(board, rng)
    if len(found) < 2 or moved is None or _same(moved, found[0]):
        return None
    return scene, f"put {_look(moved)} on {_look(found[0])}"


# Impossible: nothing like it is there, it is buried, there is no room, the hand is empty or full.


def _not_there(scene: SceneSpec, board: Board, rng: np.random.Generator) -> Made:
    looks = {(each.colour, each.shape) for each in scene.objects}
    absent = [(c, s) for c in COLOUR_WORDS for s in SHAPE_WORDS if (c, s) not in looks]
    if not absent:
        return None
    colour, shape = absent[int(rng.integers(len(absent)))]
    return scene, f"take the {COLOUR_WORDS[colour][0]} {SHAPE_WORDS[shape][0]}"


def _buried(scene: SceneSpec, board: Board, rng: np.random.Generator) -> Made:
    below = [each for each in _unique(board) if not board.clear(each)]
    return (scene, f"take {_look(_one(below, rng))}") if below else None


def _on_a_prism(scene: SceneSpec, board: Board, rng: np.random.Generator) -> Made:
    prism, moved = _only(board, rng, shape="prism"), _only(board, rng)
    if prism is None or moved is None or _same(prism, moved):
        return None
    return scene, f"put {_look(moved)} on {_look(prism)}"


def _on_a_buried_one(scene: SceneSpec, board: Board, rng: np.random.Generator) -> Made:
    below = [each for each in _unique(board) if not board.clear(each) and each.shape == "cube"]
    moved = _only(board, rng)
    if not below or moved is None:
        return None
    ground = _one(below, rng)
    if board.cell[moved.id][:2] == board.cell[ground.id][:2]:
        return None
    return scene, f"put {_look(moved)} on {_look(ground)}"


def _off_the_board(scene: SceneSpec, board: Board, rng: np.random.Generator) -> Made:
    for ground in _unique(board):
        if not board.clear(ground):
            continue
        x, y, _ = board.cell[ground.id]
        for (dx, dy), phrases in DIRECTIONS.items():
            if not (0 <= x + dx < 8 and 0 <= y + dy < 8):
                moved = _only(board, rng)
                if moved is not None and not _same(moved, ground):
                    return scene, f"put {_look(moved)} {phrases[0]} {_look(ground)}"
    return None


def _empty_hand(scene: SceneSpec, board: Board, rng: np.random.Generator) -> Made:
    block = _only(board, rng)
    return None if block is None else (scene, f"drop {_look(block)}")


def _full_hand(scene: SceneSpec, board: Board, rng: np.random.Generator) -> Made:
    held, other = _only(board, rng), _only(board, rng)
    if held is None or other is None or _same(held, other):
        return None
    x, y, z = board.cell[held.id]
    at = standing_position((x, y, 7))
    objects = tuple(each.model_copy(update={"position": at}) if each.id == held.id else each for each in scene.objects)
    update = {"objects": objects, "held": held.id, "gripper_closed": True, "gripper_position": at}
    return scene.model_copy(update=update), f"take {_look(other)}"


_MAKERS: dict[str, dict[str, Maker]] = {
    "ambiguous": {"take": _two_alike, "moved": _two_to_move, "ground": _two_to_put_on},
    "impossible": {
        "not there": _not_there,
        "buried": _buried,
        "on a prism": _on_a_prism,
        "on a buried one": _on_a_buried_one,
        "off the board": _off_the_board,
        "empty hand": _empty_hand,
        "full hand": _full_hand,
    },
}


# Unknown words: one word of a sentence that could be carried out is put in place of another.


def _unknown(count: int, seed: int, heard: Collection[tuple[str, ...]]) -> list[Case]:
    known = {word for words in heard for word in words}
    cases = []
    for case in board_cases(count, seed + 1, 0.0):
        rng = np.random.default_rng([seed, case.number, 3])
        words = case.sentence.split()
        telling = [at for at, word in enumerate(words) if word not in ("the", "of", "that", "is", "to", "and", "it")]
        at = telling[int(rng.integers(len(telling)))]
        strange = ""
        while not strange or strange in known:
            strange = "".join(rng.choice(SYLLABLES, size=int(rng.integers(2, 4))))
        kind = f"instead of {words[at]}"
        words[at] = strange
        expected = Expected(answer=Answer.UNKNOWN_WORD)
        cases.append(replace(case, sentence=" ".join(words), expected=expected, kind=kind))
    return cases


# What a board holds.


def _look(block: ObjectSpec) -> str:
    return f"the {COLOUR_WORDS[block.colour][0]} {SHAPE_WORDS[block.shape][0]}"


def _same(one: ObjectSpec, other: ObjectSpec) -> bool:
    return (one.colour, one.shape) == (other.colour, other.shape)


def _unique(board: Board) -> list[ObjectSpec]:
    """Blocks that are the only ones of their looks."""
    return [each for each in board.blocks if len(board.same_look(each.colour, each.shape)) == 1]


def _only(board: Board, rng: np.random.Generator, shape: str | None = None) -> ObjectSpec | None:
    """A clear block that is the only one of its looks."""
    found = [each for each in _unique(board) if board.clear(each) and shape in (None, each.shape)]
    return _one(found, rng) if found else None


def _alike(board: Board) -> list[ObjectSpec]:
    """Clear blocks that look alike, at least two; or none."""
    for block in board.blocks:
        clear = [each for each in board.same_look(block.colour, block.shape) if board.clear(each)]
        if len(clear) > 1:
            return clear
    return []


def _one(blocks: list[ObjectSpec], rng: np.random.Generator) -> ObjectSpec:
    return blocks[int(rng.integers(len(blocks)))]


def sentences_of(folder_utterances: Collection[str]) -> set[tuple[str, ...]]:
    """Words of sentences, for comparing."""
    return {words_of(sentence) for sentence in folder_utterances}
