"""Annotators: people who describe demos, each in their own words."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

Order = Literal["plain", "topic", "destination first", "two steps"]


@dataclass(frozen=True, slots=True)
class Annotator:
    """How a person talks.

    Attributes:
        name: Who it is.
        verbs: What they say for each action; the first most often.
        nouns: What they call a shape, where it is not the usual word.
        colours: What they call a colour, where it is not the usual word.
        relations: What they say for each relation, where it is not the usual one.
        orders: How they build sentences.
        polite: What they may add, and how often.
        beside: How often they say only that something is next to another thing.
        brief: How often they leave out the colour where the shape is enough, or the shape where the colour is.
        located: How often they say where a thing is or what it is beside.
        sized: How often they say the size, of things that come in sizes.
        wrong: How often they make a mistake.
    """

    name: str
    verbs: Mapping[str, tuple[str, ...]]
    nouns: Mapping[str, str] = field(default_factory=dict)
    colours: Mapping[str, str] = field(default_factory=dict)
    relations: Mapping[str, str] = field(default_factory=dict)
    orders: tuple[Order, ...] = ("plain",)
    polite: tuple[str, float] = ("", 0.0)
    beside: float = 0.0
    brief: float = 0.2
    located: float = 0.05
    sized: float = 0.1
    wrong: float = 0.04


def choose(words: tuple[str, ...], rng: np.random.Generator) -> str:
    """The first of some words most often."""
    if len(words) == 1 or rng.random() < 0.6:
        return words[0]
    return words[1 + int(rng.integers(len(words) - 1))]


def misspelt(text: str, rng: np.random.Generator) -> tuple[str, str]:
    """A sentence with two letters of one word swapped, and what was done."""
    words = text.split(" ")
    long = [number for number, word in enumerate(words) if len(word) >= 4 and word.isalpha()]
    if not long:
        return text, ""
    number = long[int(rng.integers(len(long)))]
    word = words[number]
    at = int(rng.integers(1, len(word) - 2))
    typo = word[:at] + word[at + 1] + word[at] + word[at + 2 :]
    if typo == word:
        return text, ""
    words[number] = typo
    return " ".join(words), f"typo: {typo} for {word}"
