"""`Executor`: from a sentence to a changed world, checked by looking."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from executor.errors import InputError
from executor.execution.answer import Answer, OnAmbiguous
from executor.execution.doer import Doer, doer_for
from executor.execution.history import History
from executor.execution.spelling import Spelling, slips_put_right, spellings_of, taken_words
from executor.execution.steps import Step, steps_of
from executor.execution.understood import Understood
from executor.free_memory import give_back_free_memory
from executor.report import ExecutionReport, joined, report_of, spelt
from learning.grounding.ngrams import with_words, words_of

if TYPE_CHECKING:
    from learning import Knowledge
    from twin import World


class Executor:
    """Does on the twin what a sentence says, as far as it was learned.

    Args:
        world: Where to do it.
        knowledge: What was learned.
        rng: Source of the noise of looking; the scene's seed decides when it is left out.
        on_ambiguous: Whether to ask, or take the best, where several things fit the words.
        clear: Whether what is in the way is put aside.

    Attributes:
        last: Track number of what was handled last, which the next command may refer to; None at first.
    """

    def __init__(
        self,
        world: "World",
        knowledge: "Knowledge",
        rng: np.random.Generator | None = None,
        *,
        on_ambiguous: OnAmbiguous | str = OnAmbiguous.ASK,
        clear: bool = False,
    ) -> None:
        """Take a world and what was learned.

        Raises:
            InputError: The world is none that sentences are carried out in yet, or the knowledge was learned on another
                kind of scene; says what to do.
        """
        self.world = world
        self.knowledge = knowledge
        self.rng = np.random.default_rng(world.spec.seed) if rng is None else rng
        self.clear = clear
        self.on_ambiguous = _known(on_ambiguous)
        self.history = History(world)
        self.last: int | None = None
        self._deeds: list[tuple[Understood, object]] = []
        self._doer = doer_for(world, knowledge, self.rng, self.on_ambiguous, clear)

    def execute(self, sentence: str, *, plan_only: bool = False, choice: int | None = None) -> ExecutionReport:
        """Understand a sentence in the scene as it is seen, and do what it says.

        All steps of the sentence are understood before the first motion, each in the world as it should be then, and
        again when it comes to it, in the world as it is. What cannot be understood or done is answered with a reason;
        only a fault in the arguments raises.

        Args:
            sentence: What to do.
            plan_only: Stop after the plan of the first goal; nothing moves.
            choice: Track number of what was meant, as the answer to the question that this sentence had led to.

        Raises:
            InputError: The sentence holds no word.
        """
        doer, (steps, view, spelling) = self._doer, self._understood(sentence, choice)
        trouble = next((step for step in steps if not self._can_act(step.understood)), None)
        if trouble is not None:
            report = report_of(trouble.understood, sentence)
        elif plan_only:
            report = doer.plan(steps[0].understood, view, sentence)
        else:
            report = self._carried_out(sentence, steps, view, choice)
        give_back_free_memory()
        return spelt(replace(report, durations=dict(doer.stopwatch.seconds)), spelling)

    def preview(self, sentence: str, choice: int | None = None) -> ExecutionReport:
        """Understand a sentence in the scene as it is seen, and plan all of its steps; nothing moves.

        Each step is planned in the scene as it should be then.

        Args:
            sentence: What to do.
            choice: Track number of what was meant, as for `execute`.

        Raises:
            InputError: The sentence holds no word.
        """
        steps, view, spelling = self._understood(sentence, choice)
        return spelt(self._previewed(sentence, steps, view), spelling)

    def _previewed(self, sentence: str, steps: list[Step], view: object) -> ExecutionReport:
        trouble = next((step for step in steps if not self._can_act(step.understood)), None)
        if trouble is not None:
            return report_of(trouble.understood, sentence)
        reports: list[ExecutionReport] = []
        for step in steps:
            said = sentence if len(steps) == 1 else " ".join(step.words)
            reports.append(self._doer.plan(step.understood, view, said))
            if not reports[-1].success:
                break
            view = self._doer.imagine(view, step.understood)
        if len(reports) == 1:
            return reports[0]
        whole = _together(sentence, reports, len(steps))
        return replace(whole, reason=f"these are the {len(steps)} steps") if whole.success else whole

    def go_on_from(self, before: "Executor") -> None:
        """Take over what another one, with other knowledge, has seen and done in the same world."""
        self.history, self.last = before.history, before.last
        self._doer.go_on_from(before.doer)

    @property
    def doer(self) -> Doer[Any]:
        """Who carries steps out in this world."""
        return self._doer

    def undo(self) -> str | None:
        """Put the world back to before the last command that moved something.

        Returns:
            That command, or None where there is nothing to undo.
        """
        moment = self.history.go_back()
        if moment is None:
            return None
        self.last = moment.last
        self._doer.resume()
        return moment.sentence

    def _understood(self, sentence: str, choice: int | None) -> tuple[list[Step], object, tuple[Spelling, ...]]:
        """The steps of a sentence, the view they were understood in, and how its words that were never heard are taken.

        Raises:
            InputError: The sentence holds no word.
        """
        if not any(letter.isalnum() for letter in sentence):
            raise InputError(f"the sentence {sentence!r} holds no word; say what to do")
        self._doer.stopwatch.restart()
        view = self._doer.look()

        def read(taken: Mapping[str, str]) -> list[Step]:
            return steps_of(with_words(sentence, taken), self._doer, view, self.last, choice)

        steps = read({})
        strange = [word for step in steps for word in step.understood.unknown if not self._doer.knows(word)]
        spelling = spellings_of(strange, self.knowledge)
        if taken := taken_words(spelling):
            steps = read(taken)
        for each in spelling if len(taken) > 1 else ():  # "then" is no slip for "the" where it stands between steps
            if not each.joins:
                continue
            fewer = tuple(other for other in spelling if other is not each)
            again = read(taken_words(fewer))
            if all(self._can_act(step.understood) for step in again):
                steps, spelling = again, fewer
        return steps, view, (*spelling, *slips_put_right(words_of(sentence), self.knowledge))

    def _can_act(self, understood: Understood) -> bool:
        return understood.clear or (self.clear and bool(understood.blocked) and understood.answer is Answer.IMPOSSIBLE)

    def mark_wrong(self, knowledge: "Knowledge") -> bool:
        """Let knowledge learn that what was done last is not what was said.

        Args:
            knowledge: Updated in place: this executor's own, or the same in another copy.

        Returns:
            Whether the words would be understood otherwise now.
        """
        changed = [self._doer.forget(knowledge, understood, view) for understood, view in self._deeds]
        return any(changed)

    def _carried_out(self, sentence: str, steps: list[Step], view: object, choice: int | None) -> ExecutionReport:
        """Carry out steps, each understood anew in the world as it is."""
        self._deeds = []
        self.history.keep(sentence, self.last)
        reports: list[ExecutionReport] = []
        for number, step in enumerate(steps):
            understood = step.understood
            if number:
                view = self._doer.look()
                understood = self._doer.understand(step.words, view, self.last, choice)
            said = sentence if len(steps) == 1 else " ".join(step.words)
            if self._can_act(understood):
                report = self._doer.carry_out(understood, view, said)
                self.last = understood.goals[-1].object_id
                self._deeds.append((understood, view))
            else:
                report = report_of(understood, said)
            reports.append(report)
            if not report.success:
                break
        if not any(report.answer.moved for report in reports):
            self.history.drop()
        return reports[0] if len(steps) == 1 else _together(sentence, reports, len(steps))


def _together(sentence: str, reports: list[ExecutionReport], count: int) -> ExecutionReport:
    """One report of several steps."""
    last = reports[-1]
    answer = last.answer
    if not answer.moved and any(report.answer.moved for report in reports):
        answer = Answer.FAILED  # something was done, but not all
    done = sum(report.success for report in reports)
    reason = f"{done} of {count} steps done" + ("" if done == count else f"; step {len(reports)}: {last.reason}")
    return replace(
        last,
        sentence=sentence,
        answer=answer,
        reason=reason,
        explanation=joined(*(report.explanation for report in reports)),
        goals=tuple(goal for report in reports for goal in report.goals),
        attempts=sum(report.attempts for report in reports),
        cleared=tuple(number for report in reports for number in report.cleared),
        steps=tuple(reports),
    )


def _known(on_ambiguous: OnAmbiguous | str) -> OnAmbiguous:
    try:
        return OnAmbiguous(on_ambiguous)
    except ValueError:
        allowed = ", ".join(each.value for each in OnAmbiguous)
        raise InputError(f"on_ambiguous is {on_ambiguous!r}, allowed: {allowed}") from None
