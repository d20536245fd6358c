"""What a robot in its world has to offer so that commands can be carried out: the part that differs between robots."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

import numpy as np

from executor.errors import InputError
from executor.execution.answer import OnAmbiguous
from executor.execution.stopwatch import Stopwatch
from executor.execution.understood import Understood
from executor.knowledge_fit import check_fit
from executor.report import ExecutionReport
from robots.pose import FloatArray

if TYPE_CHECKING:
    from learning import Knowledge
    from twin import World


View = TypeVar("View")


class Doer(Protocol[View]):
    """Understands and carries out steps in one world.

    A *view* is whatever a doer needs to know of how the scene looked once; nobody else looks into it.

    Attributes:
        stopwatch: Times of the command that is being carried out; restarted at each.
        on_progress: Called with each step of a plan, as `Plan.steps` has it, when it begins to be carried out.
    """

    stopwatch: Stopwatch
    on_progress: Callable[[object], None]

    def look(self) -> View:
        """Look at the scene as it stands; gives a view."""

    def understand(self, words: tuple[str, ...], view: View, last: int | None, choice: int | None = None) -> Understood:
        """Understand one step in a view. Nothing moves; what is not acted on has an answer and a reason.

        Args:
            words: The words.
            view: How the scene looked.
            last: Track number of what was handled last, which a reference may mean.
            choice: Track number of what was meant where several things fit, as the answer to a question.
        """

    def imagine(self, view: View, understood: Understood) -> View:
        """The view as it would be after a step: later steps of a sentence are understood in it before any motion."""

    def plan(self, understood: Understood, view: View, sentence: str) -> ExecutionReport:
        """Plan a step; nothing moves."""

    def carry_out(self, understood: Understood, view: View, sentence: str) -> ExecutionReport:
        """Clear what is in the way (`understood.blocked`), carry a step out, check it by looking.

        However it ends, the hand is left sound: it holds only what it should.
        """

    def where(self, view: View, number: int) -> tuple[FloatArray, float] | None:
        """Centre (3,) and half of the width [m] of a thing by its track number; None where it is not seen."""

    def acts(self, word: str) -> bool:
        """Whether a word may name an action, so that a step can begin with it."""

    def joins(self, word: str) -> bool:
        """Whether a word was learned to mean nothing by itself, so that it may stand between steps."""

    def knows(self, word: str) -> bool:
        """Whether a word was ever heard."""

    def forget(self, knowledge: "Knowledge", understood: Understood, view: View) -> bool:
        """Let knowledge learn that a step was not what its words say; whether it is understood otherwise now."""

    def resume(self) -> None:
        """Take over the world as it is, after it was put back to an earlier moment."""

    def go_on_from(self, before: "Doer[Any]") -> None:
        """Take over what another one, with other knowledge, has seen in the same world; that one is not used again."""

    def close(self) -> None:
        """Free what it looks with; a later look makes it anew."""


def doer_for(
    world: "World",
    knowledge: "Knowledge",
    rng: np.random.Generator,
    on_ambiguous: OnAmbiguous = OnAmbiguous.ASK,
    clear: bool = False,
) -> Doer[Any]:
    """Give the doer for a robot in its world.

    Args:
        world: The world.
        knowledge: What was learned.
        rng: Source of the noise of looking and of the planners' chance.
        on_ambiguous: What to do where several things fit.
        clear: Whether what is found to be in the way while a step is planned is put aside.

    Raises:
        InputError: The world is none that sentences are carried out in yet, or the knowledge was learned on another
            kind of scene; says what to do.
    """
    check_fit(knowledge, world.spec.kind)
    if world.spec.kind == "board" and len(world.robot.joint_names) == 3:
        from executor.execution.board_doer import BoardDoer

        return BoardDoer(world, knowledge, rng, on_ambiguous)
    if world.spec.kind == "table" and world.robot.cameras:
        from executor.tables.table_doer import TableDoer

        return TableDoer(world, knowledge, rng, on_ambiguous, clear)
    raise InputError(
        "sentences are carried out on the board by an arm of three joints, and at tables by robots with a camera, not "
        f"by {world.robot.name} in scene {world.spec.name!r}: use a board scene with three_dof, tabletop, or ordering"
    )
