"""A dialogue: one line, one answer; what was done can be undone or marked as wrong, and questions can be answered."""

from collections.abc import Callable
from pathlib import Path

from executor.execution.answer import Answer
from executor.execution.knowledge_lock import changing
from executor.executor import Executor
from executor.report import ExecutionReport

UNDO, WRONG, HELP, END = "undo", "wrong", "help", ("quit", "exit")
HELP_TEXT = (
    "say what to do; `undo` puts the world back to before the last command, `wrong` says that what was done is not "
    "what was said, a number answers a question, `quit` ends"
)


class Session:
    """A dialogue with one executor.

    Args:
        executor: Who does what is said.
        knowledge: File of its knowledge: where marks are kept.
        on_report: Called with every report.
    """

    def __init__(
        self,
        executor: Executor,
        knowledge: Path | None = None,
        on_report: Callable[[ExecutionReport], None] = lambda report: None,
    ) -> None:
        self.executor = executor
        self.knowledge = knowledge
        self.last: ExecutionReport | None = None
        self._on_report = on_report

    def answer(self, line: str) -> str | None:
        """Answer one line; None ends the dialogue."""
        line = line.strip()
        if not any(letter.isalnum() for letter in line):
            return ""
        word = line.lower().lstrip(":")
        if word in END:
            return None
        if word == HELP:
            return HELP_TEXT
        if word == UNDO:
            undone = self.executor.undo()
            return "there is nothing to undo" if undone is None else f"undone: {undone}"
        if word == WRONG:
            return self.mark_wrong()
        if word.isdecimal() and self.last is not None and (self.last.answer is Answer.AMBIGUOUS or self.last.suggested):
            return self._chosen(int(word), self.last)
        return self._told(self.executor.execute(line))

    def _chosen(self, number: int, asked: ExecutionReport) -> str:
        choices = asked.suggested or asked.options
        if not 1 <= number <= len(choices):
            return f"there is no choice {number}; say 1 to {len(choices)}"
        if asked.suggested:
            return self._told(self.executor.execute(asked.suggested[number - 1].sentence))
        return self._told(self.executor.execute(asked.sentence, choice=asked.options[number - 1].thing))

    def _told(self, report: ExecutionReport) -> str:
        self.last = report
        self._on_report(report)
        names = [each.word for each in report.suggested]
        if report.answer is Answer.AMBIGUOUS:
            names = [option.name for option in report.options]
        lines = [f"{report.answer}: {report.reason}"]
        return "\n".join(lines + [f"  {number}. {name}" for number, name in enumerate(names, start=1)])

    def mark_wrong(self) -> str:
        """Mark what was done last as wrong, in the knowledge in use and its file, and undo it; tells how that went."""
        if self.last is None or not self.last.answer.moved:
            return "nothing was done that could be wrong"
        sentence = self.last.sentence
        otherwise = self.executor.mark_wrong(self.executor.knowledge)
        if self.knowledge is not None:
            with changing(self.knowledge) as kept:
                self.executor.mark_wrong(kept)
        undone = self.executor.undo()
        self.last = None
        learned = "I will understand it otherwise" if otherwise else "I trust these words less"
        return f"“{sentence}”: {learned}" + ("" if undone is None else "; the world is as it was before")
