"""What the page is told of a conversation, whole: a message that is lost is made good by the next."""

from dataclasses import asdict, dataclass, field
from typing import Literal

from executor.talk.marks import Mark
from executor.talk.plan_words import PlanLine
from executor.talk.said_words import SaidWord

Phase = Literal["idle", "thinking", "moving"]


@dataclass(frozen=True, slots=True)
class Answered:
    """How a command was answered.

    Attributes:
        kind: Value of an `Answer`, or `undone`.
        text: The same in plain words.
        options: What to choose between, by track number and name.
        unknown: Words that were never heard, or not understood yet.
        note: How words that were never heard were taken; `text` says it, too.
        spellings: What may have been meant instead of a word that was never heard: word and sentence.
        can_be_wrong: Whether something was done that may be marked as wrong.
    """

    kind: str
    text: str
    options: tuple[tuple[int, str], ...] = ()
    unknown: tuple[str, ...] = ()
    note: str = ""
    spellings: tuple[tuple[str, str], ...] = ()
    can_be_wrong: bool = False


@dataclass(frozen=True, slots=True)
class Lesson:
    """What came of learning a demo.

    Attributes:
        demo: Its name.
        sentences: Sentences heard with it.
        error: Why nothing was learned; empty if something was.
        before: Whether it was learned before, so that there is nothing new in it.
    """

    demo: str
    sentences: int = 0
    error: str = ""
    before: bool = False


@dataclass(frozen=True, slots=True)
class TalkState:
    """How a conversation stands.

    Attributes:
        file: Name of the knowledge file.
        number: Counts the changes.
        phase: Whether a command is read or carried out now.
        sentence: The command that this is about.
        choice: Thing that was chosen where several fit it.
        words: Its words.
        answer: How it was answered; None while that is not known.
        plan: What is done for it, in order.
        done: How many lines of the plan have begun.
        marks: What is marked in the picture.
        undo: Commands that can be undone.
        learning: Demo that is being learned, or empty.
        lesson: What came of the last one.
    """

    file: str
    number: int = 0
    phase: Phase = "idle"
    sentence: str = ""
    choice: int | None = None
    words: tuple[SaidWord, ...] = ()
    answer: Answered | None = None
    plan: tuple[PlanLine, ...] = ()
    done: int = 0
    marks: list[Mark] = field(default_factory=list)
    undo: int = 0
    learning: str = ""
    lesson: Lesson | None = None

    def to_dict(self) -> dict[str, object]:
        """Plain values for the page."""
        return {"type": "talk", **asdict(self)}
