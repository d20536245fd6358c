"""The action graphlets learned so far, numbered: number n is the concept `action_n` (thesis 3.4.2)."""

from collections.abc import Sequence
from typing import Any

from learning.graphs.action_graphlet import ActionGraphlet
from learning.graphs.action_statistics import ActionStatistics, Measures
from learning.graphs.known_action import KnownAction


class ActionLibrary:
    """Known action graphlets in the order in which they were first shown, numbered from 1."""

    def __init__(self, graphlets: Sequence[ActionGraphlet] = ()) -> None:
        self._actions = [KnownAction(graphlet) for graphlet in graphlets]

    def __len__(self) -> int:
        """Number of known actions."""
        return len(self._actions)

    @property
    def numbered(self) -> dict[int, ActionGraphlet]:
        """Number to graphlet, ascending; of an action that was seen in variants, the most frequent one."""
        return {number: action.graphlet for number, action in enumerate(self._actions, start=1)}

    def __getitem__(self, number: int) -> ActionGraphlet:
        """The graphlet `action_<number>`.

        Raises:
            KeyError: There is no such action.
        """
        return self._known(number).graphlet

    def statistics(self, number: int) -> ActionStatistics | None:
        """How `action_<number>` is done, as far as demos were seen that tell; None where none was (the board).

        Raises:
            KeyError: There is no such action.
        """
        return self._known(number).statistics

    def variants(self, number: int) -> dict[ActionGraphlet, int]:
        """All graphlets that count as `action_<number>`, with the number of demos they were seen in, if counted.

        Raises:
            KeyError: There is no such action.
        """
        return self._known(number).counts

    def find(self, graphlet: ActionGraphlet, measured: Sequence[Measures] | None = None) -> int | None:
        """Number of the known action that the graphlet is, else None.

        Args:
            graphlet: A canonical graphlet.
            measured: What the demo shows of its states (`action_measures.measured`). A graphlet that differs by one
                short state from a known one is then a variant of it; without it, graphlets must match.
        """
        for number, known in enumerate(self._actions, start=1):
            if known.matches(graphlet):
                return number
        if measured is None:
            return None
        near = [
            (known.demos, -number) for number, known in self._numbered_actions() if known.is_near(graphlet, measured)
        ]
        return -max(near)[1] if near else None

    def match_or_add(self, graphlet: ActionGraphlet, measured: Sequence[Measures] | None = None) -> int:
        """Number of the graphlet, which is added if no known one matches it (incremental learning, 3.4.2).

        Args:
            graphlet: A canonical graphlet.
            measured: As in `find`; it is also learned from.
        """
        number = self.find(graphlet, measured)
        if number is None:
            self._actions.append(KnownAction(graphlet))
            number = len(self._actions)
        if measured is not None:
            self._known(number).update(graphlet, measured)
        return number

    def parts_of(self, graphlet: ActionGraphlet) -> tuple[int, ...]:
        """Numbers of all known graphlets that `graphlet` contains, itself included."""
        return tuple(number for number, known in self.numbered.items() if graphlet.contains(known))

    def to_json(self) -> list[Any]:
        """All actions in order: the graphlet alone, or its variants with their statistics."""
        return [action.to_json() for action in self._actions]

    @classmethod
    def from_json(cls, data: Sequence[Any]) -> "ActionLibrary":
        """Rebuild the library; raises ValueError, KeyError or TypeError for what `to_json` did not write."""
        library = cls()
        library._actions = [KnownAction.from_json(entry) for entry in data]
        return library

    def _numbered_actions(self) -> list[tuple[int, KnownAction]]:
        return list(enumerate(self._actions, start=1))

    def _known(self, number: int) -> KnownAction:
        if not 1 <= number <= len(self._actions):
            raise KeyError(f"action_{number} is not known; known are 1..{len(self._actions)}")
        return self._actions[number - 1]
