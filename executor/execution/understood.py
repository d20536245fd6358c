"""One step of a command as it was understood in the scene as it is seen: what an executor acts on, or answers with."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from executor.execution.answer import Answer
from learning.grammar.rcl import RclNode

if TYPE_CHECKING:
    from learning.interpretation import Goal


@dataclass(frozen=True, slots=True)
class Referent:
    """Words that speak of something, and of what.

    Attributes:
        role: Part of the tree that the words are: `entity`, or `destination`.
        words: The words.
        first: First of them in the sentence, from 1.
        last: Last of them.
        things: Track numbers of what they may mean; of a place, of what is there.
    """

    role: str
    words: str
    first: int
    last: int
    things: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Option:
    """One of several things that fit the words.

    Attributes:
        thing: Its track number.
        name: Words that tell it from the others.
    """

    thing: int
    name: str


@dataclass(frozen=True, slots=True)
class Understood:
    """How one step was understood.

    Attributes:
        words: Its words.
        answer: Why it is not acted on; None where it can be.
        reason: The same in plain words.
        heard: What each word was understood as, in plain words.
        tree: The RCL tree, None when nothing was understood.
        goals: What to do, in order.
        referents: What the words speak of.
        options: What to choose between, where the answer is `AMBIGUOUS`.
        unknown: Words that were never heard, or not understood yet.
        blocked: Track numbers of what is in the way, the first to be moved first; `goals` hold once it is gone.
        share: How sure the reading is, 0..1.
    """

    words: tuple[str, ...]
    answer: Answer | None
    reason: str
    heard: str = ""
    tree: RclNode | None = None
    goals: "tuple[Goal, ...]" = ()
    referents: tuple[Referent, ...] = ()
    options: tuple[Option, ...] = ()
    unknown: tuple[str, ...] = ()
    blocked: tuple[int, ...] = ()
    share: float = 0.0

    @property
    def clear(self) -> bool:
        """Whether it can be acted on as it is."""
        return self.answer is None


def quoted(words: tuple[str, ...]) -> str:
    """Write words in quotation marks."""
    return ", ".join(f"“{word}”" for word in words)


def offer(unknown: tuple[str, ...]) -> str:
    """Name words that were never heard, and offer to be shown."""
    them = "it" if len(unknown) == 1 else "them"
    return f"I never heard {quoted(unknown)}; show me: record a demo and say {them}"


def offer_again(word: str, heard: float) -> str:
    """Name a word that was heard and not understood, and offer to be shown again."""
    times = "once" if heard <= 1.0 else f"{heard:.0f} times"
    return f"I heard “{word}” {times} and do not understand it yet; show me again: record a demo and say it"


def question(said: str, options: tuple[Option, ...]) -> str:
    """Ask which of several things is meant."""
    names = [option.name for option in options]
    many = f"{len(names)} things fit {said}" if said else f"{len(names)} things fit"
    return f"{many}: which one, {', '.join(names[:-1])} or {names[-1]}?"


def parts(tree: RclNode | None, label: str, beside: tuple[str, ...] = ()) -> Iterator[RclNode]:
    """Walk the uppermost nodes of a label that are not inside a node of one of the labels `beside`."""
    if tree is None or tree.label in beside:
        return
    if tree.label == label:
        yield tree
        return
    for child in tree.children:
        yield from parts(child, label, beside)
