"""Baselines for understanding board commands. They are told the truth of the scenes, which the learner is not.

Each baseline rates every possible outcome in a scene; where several are best the credit is shared, so that accuracy is
the expectation over ties and needs no drawing of lots.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from learning.evaluation.concept_names import true_place
from learning.grounding.ngrams import ngrams_of, words_of
from learning.train_robots.layout import Cell, Layout
from learning.train_robots.release import Command
from learning.train_robots.scene import Scene
from twin.board import CELLS

SMOOTHING = 0.1
"""Pseudo-count of every n-gram with every class in the word baseline."""
LONGEST_NGRAM = 2
"""The word baseline counts words and pairs of words."""
SETTINGS = {
    "random_move": "uniform over all moves that physics allows; a held block goes to any free column",
    "majority_move": "most frequent kind of action, class of moved block and class of landing place in the training "
    "commands; a held block is let go straight down",
    "word_template": f"the template action - moved - landing: naive Bayes over n-grams up to {LONGEST_NGRAM} words "
    f"(smoothing {SMOOTHING}) with the true colours, shapes and places: kind of action from the whole sentence, moved "
    "block from its first half (whole for a take), landing place from its second; a held block is let go straight down",
}


POINTED = ("prism", "sphere")
"""Shapes that nothing can rest on."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """One thing that could be done in a layout: which block, to which cell; None keeps it in the gripper."""

    block: int
    goal: Cell | None


def possible_outcomes(layout: Layout) -> list[Outcome]:
    """List what physics allows: take a clear block, put it on another column without a prism, put a held one down."""
    top: dict[tuple[int, int], int] = {}
    for index, block in enumerate(layout.blocks):
        if index != layout.held:
            column = block.cell[:2]
            if column not in top or layout.blocks[top[column]].cell[2] < block.cell[2]:
                top[column] = index
    goals: dict[tuple[int, int], Cell] = {}
    for column in ((x, y) for x in range(CELLS) for y in range(CELLS)):
        below = None if column not in top else layout.blocks[top[column]]
        if below is None or (below.shape not in POINTED and below.cell[2] + 1 < CELLS):
            goals[column] = (*column, 0 if below is None else below.cell[2] + 1)
    if layout.held is not None:
        return [Outcome(layout.held, goal) for goal in goals.values()]
    outcomes = [Outcome(index, None) for index in top.values()]
    for column, index in top.items():
        outcomes += [Outcome(index, goal) for place, goal in goals.items() if place != column]
    return outcomes


@dataclass(frozen=True, slots=True)
class Candidate:
    """An outcome with its true classes: kind of action, class of the moved block and of what it lands on."""

    outcome: Outcome
    classes: tuple[str, str, str]
    straight_down: bool


class Rating(Protocol):
    """A baseline: how well an outcome suits a sentence."""

    def rate(self, sentence: str, candidate: Candidate) -> float:
        """Rate a candidate; higher is better."""


def baseline_credits(
    scenes: Mapping[int, Scene], learned: Sequence[Command], asked: Sequence[Command]
) -> dict[str, list[float]]:
    """Expected correctness in 0..1 of every asked command, for every baseline.

    Args:
        scenes: All scenes by number.
        learned: Commands to learn from; empty leaves only `random_move`.
        asked: Commands to answer.
    """
    known = [
        (command, _candidate(scene.before, _true_outcome(scene)))
        for command in learned
        if (scene := scenes[command.scene]).one_block
    ]
    ratings: dict[str, Rating] = {"random_move": _Indifferent()}
    if known:
        ratings["majority_move"] = _Majority(known)
        ratings["word_template"] = _WordTemplate(known)
    credit: dict[str, list[float]] = {name: [] for name in ratings}
    candidates = {
        number: [_candidate(scenes[number].before, outcome) for outcome in possible_outcomes(scenes[number].before)]
        for number in {command.scene for command in asked}
    }
    for command in asked:
        scene = scenes[command.scene]
        for name, rating in ratings.items():
            right = _credit(rating, command.sentence, scene, candidates[scene.number]) if scene.one_block else 0.0
            credit[name].append(right)
    return credit


def _credit(rating: Rating, sentence: str, scene: Scene, candidates: Sequence[Candidate]) -> float:
    rates = [rating.rate(sentence, candidate) for candidate in candidates]
    best = max(rates, default=0.0)
    winners = [
        candidate.outcome
        for candidate, rate in zip(candidates, rates, strict=True)
        if math.isclose(rate, best, rel_tol=1e-9, abs_tol=1e-12)
    ]
    return 1.0 / len(winners) if _true_outcome(scene) in winners else 0.0


def _true_outcome(scene: Scene) -> Outcome:
    move = scene.move
    if move is None:
        raise ValueError(f"scene {scene.number} does not move exactly one block")
    return Outcome(move.object_id, None if move.held_at_end else move.goal)


def _candidate(layout: Layout, outcome: Outcome) -> Candidate:
    block = layout.blocks[outcome.block]
    moved = f"{block.colour} {block.shape}"
    if outcome.goal is None:
        return Candidate(outcome, ("take", moved, "gripper"), straight_down=False)
    x, y, z = outcome.goal
    below = next((other for other in layout.blocks if other.cell == (x, y, z - 1)), None)
    landing = true_place(outcome.goal) if below is None else f"{below.colour} {below.shape}"
    held = layout.held is not None
    return Candidate(
        outcome, ("drop" if held else "move", moved, landing), straight_down=held and block.cell[:2] == (x, y)
    )


class _Indifferent:
    """Any move is as good as another."""

    def rate(self, _sentence: str, _candidate: Candidate) -> float:
        return 0.0


class _Majority:
    """The most frequent classes, whatever was said."""

    def __init__(self, known: Sequence[tuple[Command, Candidate]]) -> None:
        self._shares = [Counter(candidate.classes[slot] for _, candidate in known) for slot in range(3)]

    def rate(self, _sentence: str, candidate: Candidate) -> float:
        if candidate.straight_down:
            return math.inf
        return sum(
            math.log(shares[value] + SMOOTHING) for shares, value in zip(self._shares, candidate.classes, strict=True)
        )


class _WordTemplate:
    """Naive Bayes over n-grams: one classifier for each slot of the template, over its part of the sentence."""

    def __init__(self, known: Sequence[tuple[Command, Candidate]]) -> None:
        self._classes: list[Counter[str]] = [Counter() for _ in range(3)]
        self._ngrams: dict[tuple[int, str], Counter[str]] = defaultdict(Counter)
        self._vocabulary: set[str] = set()
        self._seen: tuple[str, dict[tuple[int, str, bool], float]] = ("", {})
        for command, candidate in known:
            for slot, value in enumerate(candidate.classes):
                ngrams = _slot_ngrams(command.sentence, slot, lone=candidate.outcome.goal is None)
                self._vocabulary |= ngrams
                self._classes[slot][value] += 1
                self._ngrams[slot, value].update(ngrams)

    def rate(self, sentence: str, candidate: Candidate) -> float:
        if candidate.straight_down:
            return math.inf
        if self._seen[0] != sentence:
            self._seen = sentence, {}
        known, lone, total = self._seen[1], candidate.outcome.goal is None, 0.0
        for slot, value in enumerate(candidate.classes):
            key = slot, value, lone
            if key not in known:
                known[key] = self._log_probability(slot, value, _slot_ngrams(sentence, slot, lone=lone))
            total += known[key]
        return total

    def _log_probability(self, slot: int, value: str, ngrams: set[str]) -> float:
        seen, counts = self._classes[slot][value], self._ngrams[slot, value]
        likelihood = sum(
            math.log((counts[ngram] + SMOOTHING) / (seen + 2 * SMOOTHING)) for ngram in ngrams & self._vocabulary
        )
        return math.log((seen + SMOOTHING) / self._classes[slot].total()) + likelihood


def _slot_ngrams(sentence: str, slot: int, *, lone: bool) -> set[str]:
    """N-grams of the part of a sentence that fills a slot: action, moved block, landing place."""
    words = words_of(sentence)
    middle = len(words) // 2
    parts = {0: words, 1: words if lone else words[:middle], 2: () if lone else words[middle:]}
    return set(ngrams_of(parts[slot], LONGEST_NGRAM))
