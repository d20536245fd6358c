"""The part of `showtell evaluate execution` that is about robots at tables."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from executor.commands.output import Output
from executor.execution.answer import OnAmbiguous

if TYPE_CHECKING:
    from executor.execution.evaluation.case import Suite
    from executor.execution.evaluation.endurance import Endurance
    from executor.execution.evaluation.learned import Learned
    from executor.execution.evaluation.verdict import Verdict


@dataclass(frozen=True, slots=True)
class TableExam:
    """What is asked of a robot at its table.

    Attributes:
        robot: `baxter` or `mico_segway`.
        language: Language of the sentences.
        seed: Seed of scenes, sentences and noise.
    """

    robot: str
    language: str
    seed: int

    def learned(
        self, out: Output, knowledge: Path | None, cache: Path | None, demos: int | None, jobs: int
    ) -> "Learned":
        """What is known before: what somebody brings, or what the robot's scripted collection teaches.

        Raises:
            InputError: Nobody speaks the language, or there is no such file.
        """
        from executor.errors import InputError
        from executor.execution.evaluation.learned import given
        from executor.files import existing
        from executor.tables.learned import LANGUAGES, from_table_collection, usual_demos

        if self.language not in LANGUAGES:
            raise InputError(f"--language {self.language!r}: people at tables speak {', '.join(LANGUAGES)}")
        if knowledge is not None:
            return given(existing(knowledge, "knowledge file"), "table")
        with out.progress("showing and learning, once", usual_demos(self.robot, demos)) as advance:
            return from_table_collection(self.robot, cache, demos, 0, jobs, advance)

    def verdicts(
        self,
        out: Output,
        learned: "Learned",
        commands: int | None,
        sentences: Path | None,
        suite: "Suite | None",
        on_ambiguous: OnAmbiguous,
        clear: bool,
        jobs: int,
    ) -> "list[Verdict]":
        """Carry out commands: written ones, as far as there are any, those of a suite, or new ones.

        Raises:
            InputError: The file of sentences cannot be used; says why.
        """
        from executor.files import existing
        from executor.tables.exam import TableTrial, answers
        from executor.tables.written_commands import written_commands

        if sentences is not None:
            count = len(written_commands(self.robot, existing(sentences, "file of sentences")))
            count = count if commands is None else min(count, commands)
        else:
            count = commands or (100 if suite is None else 50)
        trials = [
            TableTrial(
                self.robot,
                str(learned.path),
                self.seed,
                number,
                self.language,
                learned.heard,
                suite,
                on_ambiguous,
                clear,
                sentences,
            )
            for number in range(count)
        ]
        with out.progress("commands", count) as advance:
            return [each.verdict() for each in answers(trials, jobs, advance)]

    def endured(self, learned: "Learned", minutes: float, on_minute: Callable[[], None]) -> "Endurance":
        """Give commands without a pause."""
        from executor.tables.endurance import endure_at_table

        return endure_at_table(self.robot, learned.path, minutes, self.seed, self.language, on_minute)
