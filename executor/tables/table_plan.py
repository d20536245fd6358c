"""What a hand will do at a table, as the plan of a report."""

from dataclasses import dataclass

from executor.actions.primitives import Primitive


@dataclass(frozen=True, slots=True)
class TablePlan:
    """Motion primitives in order.

    Attributes:
        steps: One after the other.
    """

    steps: tuple[Primitive, ...]

    def lines(self) -> tuple[str, ...]:
        """One line a step, for people."""
        return tuple(str(step) for step in self.steps)
