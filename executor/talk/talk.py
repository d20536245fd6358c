"""What the page says to the robot, and what the robot answers: the control loop's extension for telling and doing."""

from collections import deque
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from executor.errors import InputError
from executor.execution.answer import Answer
from executor.execution.readiness import get_ready
from executor.execution.session import Session
from executor.executor import Executor
from executor.knowledge_fit import check_fit
from executor.report import ExecutionReport, joined, told
from executor.talk.marks import Mark, marks_of
from executor.talk.plan_words import line_of, plan_lines
from executor.talk.said_words import words_of_report
from executor.talk.state import Answered, Lesson, TalkState
from executor.talk.student import Student
from executor.talk.told_knowledge import told_knowledge
from learning import Knowledge
from robots.errors import ShowtellError
from teleop.errors import TeleopError
from teleop.loop_channel import ChannelClosedError
from teleop.loop_extension import LentStopError

if TYPE_CHECKING:
    from teleop.loop_extension import Desk

LISTEN_EVERY = 12
"""Control steps between two looks at what the student has to say: 20 Hz."""
REST = 10
"""Such looks in a row at which the robot stood still, after which a moment may be used: half a second."""
AT_REST = 1e-3
"""A robot whose joints all move slower than this stands still [rad/s, m/s]."""
KNOWS_NOTHING = "I have learned nothing yet: record a demo, say what you do, and have it learned"


class Talk:
    """Reads commands, does them, and has demos learned. Satisfies `LoopExtension`.

    Args:
        desk: What the control loop offers.
        knowledge: File of what was learned; made with the first lesson if it does not exist.
        seed: Seed of the noise of perception.

    Attributes:
        state: What the page is told.
    """

    def __init__(self, desk: "Desk", knowledge: Path, seed: int) -> None:
        """Read what was learned, and load all that commands need, so that the first one is answered at once.

        Raises:
            KnowledgeError: The file is no knowledge.
            InputError: It was not made where this robot works, or this robot carries out no commands.
        """
        self._desk, self._path, self._seed = desk, knowledge, seed
        self._knowledge = Knowledge.load(knowledge) if knowledge.exists() else None
        self._last: ExecutionReport | None = None
        self._wishes: deque[dict[str, Any]] = deque()
        self._steps = 0
        self._untold = True
        self._told_knowledge = {} if self._knowledge is None else told_knowledge(self._knowledge)
        self.state = TalkState(file=knowledge.name)
        self._world, self._executor = desk.deck.world, self._made()
        self._still, self._ready = 0, True
        self._student = Student(knowledge, seed)  # gets ready while we do
        with suppress(ShowtellError):  # whatever is wrong is told with the first command
            # Before the loop runs: what is loaded meanwhile would hold it up.
            get_ready(self._executor or Executor(self._world, Knowledge(self._world.spec.kind)))

    # What the control loop calls

    def hear(self, message: dict[str, Any]) -> None:
        """Take a message of a page."""
        self._wishes.append(message)

    def step(self) -> None:
        """Do what was wished, and tell what is new."""
        self._steps += 1
        if self._steps % LISTEN_EVERY == 0:
            self._listen()
        if self._desk.deck.world is not self._world:
            self._refresh()
            self._show(phase="idle", answer=None)
        if self._wishes:
            self._obey(self._wishes.popleft())
        elif not self._ready and self._steps % LISTEN_EVERY == 0:
            self._use_rest()
        if self._told_knowledge:
            message, self._told_knowledge = self._told_knowledge, {}
            self._desk.tell("K", message)
        if self._untold:
            self._untold = not self._desk.tell("T", self.state.to_dict())

    def close(self) -> None:
        """End the student, and free what looks at the scene."""
        self._student.close()
        if self._executor is not None:
            self._executor.doer.close()

    def _use_rest(self) -> None:
        """Look at a new scene while nobody drives, so that the next command need not."""
        resting = self._desk.deck.mode == "idle" and float(np.abs(self._world.state().dq).max()) < AT_REST
        self._still = self._still + 1 if resting else 0
        if self._executor is not None and self._still >= REST:
            self._ready = True
            with suppress(ShowtellError):
                get_ready(self._executor)

    # What pages wish

    def _obey(self, wish: Mapping[str, Any]) -> None:
        action, text, choice = wish["action"], " ".join(wish["text"].split()), wish["choice"]
        try:
            if action == "learn":
                self._learn(wish["demo"])
            elif action in ("read", "do"):
                self._command(text, choice, does=action == "do")
            elif action == "undo":
                self._undo()
            else:
                self._mark_wrong()
        except (InputError, TeleopError) as error:
            if isinstance(error, ChannelClosedError):
                raise
            self._show(phase="idle", answer=Answered("refused", str(error)))

    def _command(self, text: str, choice: int | None, *, does: bool) -> None:
        """Read a command, and do it if that was asked."""
        if self._desk.deck.mode != "idle":
            raise InputError("not now: end what is recorded or replayed, and keep or discard it, first")
        self._show(phase="thinking", sentence=text, choice=choice, answer=None, done=0)
        self._tell_now()
        executor = self._executor
        if executor is None:
            report = ExecutionReport(text, Answer.UNKNOWN_WORD, KNOWS_NOTHING, KNOWS_NOTHING)
            self._answer(report, [])
            return
        report = executor.preview(text, choice)
        marks = [] if report.unknown else marks_of(report, executor.doer, executor.doer.look())
        if does and report.success:
            words = tuple(words_of_report(report, executor.knowledge))
            self._show(phase="moving", plan=plan_lines(report), marks=marks, words=words)
            report = self._done(executor, report, choice)
            marks = [] if report.answer is not Answer.AMBIGUOUS else marks
        self._answer(report, marks)

    def _done(self, executor: Executor, planned: ExecutionReport, choice: int | None) -> ExecutionReport:
        """Carry out what was planned."""

        def begun(step: object) -> None:
            line, plan, done = line_of(step), self.state.plan, self.state.done
            # It may be the second piece of what is on; another arm, or a second try, begins from the start.
            order = (*range(max(done - 1, 0), len(plan)), *range(done))
            found = next((at for at in order if plan[at] == line), done - 1)
            self._show(done=found + 1)
            self._tell_now()

        executor.doer.on_progress = begun
        try:
            with self._desk.lend("a command is being carried out"):
                return executor.execute(planned.sentence, choice=choice)
        except LentStopError as stop:
            executor.doer.resume()
            return told(replace(planned, plan=None), Answer.STOPPED, f"{stop}: the arm stands still where it was")

    def _answer(self, report: ExecutionReport, marks: list[Mark]) -> None:
        """Tell how a command was answered."""
        self._last = report
        history = 0 if self._executor is None else len(self._executor.history)
        knowledge = self._knowledge if self._knowledge is not None else Knowledge()
        self._show(
            phase="idle",
            answer=Answered(
                str(report.answer),
                report.reason,
                options=tuple((option.thing, option.name) for option in report.options),
                unknown=report.unknown,
                note=joined(*(each.told() for each in report.spelling if each.taken is not None)),
                spellings=tuple((each.word, each.sentence) for each in report.suggested),
                can_be_wrong=report.answer.moved and report.answer is not Answer.STOPPED,
            ),
            undo=history,
            words=tuple(words_of_report(report, knowledge)),
            plan=plan_lines(report) if not report.answer.moved else self.state.plan,
            marks=marks,
        )

    def _undo(self) -> None:
        executor = self._executor
        undone = None
        if executor is not None and len(executor.history):
            with self._desk.lend("undoing"):
                undone = executor.undo()
        said = "there is nothing to undo" if undone is None else f"undone: “{undone}”; the world is as it was before"
        self._last = None
        self._show(
            phase="idle",
            answer=Answered("undone", said),
            undo=0 if executor is None else len(executor.history),
            plan=(),
            marks=[],
        )

    def _mark_wrong(self) -> None:
        executor, last = self._executor, self._last
        if executor is None or last is None or not last.answer.moved or last.answer is Answer.STOPPED:
            raise InputError("nothing was done that could be wrong")
        if self.state.learning:
            raise InputError("a demo is being learned: say that in a moment")
        session = Session(executor, self._path)
        session.last = last
        with self._desk.lend("undoing"):
            said = session.mark_wrong()
        self._last = None
        self._show(phase="idle", answer=Answered("undone", said), undo=len(executor.history), plan=(), marks=[])
        self._student.tell()

    # Learning

    def _learn(self, name: str) -> None:
        """Have the demo that waits learned, or one of the folder."""
        deck = self._desk.deck
        if self.state.learning and name in ("", self.state.learning) and deck.mode != "review":
            return  # a click too many
        if self.state.learning:
            raise InputError("another demo is being learned: wait a moment")
        path = (
            self._desk.keep()
            if deck.mode == "review"
            else next((each for each in deck.kept() if each.name == name), None)
        )
        if path is None:
            raise InputError("there is no demo to learn: record one first")
        deck.settle()
        self._student.learn(path)
        self._show(learning=path.name, lesson=None)

    def _listen(self) -> None:
        """Take what the student has to say."""
        try:
            answers = self._student.answers()
        except ChannelClosedError:
            self._desk.notice("error", "the process that learns ended by itself and is started again")
            self._student.close()
            self._student = Student(self._path, self._seed)
            self._show(learning="")
            return
        for answer in answers:
            if "error" in answer:
                self._show(learning="", lesson=Lesson(answer["demo"], error=answer["error"]))
                self._desk.notice("error", f"{answer['demo']} was not learned: {answer['error']}")
                continue
            self._knowledge = Knowledge.load(self._path)
            self._told_knowledge = answer["knowledge"]
            self._refresh(same_world=True)
            if answer.get("before"):
                self._show(learning="", lesson=Lesson(answer["demo"], before=True))
                self._desk.notice("info", f"{answer['demo']} was learned before")
            elif answer["demo"]:
                lesson = Lesson(answer["demo"], sentences=answer["sentences"])
                self._show(learning="", lesson=lesson, answer=None, words=(), plan=(), marks=[])
                self._desk.notice("info", f"{answer['demo']} was learned")

    # State

    def _refresh(self, *, same_world: bool = False) -> None:
        """Take over the world that is on now, with what is known now."""
        world = self._desk.deck.world
        before = self._executor
        self._world, self._executor = world, self._made()
        if self._executor is not None and same_world and before is not None and before.world is world:
            self._executor.go_on_from(before)
        else:
            self._still, self._ready = 0, False
            if before is not None:
                before.doer.close()
        if not same_world:
            self._last = None
            self.state = replace(self.state, undo=0, plan=(), marks=[], words=(), done=0, sentence="", choice=None)
        self._untold = True

    def _made(self) -> Executor | None:
        """Who carries out commands in the world that is on now, with what is known now; None where nothing is known."""
        world = self._desk.deck.world
        if self._knowledge is None or not self._knowledge.demos or self._desk.deck.mode == "replaying":
            return None
        check_fit(self._knowledge, world.spec.kind, self._path)
        return Executor(world, self._knowledge)

    def _show(self, **changes: Any) -> None:
        self.state = replace(self.state, number=self.state.number + 1, **changes)
        self._untold = True

    def _tell_now(self) -> None:
        """Tell at once, where the loop itself comes to it late."""
        self._untold = not self._desk.tell("T", self.state.to_dict())


def make_talk(desk: "Desk", options: Mapping[str, str]) -> Talk:
    """Make the extension from plain options: `knowledge`, a path, and `seed`."""
    return Talk(desk, Path(options["knowledge"]), int(options["seed"]))
