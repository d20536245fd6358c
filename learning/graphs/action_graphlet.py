"""Action graphlets: the sequence of gripper and moved-object states that is an action (thesis 3.3.4, figure 3.14)."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from learning.graphs.graphlet_state import GraphletState, Side

if TYPE_CHECKING:
    import networkx as nx


@dataclass(frozen=True, slots=True)
class ActionGraphlet:
    """An action as a sequence of states. Equal graphlets are the same action.

    Attributes:
        states: The states in canonical form, see `of`.
    """

    states: tuple[GraphletState, ...]

    @classmethod
    def of(cls, states: Iterable[GraphletState]) -> "ActionGraphlet":
        """Bring a sequence of states into canonical form.

        A run of states that differ in location alone keeps its first and last: where a carried object passes on its
        way is not part of the action. Then location variables are numbered in order of first appearance.
        """
        kept: list[GraphletState] = []
        for state in states:
            if kept and kept[-1] == state:
                continue
            if len(kept) >= 2 and _grip(kept[-2]) == _grip(kept[-1]) == _grip(state):
                kept[-1] = state
                if kept[-1] == kept[-2]:  # away and back again
                    kept.pop()
                continue
            kept.append(state)
        return cls(_numbered(kept))

    def __str__(self) -> str:
        """Write the graphlet as `[O apart 0][O touch 0]`."""
        return "".join(f"[{state}]" for state in self.states)

    def contains(self, other: "ActionGraphlet") -> bool:
        """Whether `other` is a contiguous part of this action, up to the names of its location variables."""
        length = len(other.states)
        return any(
            _numbered(self.states[start : start + length]) == other.states
            for start in range(len(self.states) - length + 1)
        )

    def followed_by(self, other: "ActionGraphlet") -> "ActionGraphlet":
        """This action and then `other`, which goes on from the place where this one left the object.

        Where the last states of this one are the first of `other` (carrying, say), they are the same states.
        """
        if not self.states or not other.states:
            return self if self.states else other
        overlap = self._overlap(other)
        # The place where `other` starts is the one where this action was at the first shared state (or its last).
        start = self.states[-overlap] if overlap else self.states[-1]
        shift = {other.states[0].object_location: start.object_location}
        if overlap:
            for mine, theirs in zip(self.states[-overlap:], other.states[:overlap], strict=True):
                shift[theirs.object_location] = mine.object_location
        fresh = max(state.object_location for state in self.states) + 1
        continued = list(self.states)
        for state in other.states[overlap:]:
            if state.object_location not in shift:
                shift[state.object_location] = fresh
                fresh += 1
            continued.append(state.at(shift[state.object_location]))
        return ActionGraphlet.of(continued)

    def to_networkx(self) -> "nx.DiGraph[str]":
        """The graphlet as a DAG: per state an object layer (gripper, object) and a relation layer, in sequence.

        Nodes carry `label`; the node `c` of a state is its connection node, to which object graphlets attach. Location
        nodes are shared between the states that have the same location variable.
        """
        import networkx as nx

        graph: nx.DiGraph[str] = nx.DiGraph()
        for index, state in enumerate(self.states):
            name = f"s{index}"
            graph.add_node(name, label="state")
            for part, label in (("gripper", "gripper"), ("c", "connection"), ("relation", "relation")):
                graph.add_node(f"{name}.{part}", label=label)
                graph.add_edge(name, f"{name}.{part}")
            graph.add_node(f"{name}.grip", label="closed" if state.gripper_closed else "open")
            graph.add_edge(f"{name}.gripper", f"{name}.grip")
            graph.add_node(f"{name}.distance", label="at it" if state.touching else "apart")
            graph.add_edge(f"{name}.relation", f"{name}.distance")
            graph.add_node(f"location{state.object_location}", label="location")
            graph.add_edge(f"{name}.c", f"location{state.object_location}")
            if state.raised:
                graph.add_node(f"{name}.raised", label="raised")
                graph.add_edge(f"{name}.c", f"{name}.raised")
            if state.side is not None:
                graph.add_node(f"{name}.side", label=state.side.name.lower())
                graph.add_edge(f"{name}.relation", f"{name}.side")
            if index:
                graph.add_edge(f"s{index - 1}", name)
        return graph

    def matches(self, other: "ActionGraphlet") -> bool:
        """Whether the two graphs are isomorphic with equal labels (thesis 3.4.2, NetworkX)."""
        import networkx as nx
        from networkx.algorithms.isomorphism import categorical_node_match

        if len(self.states) != len(other.states):
            return False
        match = categorical_node_match("label", None)
        return bool(nx.is_isomorphic(self.to_networkx(), other.to_networkx(), node_match=match))

    def likeness(self, other: "ActionGraphlet") -> float:
        """Share of the longer one's states that both have in one order, wherever the object is, 0..1."""
        mine, theirs = ([state.at(0) for state in each.states] for each in (self, other))
        common = [0] * (len(theirs) + 1)  # of the longest common subsequence with each beginning of theirs
        for state in mine:
            before = common[:]
            for index, their in enumerate(theirs, start=1):
                common[index] = before[index - 1] + 1 if state == their else max(before[index], common[index - 1])
        return common[-1] / max(len(mine), len(theirs))

    def to_json(self) -> list[list[int]]:
        """One row a state: `[closed, touching, location]`, and more where more is known (`GraphletState.to_json`)."""
        return [state.to_json() for state in self.states]

    @classmethod
    def from_json(cls, data: Sequence[Sequence[Any]]) -> "ActionGraphlet":
        """Rebuild a graphlet.

        Raises:
            ValueError, TypeError: `data` is not what `to_json` wrote.
        """
        states = tuple(GraphletState.from_json(row) for row in data)
        if not states:
            raise ValueError("a graphlet must have at least one state")
        return cls(states)

    def _overlap(self, other: "ActionGraphlet") -> int:
        """Length of the longest end of this action that is also how `other` begins."""
        for length in range(min(len(self.states), len(other.states)), 0, -1):
            if _numbered(self.states[-length:]) == _numbered(other.states[:length]):
                return length
        return 0


def _grip(state: GraphletState) -> tuple[bool, bool, bool, Side | None]:
    """What the gripper does with the object, whatever the object's place."""
    return state.gripper_closed, state.touching, state.raised, state.side


def _numbered(states: Sequence[GraphletState]) -> tuple[GraphletState, ...]:
    """Number location variables in order of first appearance."""
    names: dict[int, int] = {}
    return tuple(state.at(names.setdefault(state.object_location, len(names))) for state in states)
