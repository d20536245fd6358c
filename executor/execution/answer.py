"""The kinds of answer to a command."""

from enum import StrEnum


class Answer(StrEnum):
    """How a command was answered.

    Only `DONE`, `FAILED`, `UNCERTAIN` and `STOPPED` come after a motion; with all others nothing has moved.
    """

    DONE = "done"
    """The scene is as the sentence says: it was seen."""
    FAILED = "failed"
    """Something was done, and what is seen afterwards is not what the sentence says."""
    UNCERTAIN = "uncertain"
    """Something was done, and a look does not tell whether it came out right."""
    STOPPED = "stopped"
    """The person stopped it on the way."""
    PLANNED = "planned"
    """There is a plan, and no more was asked for."""
    REFUSED = "refused"
    """The words are known, and no command was understood."""
    AMBIGUOUS = "ambiguous"
    """Several things or places fit the words: a question is asked."""
    UNKNOWN_WORD = "unknown-word"
    """A word was never heard, or not understood yet: it is named, and could be shown."""
    IMPOSSIBLE = "impossible"
    """The command was understood and cannot be carried out here: out of reach, blocked, nothing to hold, no room."""

    @property
    def moved(self) -> bool:
        """Whether something was set in motion."""
        return self in (Answer.DONE, Answer.FAILED, Answer.UNCERTAIN, Answer.STOPPED)

    @property
    def good(self) -> bool:
        """Whether what was asked for is there."""
        return self in (Answer.DONE, Answer.PLANNED)


class OnAmbiguous(StrEnum):
    """What to do where several things or places fit the words."""

    ASK = "ask"
    BEST = "best"
