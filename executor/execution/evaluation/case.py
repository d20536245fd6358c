"""A command in a scene, and what should come of it."""

from dataclasses import dataclass
from typing import Literal

from executor.execution.answer import Answer
from twin import SceneSpec

Cell = tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class Expected:
    """What should come of a command, by the truth.

    Attributes:
        answer: Which answer, where nothing should move; None where something should.
        object_id: Which object is handled.
        cell: Cell where it ends, None where it stays in the gripper.
        strict: Whether every block must be in its cell afterwards by both axes (the after-layout of a release), not
            only within half a cell of it.
    """

    answer: Answer | None = None
    object_id: int | None = None
    cell: Cell | None = None
    strict: bool = False


@dataclass(frozen=True, slots=True)
class Case:
    """One command.

    Attributes:
        number: Its number, for the seed of the noise of looking and for reports.
        scene: The scene.
        sentence: What is said.
        expected: What should come of it; None where nobody knows.
        kind: What kind of command it is.
    """

    number: int
    scene: SceneSpec
    sentence: str
    expected: Expected | None
    kind: str


Suite = Literal["ambiguous", "impossible", "unknown-word"]
