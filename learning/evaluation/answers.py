"""What a learner answers when it is asked commands about scenes: taken down first, scored afterwards."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter, process_time
from typing import Protocol

from learning.concept_id import Concept
from learning.evaluation.concept_names import ConceptTally
from learning.grammar.rcl import RclNode
from learning.percept import Percept
from learning.train_robots.release import Command
from learning.train_robots.scene import Scene
from robots.pose import FloatArray


class GoalLike(Protocol):
    """A goal: which object ends where."""

    @property
    def object_id(self) -> int:
        """Track number of the object."""

    @property
    def position(self) -> FloatArray | None:
        """Where its centre ends, (3,) [m], or None when it stays in the gripper."""


class InterpretationLike(Protocol):
    """How a sentence was understood in a scene."""

    @property
    def goals(self) -> Sequence[GoalLike]:
        """Goals in the order in which they are to be reached; empty when nothing was understood."""

    @property
    def tree(self) -> RclNode | None:
        """The RCL tree, None when there is none."""

    @property
    def explanation(self) -> str:
        """What was understood, or why nothing was."""

    @property
    def understood(self) -> bool:
        """Whether there is a goal."""


class Student(Protocol):
    """A learner that can be examined."""

    def percept(self, scene: Scene) -> Percept:
        """Perceive a scene before anything moves; `object_ids` are indices in the before layout."""

    def shown_action(self, scene: Scene) -> int | None:
        """Number of the action concept that the scene shows, None when it shows none that is known."""

    def interpret(self, sentence: str, percept: Percept) -> InterpretationLike:
        """Understand a sentence in a scene."""


Learn = Callable[[Sequence[Scene], Sequence[Command]], Student]
"""Learn from scenes and from commands about them (some scenes have no command)."""
Steps = Callable[[Sequence[Scene], Sequence[Command]], Iterator[tuple[Student, int, float]]]
"""The same scene by scene, where a learner can be watched (its attribute `steps`): the student so far, how many
commands it has heard, and the processor time that the scene took [s]."""


@dataclass(frozen=True, slots=True)
class Answer:
    """One answer.

    Attributes:
        command: What was asked.
        object_ids: Objects of all goals, without repeats.
        position: Where the last goal's object ends, (3,) [m], or None.
        tree: RCL tree, or None.
        understood: Whether there was a goal.
        explanation: The learner's own words.
        seconds: Time until the answer [s].
        cpu_seconds: Processor time of it [s].
    """

    command: Command
    object_ids: frozenset[int]
    position: FloatArray | None
    tree: RclNode | None
    understood: bool
    explanation: str
    seconds: float = 0.0
    cpu_seconds: float = 0.0


def ask(
    student: Student,
    scenes: Mapping[int, Scene],
    commands: Sequence[Command],
    on_answer: Callable[[], None] = lambda: None,
) -> tuple[list[Answer], dict[Concept, str]]:
    """Ask all commands, and name the concepts by the truth of the scenes that were asked about.

    Args:
        student: Learner to examine.
        scenes: Scenes by number.
        commands: What to ask; scenes that move other than one block are asked too and score as wrong.
        on_answer: Called after every answer, for progress.
    """
    tally = ConceptTally()
    answers: list[Answer] = []
    for number, about in _by_scene(commands):
        scene = scenes[number]
        percept = student.percept(scene)
        tally.add(percept, student.shown_action(scene), scene)
        for command in about:
            begun, cpu_begun = perf_counter(), process_time()
            said = student.interpret(command.sentence, percept)
            seconds, cpu_seconds = perf_counter() - begun, process_time() - cpu_begun
            goals = said.goals if said.understood else ()
            answers.append(
                Answer(
                    command=command,
                    object_ids=frozenset(goal.object_id for goal in goals),
                    position=goals[-1].position if goals else None,
                    tree=said.tree,
                    understood=bool(goals),
                    explanation=said.explanation,
                    seconds=seconds,
                    cpu_seconds=cpu_seconds,
                )
            )
            on_answer()
    return answers, tally.names()


def _by_scene(commands: Iterable[Command]) -> list[tuple[int, list[Command]]]:
    grouped: dict[int, list[Command]] = {}
    for command in commands:
        grouped.setdefault(command.scene, []).append(command)
    return sorted(grouped.items())
