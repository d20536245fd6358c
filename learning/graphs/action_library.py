"""The action graphlets learned so far, numbered: number n is the concept `action_n` (thesis 3.4.2)."""

from collections.abc import Sequence
from typing import Any

from learning.graphs.action_graphlet import ActionGraphlet


class ActionLibrary:
    """Known action graphlets in the order in which they were first shown, numbered from 1."""

    def __init__(self, graphlets: Sequence[ActionGraphlet] = ()) -> None:
        self._graphlets = list(graphlets)

    def __len__(self) -> int:
        """Number of known actions."""
        return len(self._graphlets)

    @property
    def numbered(self) -> dict[int, ActionGraphlet]:
        """Number to graphlet, ascending."""
        return dict(enumerate(self._graphlets, start=1))

    def __getitem__(self, number: int) -> ActionGraphlet:
        """The graphlet `action_<number>`.

        Raises:
            KeyError: There is no such action.
        """
        if not 1 <= number <= len(self._graphlets):
            raise KeyError(f"action_{number} is not known; known are 1..{len(self._graphlets)}")
        return self._graphlets[number - 1]

    def find(self, graphlet: ActionGraphlet) -> int | None:
        """Number of the known graphlet that matches, else None."""
        for number, known in self.numbered.items():
            # Canonical graphlets that are equal are isomorphic: no need to search for the isomorphism.
            if known == graphlet or known.matches(graphlet):
                return number
        return None

    def match_or_add(self, graphlet: ActionGraphlet) -> int:
        """Number of the graphlet, which is added if no known one matches it (incremental learning, 3.4.2)."""
        number = self.find(graphlet)
        if number is None:
            self._graphlets.append(graphlet)
            number = len(self._graphlets)
        return number

    def parts_of(self, graphlet: ActionGraphlet) -> tuple[int, ...]:
        """Numbers of all known graphlets that `graphlet` contains, itself included."""
        return tuple(number for number, known in self.numbered.items() if graphlet.contains(known))

    def to_json(self) -> list[list[list[int]]]:
        """All graphlets in order."""
        return [graphlet.to_json() for graphlet in self._graphlets]

    @classmethod
    def from_json(cls, data: Sequence[Any]) -> "ActionLibrary":
        """Rebuild the library; raises ValueError or TypeError for anything that `to_json` did not write."""
        return cls([ActionGraphlet.from_json(entry) for entry in data])
