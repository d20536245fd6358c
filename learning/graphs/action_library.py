"""The action graphlets learned so far, numbered: number n is the concept `action_n` (thesis 3.4.2)."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any

from learning.graphs.action_graphlet import ActionGraphlet
from learning.graphs.action_statistics import ActionStatistics, Measures
from learning.graphs.known_action import KnownAction
from learning.saved_numbers import saved_count

LIKENESS = 0.5
"""Share of their states that a badly seen action and what it really is have at least in common."""
PATIENCE = 60
"""An action that fewer than one in so many demos shows is another one that was seen badly, if it is like one."""


class ActionLibrary:
    """Known action graphlets in the order in which they were first shown, numbered from 1.

    Cameras lose things behind the hand now and then, and such a demo has a graphlet of its own. A graphlet that stays
    rarer than one in `PATIENCE` demos and has at least half of its states in common with one that is shown more often
    becomes a variant of that, and its number an alias. What is like no other action stays, however rare.
    """

    def __init__(self, graphlets: Sequence[ActionGraphlet] = ()) -> None:
        self._actions = [KnownAction(graphlet) for graphlet in graphlets]
        self._aliases: dict[int, int] = {}
        self._demos = 0
        self._shown: defaultdict[int, int] = defaultdict(int)
        self._first: dict[int, int] = {}

    def __len__(self) -> int:
        """Number of known actions, aliases left out."""
        return len(self._actions) - len(self._aliases)

    @property
    def numbers_given(self) -> int:
        """How many numbers were ever given: they are 1 to this, aliases included."""
        return len(self._actions)

    @property
    def numbered(self) -> dict[int, ActionGraphlet]:
        """Number to graphlet, ascending; of an action that was seen in variants, the most frequent one."""
        return {number: action.graphlet for number, action in self._numbered_actions()}

    def resolve(self, number: int) -> int:
        """The number under which an action is kept now; itself when it never became a variant of another one."""
        while number in self._aliases:
            number = self._aliases[number]
        return number

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
        for number, known in self._numbered_actions():
            if known.matches(graphlet):
                return number
        if measured is None:
            return None
        near = [
            (known.demos, -number) for number, known in self._numbered_actions() if known.is_near(graphlet, measured)
        ]
        return -max(near)[1] if near else None

    def find_like(self, graphlet: ActionGraphlet, measured: Sequence[Measures] | None = None) -> int | None:
        """As `find`; what is none of the known actions is taken for the one it has most in common with.

        With less than `LIKENESS` in common it is none. This is what becomes of a rare graphlet as demos come, so a demo
        that is only looked at is not learned from but understood the same way.
        """
        number = self.find(graphlet, measured)
        return self._likest(graphlet) if number is None else number

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
        self._demos += 1
        self._shown[number] += 1
        self._first.setdefault(number, self._demos)
        self._absorb_rare()
        return self.resolve(number)

    def parts_of(self, graphlet: ActionGraphlet) -> tuple[int, ...]:
        """Numbers of all known graphlets that `graphlet` contains, itself included."""
        return tuple(number for number, known in self.numbered.items() if graphlet.contains(known))

    def to_json(self) -> dict[str, Any]:
        """All actions in order, each the graphlet alone or its variants with their statistics; what was counted."""
        return {
            "known": [action.to_json() for action in self._actions],
            "demos": self._demos,
            "shown": {str(number): [self._first[number], self._shown[number]] for number in sorted(self._first)},
            "aliases": {str(number): kept for number, kept in sorted(self._aliases.items())},
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any] | Sequence[Any]) -> "ActionLibrary":
        """Rebuild the library; raises ValueError, KeyError or TypeError for what `to_json` did not write.

        Older files hold the list of actions alone; then nothing is known of how often each was shown.
        """
        library = cls()
        if not isinstance(data, Mapping):
            library._actions = [KnownAction.from_json(entry) for entry in data]
            return library
        library._actions = [KnownAction.from_json(entry) for entry in data["known"]]
        library._demos = int(saved_count(data["demos"], "demos with an action"))
        numbers = range(1, len(library._actions) + 1)
        for number, (first, shown) in data["shown"].items():
            library._first[int(number)] = int(saved_count(first, f"first demo of action_{number}"))
            library._shown[int(number)] = int(saved_count(shown, f"demos of action_{number}"))
        library._aliases = {int(number): int(kept) for number, kept in data["aliases"].items()}
        for number in [*library._first, *library._aliases, *library._aliases.values()]:
            if number not in numbers:
                raise ValueError(f"action_{number} is counted, but actions are 1..{len(library._actions)}")
        for number in library._aliases:
            seen = {number}
            while number in library._aliases:
                number = library._aliases[number]
                if number in seen:
                    raise ValueError("aliases of actions must end at an action")
                seen.add(number)
        return library

    def _absorb_rare(self) -> None:
        """Make variants of what stays rare and is like something frequent."""
        for number, action in self._numbered_actions():
            if number not in self._first:
                continue  # from before actions were counted
            passed = self._demos - self._first[number]
            if self._shown[number] * PATIENCE > passed:
                continue
            kept = self._likest(action.graphlet, more_than=self._shown[number])
            if kept is not None:
                self._known(kept).adopt(action)
                self._aliases[number] = kept
                self._shown[kept] += self._shown[number]

    def _likest(self, graphlet: ActionGraphlet, more_than: int = -1) -> int | None:
        """The action that is most like a graphlet, of those shown in more demos; None where none is like it."""
        likes = [
            (graphlet.likeness(other.graphlet), self._shown.get(number, 0), -number)
            for number, other in self._numbered_actions()
            if self._shown.get(number, 0) > more_than
        ]
        return -max(likes)[2] if likes and max(likes)[0] >= LIKENESS else None

    def _numbered_actions(self) -> list[tuple[int, KnownAction]]:
        """Actions that are no alias, with their numbers."""
        numbered = enumerate(self._actions, start=1)
        return [(number, action) for number, action in numbered if number not in self._aliases]

    def _known(self, number: int) -> KnownAction:
        if not 1 <= number <= len(self._actions):
            raise KeyError(f"action_{number} is not known; known are 1..{len(self._actions)}")
        return self._actions[self.resolve(number) - 1]
