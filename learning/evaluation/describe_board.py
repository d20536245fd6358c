"""Sentences for scenes of a release that were not learned from: are they understood, and are they true?"""

from collections.abc import Callable, Iterable, Iterator, Sequence

import numpy as np

from learning.errors import PerceptionError
from learning.evaluation.describe_report import EVENT, OBJECT, Described
from learning.evaluation.describe_truth import SupervisedReader, TrueBoard
from learning.evaluation.public_tree import PublicNode
from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import BoardElements
from learning.interpretation import Interpreter
from learning.knowledge import Knowledge
from learning.percept import Percept
from learning.perception import percept_of
from learning.saying.speaker import Speaker
from learning.train_robots import Command, Scene, key_frames, observe_before
from twin.board import CELLS, nearest_cell

NO_SENTENCE = "no sentence was found that is read back as it is meant"
MISREAD = "it is read otherwise when the scene is looked at afresh"
AMBIGUOUS = "its parts can also be attached so that it says something else that can be done, or is there"
UNTRUE = "a reader trained on the annotated words finds another, or more, that fits"


class BoardDescriber:
    """Describes scenes and scores what is said."""

    def __init__(
        self,
        knowledge: Knowledge,
        speaker: Speaker,
        reader: SupervisedReader | None,
        rng: np.random.Generator,
    ) -> None:
        """Use this.

        Args:
            knowledge: What was learned, from other scenes.
            speaker: Who speaks.
            reader: Reads by the annotated trees; None without them.
            rng: Source of the noise of perception, and of the choice of objects.
        """
        self.knowledge = knowledge
        self.speaker = speaker
        self.reader = reader
        self.rng = rng
        self._interpreter = Interpreter(knowledge)

    def event(self, scene: Scene) -> Described:
        """Say what a scene shows."""
        move = scene.move
        source, sort = f"scene {scene.number}", "" if move is None else move.kind
        try:
            said = self.speaker.event(key_frames(scene, self.rng))
        except PerceptionError as error:
            return self._unsaid(EVENT, source, sort, f"not perceived: {error}")
        if said is None:
            return self._unsaid(EVENT, source, sort, NO_SENTENCE)
        same = self._does(said.text, scene)
        true, possible = (None, None) if self.reader is None else does_truly(scene, self.reader.commands(said.text))
        cause = MISREAD if not same else UNTRUE if possible is False else AMBIGUOUS if true is False else ""
        return Described(EVENT, "en", source, said.text, same, true, possible, cause, sort)

    def thing(self, scene: Scene, index: int) -> Described:
        """Say where a block of the layout before is."""
        source = f"scene {scene.number}, block {index}"
        board = TrueBoard(scene.before)
        elements = board.scene
        sort = "held" if elements.held >> index & 1 else "free" if elements.clear >> index & 1 else "buried"
        said = self.speaker.thing(observe_before(scene, self.rng), index)
        if said is None:
            return self._unsaid(OBJECT, source, sort, NO_SENTENCE)
        afresh = BoardElements(Arrangement.of(self._percept(scene)), self.knowledge.bearing_shapes())
        shares = self.speaker.heard_thing(said.text, afresh)
        same = bool(shares) and max(shares, key=lambda mask: shares[mask]) == 1 << index
        true = possible = None
        if self.reader is not None:
            masks = {mask for tree in self.reader.things(said.text) if (mask := board.thing(tree))}
            true, possible = masks == {1 << index}, 1 << index in masks
        cause = MISREAD if not same else UNTRUE if possible is False else AMBIGUOUS if true is False else ""
        return Described(OBJECT, "en", source, said.text, same, true, possible, cause, sort)

    def _unsaid(self, what: str, source: str, sort: str, cause: str) -> Described:
        checked = None if self.reader is None else False
        return Described(what, "en", source, "", False, checked, checked, cause, sort)

    def people(self, scene: Scene, commands: Sequence[Command]) -> Iterator[tuple[bool, bool | None]]:
        """The same measures for what people said of a scene: understood by us, and by the reader."""
        for command in commands:
            true = None if self.reader is None else does_truly(scene, self.reader.commands(command.sentence))[0]
            yield self._does(command.sentence, scene), true

    def _percept(self, scene: Scene) -> Percept:
        return percept_of(observe_before(scene, self.rng), self.knowledge.spaces)

    def _does(self, sentence: str, scene: Scene) -> bool:
        """Whether a sentence is understood as the move of a scene."""
        move = scene.move
        found = self._interpreter.interpret(sentence, self._percept(scene))
        if move is None or not found.understood or {goal.object_id for goal in found.goals} != {move.object_id}:
            return False
        position = found.goals[-1].position
        return move.held_at_end if position is None else nearest_cell(position) == move.goal and not move.held_at_end


def does_truly(scene: Scene, trees: Iterable[PublicNode]) -> tuple[bool, bool]:
    """Whether public trees, carried out among the true blocks, allow just the move that a scene shows.

    Returns:
        Whether all of them do that can be carried out, and whether any does.
    """
    move = scene.move
    if move is None:
        return False, False
    wanted = {(move.object_id, None if move.held_at_end else move.goal[0] * CELLS + move.goal[1])}
    board = TrueBoard(scene.before)
    found = [moves for tree in trees if (moves := board.moves(tree))]
    return bool(found) and all(moves == wanted for moves in found), wanted in found


def describe_scenes(
    describer: BoardDescriber,
    scenes: Sequence[Scene],
    *,
    demos: int,
    objects: int,
    rng: np.random.Generator,
    on_done: Callable[[], None] = lambda: None,
) -> list[Described]:
    """Describe random scenes of one moved block each, and a random block of each of other random scenes.

    Args:
        describer: Who describes.
        scenes: Scenes that were not learned from.
        demos: Number of scenes whose event is described.
        objects: Number of blocks that are described, in scenes of their own choice.
        rng: Chooses.
        on_done: Called after each.
    """
    found = []
    usable = [scene for scene in scenes if scene.one_block]
    for index in _choose(len(usable), demos, rng):
        found.append(describer.event(usable[index]))
        on_done()
    for index in _choose(len(usable), objects, rng):
        scene = usable[index]
        found.append(describer.thing(scene, int(rng.integers(len(scene.before.blocks)))))
        on_done()
    return found


def _choose(total: int, count: int, rng: np.random.Generator) -> list[int]:
    """So many of a total, each once before any comes again."""
    chosen: list[int] = []
    while total and len(chosen) < count:
        chosen += [int(index) for index in rng.permutation(total)[: count - len(chosen)]]
    return chosen
