"""The known action graphlets as the chart needs them: who holds what before and after, and what follows what."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ActionTable:
    """Properties of action graphlets by their numbers.

    Attributes:
        starts_held: Whether the object is in the gripper when the action starts.
        ends_held: Whether it is there when the action ends.
        composed: Number of the known graphlet that two in a row amount to.
    """

    starts_held: dict[int, bool]
    ends_held: dict[int, bool]
    composed: dict[tuple[int, int], int]

    def sorts(self) -> tuple[int, ...]:
        """One action of each sort, known longest; sorts differ in whether the object is held before and after."""
        first: dict[tuple[bool, bool], int] = {}
        for number in sorted(self.starts_held):
            first.setdefault((self.starts_held[number], self.ends_held[number]), number)
        return tuple(sorted(first.values()))
