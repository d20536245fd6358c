"""Object and relation graphlets: what can be said of one object, or of one pair (thesis figures 3.12 and 3.13)."""

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import networkx as nx

ConceptNumber = tuple[str, int]
"""Feature space and number: ("colour", 3) is the concept colour_3."""


@dataclass(frozen=True, slots=True)
class Graphlet:
    """A connection node (an object, or the relation of a pair) with some of its feature nodes.

    Attributes:
        connection: `object` or `relation`: what the connection node stands for.
        concepts: The feature nodes.
    """

    connection: str
    concepts: frozenset[ConceptNumber]

    def to_networkx(self) -> "nx.DiGraph[str]":
        """The connection node `c` with an edge to every feature node."""
        import networkx as nx

        graph: nx.DiGraph[str] = nx.DiGraph()
        graph.add_node("c", label=self.connection)
        for space, number in sorted(self.concepts):
            graph.add_node(f"{space}_{number}", label=f"{space}_{number}")
            graph.add_edge("c", f"{space}_{number}")
        return graph


def graphlets_of(connection: str, concepts: tuple[ConceptNumber, ...]) -> frozenset[Graphlet]:
    """All graphlets of one connection node: every non-empty combination of its concepts."""
    return frozenset(
        Graphlet(connection, frozenset(chosen))
        for size in range(1, len(concepts) + 1)
        for chosen in combinations(concepts, size)
    )
