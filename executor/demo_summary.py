"""What a collection of demos amounts to, as table 6.1 of the thesis has it."""

import re
from collections.abc import Iterable
from dataclasses import dataclass

from teleop import Demo

FRAMES = 10.0
"""Frames a second that perception takes from a demo."""
_WORD = re.compile(r"[^\W\d_]+(?:'[^\W\d_]+)?")


@dataclass(frozen=True, slots=True)
class DemoSummary:
    """A row of table 6.1.

    Attributes:
        clips: Demos.
        frames: Frames in all, at 10 Hz.
        commands: Sentences in all.
        words: Different words in them.
        objects: Objects in a scene, on average.
        seconds: Length of a demo, on average [s].
    """

    clips: int
    frames: int
    commands: int
    words: int
    objects: float
    seconds: float


def summarise(demos: Iterable[Demo], language: str | None = None) -> DemoSummary:
    """Count what demos hold; each is looked at once.

    Args:
        demos: The demos.
        language: Count sentences of this language only (BCP 47); None takes all.
    """
    clips = frames = commands = objects = 0
    seconds = 0.0
    words: set[str] = set()
    for demo in demos:
        sentences = demo.utterances if language is None else demo.utterances_in(language)
        clips += 1
        frames += round(demo.duration * FRAMES)
        seconds += demo.duration
        commands += len(sentences)
        objects += len(demo.scene.objects)
        words.update(word.lower() for sentence in sentences for word in _WORD.findall(sentence))
    count = max(clips, 1)
    return DemoSummary(clips, frames, commands, len(words), objects / count, seconds / count)
