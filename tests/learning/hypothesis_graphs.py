"""Thesis 4.6 to the letter: a tree as a hypothesis graph, a demo as a graph, matched as induced subgraphs by NetworkX.

The library queries bit masks instead; these graphs are the oracle that it is checked against.
"""

import networkx as nx
from networkx.algorithms.isomorphism import DiGraphMatcher, categorical_node_match

from learning.concept_id import OBJECT_SPACES, RELATION_SPACES
from learning.grammar.rcl import RclNode
from learning.percept import NO_CONCEPT, Percept, ShownAction


def demo_graph(percept: Percept, shown: ShownAction) -> "nx.DiGraph[str]":
    """Object and relation layers before the action, the action on its object, and the relations it brought about."""
    graph: nx.DiGraph[str] = nx.DiGraph()
    count = len(percept.object_ids)
    for i in range(count):
        graph.add_node(f"o{i}", label="object")
        for space in OBJECT_SPACES:
            _property(graph, f"o{i}", f"{space}_{percept.properties[space][i]}")
        for j in range(count):
            _relations(graph, f"o{i}", f"o{j}", percept.relations, i, j, "before")
    graph.add_node("action", label=f"action_{shown.action}")
    graph.add_edge("action", f"o{shown.moved}")
    if shown.placement is not None:
        for j in range(count):
            _relations(graph, f"o{shown.moved}", f"o{j}", percept.placement_relations, shown.placement, j, "after")
    return graph


def hypothesis_graph(tree: RclNode) -> "nx.DiGraph[str]":
    """Graphlets of a single event's tree, joined at their connection nodes."""
    graph: nx.DiGraph[str] = nx.DiGraph()
    parts = {child.label: child for child in tree.children}
    moved = _entity(graph, parts["entity"])
    graph.add_node("action", label=str(parts["action"].concept))
    graph.add_edge("action", moved)
    if "destination" in parts:
        _spatial_relation(graph, moved, parts["destination"].children[0], "after")
    return graph


def is_validated(tree: RclNode, percept: Percept, shown: ShownAction) -> bool:
    """Whether the hypothesis graph is an induced subgraph of the demo's."""
    matcher = DiGraphMatcher(
        demo_graph(percept, shown), hypothesis_graph(tree), node_match=categorical_node_match("label", None)
    )
    return bool(matcher.subgraph_is_isomorphic())


def _entity(graph: "nx.DiGraph[str]", node: RclNode) -> str:
    name = f"e{node.first}"
    graph.add_node(name, label="object")
    for child in node.children:
        if child.label == "spatial-relation":
            _spatial_relation(graph, name, child, "before")
        else:
            _property(graph, name, str(child.concept))
    return name


def _spatial_relation(graph: "nx.DiGraph[str]", thing: str, node: RclNode, when: str) -> None:
    ground = next(_entity(graph, child) for child in node.children if child.label == "entity")
    concept = next(child.concept for child in node.children if child.label in RELATION_SPACES)
    _relation(graph, thing, ground, f"{when} {concept}")


def _property(graph: "nx.DiGraph[str]", thing: str, label: str) -> None:
    graph.add_node(f"{thing} {label}", label=label)
    graph.add_edge(thing, f"{thing} {label}")


def _relations(graph: "nx.DiGraph[str]", thing: str, ground: str, relations: object, i: int, j: int, when: str) -> None:
    for space in RELATION_SPACES:
        number = relations[space][i, j]  # type: ignore[index]
        if number != NO_CONCEPT:
            _relation(graph, thing, ground, f"{when} {space}_{number}")


def _relation(graph: "nx.DiGraph[str]", thing: str, ground: str, label: str) -> None:
    name = f"{thing} {ground} {label}"
    graph.add_node(name, label=label)
    graph.add_edge(thing, name)
    graph.add_edge(name, ground)
