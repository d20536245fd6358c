"""What things at a table are called to tell them from others: in learned words, in the language of the question."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from learning.errors import KnowledgeError
from learning.perception.tracks import anchors
from learning.saying.speaker import Speaker

if TYPE_CHECKING:
    from learning import Knowledge
    from learning.perception.observation import Observation


class TableNames:
    """Names things in what was learned.

    Args:
        knowledge: What was learned.
    """

    def __init__(self, knowledge: "Knowledge") -> None:
        self.knowledge = knowledge

    def apart(self, script: str, observation: "Observation", indices: Sequence[int]) -> tuple[str, ...]:
        """Names of several things, each of which tells it from all others; a place where no words do.

        Args:
            script: Script of the language to speak.
            observation: What was seen.
            indices: Indices of the things.
        """
        try:
            speaker: Speaker | None = Speaker(self.knowledge, script)
        except KnowledgeError:  # knowledge that does not say how a language is spoken
            speaker = None
        _, places = anchors(observation)
        names = []
        for index in indices:
            said = None if speaker is None else speaker.thing(observation, index)
            x, y = np.round(100 * places[index, :2]).astype(int).tolist()
            side = f"{abs(y)} cm to the {'left' if y > 0 else 'right'}" if y else "straight ahead"
            names.append(f"the one {x} cm away, {side}" if said is None else said.text)
        return tuple(names)
