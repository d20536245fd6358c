"""What recent sentences turned out to say."""

import numpy as np

from learning.concept_id import Concept
from learning.grammar.arrangement import Arrangement
from learning.grammar.innate import NEAREST, ONE
from learning.grounding.alignment import Observed
from learning.grounding.memory import Episode
from learning.percept import ShownAction

RED = Concept("colour", 0)


def episode(*grounded: tuple[str, Concept | None, float]) -> Episode:
    shown = ShownAction(1, (1,), 0, None, np.zeros(3))
    words = tuple(word for word, _, _ in grounded)
    scene = Arrangement((3,), (0,), (0,), (0,), None)
    return Episode(words, scene, shown, (), Observed((), (), ()), grounded)


def test_what_most_readings_say_is_told_whichever_words_say_it() -> None:
    assert episode(("rosso", RED, 0.3), ("rubino", RED, 0.3), ("vicino", NEAREST, 0.4)).told() == {RED}


def test_what_can_be_said_of_any_scene_is_never_told_for_certain() -> None:
    assert episode(("rosso", RED, 1.0), ("uno", ONE, 1.0)).told() == {RED}
