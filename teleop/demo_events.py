"""What is said and what happens in a demo: sentences, events, its outcome, and where it was cut from."""

from dataclasses import dataclass
from typing import Literal

When = Literal["before", "during", "after"]
EventKind = Literal["safety", "stop", "device", "gripper", "operator", "record"]
OutcomeKind = Literal["success", "failure", "unknown"]


@dataclass(frozen=True, slots=True)
class Sentence:
    """A sentence about a demo.

    Attributes:
        text: The sentence.
        step: Control step at which it was said; that of the last one where it was said afterwards.
        when: Before, during or after the demo.
        language: Tag of its language, such as `en` or `ar` (BCP 47); empty where nobody said.
    """

    text: str
    step: int = 0
    when: When = "before"
    language: str = ""


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened while a demo was recorded.

    Attributes:
        step: Control step.
        kind: `safety` (the servo slowed down, stopped, or goes on), `stop` (emergency stop pressed or released),
            `device` (lost or found), `gripper`, `operator` (another one holds control) or `record`.
        text: What happened, for people.
        arm: The arm it concerns, empty for the whole robot.
        wall_ns: When, in nanoseconds since 1970; 0 where it was not kept.
    """

    step: int
    kind: EventKind
    text: str
    arm: str = ""
    wall_ns: int = 0


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a demo ended, in the words of whoever recorded it.

    Attributes:
        outcome: `success`, `failure` or `unknown`.
        note: Why.
    """

    outcome: OutcomeKind = "unknown"
    note: str = ""


@dataclass(frozen=True, slots=True)
class Trim:
    """Where a trimmed demo was cut from.

    Attributes:
        origin: Name of the demo that was recorded.
        first: Its control step that is step 0 here.
        last: Its control step at which this one ends; -1 for its end.
    """

    origin: str
    first: int
    last: int
