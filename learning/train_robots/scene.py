"""A scene of a Train-Robots release: the layouts before and after one command."""

from dataclasses import dataclass
from functools import cached_property

from learning.train_robots.layout import Cell, Layout

SCENES_PER_GROUP = 8


def images_of_scene(number: int) -> tuple[int, int, int]:
    """Return group, image before and image after of a scene number (from 1), by the rule of the release.

    With t = (number - 1) // 2, group = t // 4 + 1 and other = t % 4 + 2, an odd scene goes from image 1 to image
    `other`, an even one from image `other` to image 1.
    """
    t = (number - 1) // 2
    group, other = t // 4 + 1, t % 4 + 2
    return (group, 1, other) if number % 2 else (group, other, 1)


@dataclass(frozen=True, slots=True)
class ShownMove:
    """What truly moved in a scene; for scoring and for driving the scene on the twin.

    Attributes:
        object_id: Id of the moved block: its index in the before layout.
        start: Cell of the block before.
        goal: Cell of the block after.
        held_at_start: The block starts in the closed gripper.
        held_at_end: The block ends in the closed gripper.
    """

    object_id: int
    start: Cell
    goal: Cell
    held_at_start: bool
    held_at_end: bool

    @property
    def kind(self) -> str:
        """`take` (ends held), `drop` (starts held) or `move`."""
        if self.held_at_end:
            return "take"
        return "drop" if self.held_at_start else "move"


@dataclass(frozen=True)
class Scene:
    """Layouts of one group before and after an action; scenes of one group share a layout.

    Attributes:
        number: Scene number, from 1.
        before: Layout that the action starts from.
        after: Layout that it leads to.
    """

    number: int
    before: Layout
    after: Layout

    @property
    def group(self) -> int:
        """Number of the group of layouts."""
        return self.before.group

    @cached_property
    def move(self) -> ShownMove | None:
        """The one block that differs between the layouts, or None when not exactly one does."""
        gone = [block for block in self.before.blocks if block not in self.after.blocks]
        come = [block for block in self.after.blocks if block not in self.before.blocks]
        if len(gone) != 1 or len(come) != 1:
            return None
        start, goal = gone[0], come[0]
        if (start.colour, start.shape) != (goal.colour, goal.shape):
            return None
        index = self.before.blocks.index(start)
        end_held = self.after.held
        return ShownMove(
            object_id=index,
            start=start.cell,
            goal=goal.cell,
            held_at_start=self.before.held == index,
            held_at_end=end_held is not None and self.after.blocks[end_held] == goal,
        )

    @property
    def one_block(self) -> bool:
        """Whether exactly one block differs between the layouts."""
        return self.move is not None
