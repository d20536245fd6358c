"""Kinds of meaning in an annotated command, for a figure per kind, and which of them the thesis's vocabulary has."""

from learning.evaluation.public_tree import PublicNode

SINGLE_ACTIONS = ("move", "take", "drop")
VOCABULARY = {
    "action": frozenset(SINGLE_ACTIONS),
    "color": None,  # any single colour
    "type": frozenset({"cube", "prism", "reference", "corner", "edge", "region"}),
    "relation": frozenset({"above", "left", "right", "front", "forward", "backward", "adjacent", "within"}),
    "indicator": frozenset({"front", "back", "left", "right", "center"}),
    "id": None,
    "reference-id": None,
}
"""Public leaf labels to the values that concepts of colour, shape, location, direction, distance, action and reference
can express; None for any. Corners, edges, the centre and regions are locations; `within` one of them says so too."""

_PLACES = frozenset({"corner", "edge", "region", "board"})
_GROUPS = frozenset({"cube-group", "stack", "type-reference-group"})


def kinds_of(tree: PublicNode) -> tuple[str, ...]:
    """Name the kinds of a command; a command can be of several.

    First the form (`single take`, `single drop`, `single move` or `take then drop`), then every kind of meaning beyond
    a colour, a shape and one relation; `plain` when there is none but perhaps "it".
    """
    actions = tree.values("action")
    form = "take then drop" if tree.label == "sequence" else f"single {actions[0] if actions else 'event'}"
    found = _meanings(tree)
    if found <= {"it"}:
        found.add("plain")
    return (form, *sorted(found))


def _meanings(tree: PublicNode) -> set[str]:
    found: set[str] = set()
    types, indicators, relations = (set(tree.values(label)) for label in ("type", "indicator", "relation"))
    entities = [node for node in tree.nodes() if node.label == "entity"]
    found.update(place for place in _PLACES & types)
    if types & _GROUPS or any(sum(c.label == "color" for c in entity.children) > 1 for entity in entities):
        found.add("group")
    if "stack" in types:
        found.add("stack")
    for name, present in (
        ("count", bool(tree.values("cardinal"))),
        ("displacement", any(node.label == "measure" for node in tree.nodes())),
        ("single", "individual" in indicators),
        ("centre", "center" in indicators),
        ("leftmost, rightmost", bool(indicators & {"leftmost", "rightmost"})),
        ("nearest block", "nearest" in indicators),
        ("nearest to", "nearest" in relations),
        ("superlative", bool(indicators & {"nearest", "leftmost", "rightmost"}) or "nearest" in relations),
        ("beside, left, right, front", bool(relations - {"above", "within", "nearest"})),
        ("it", "reference" in types),
        ("one", bool(types & {"type-reference", "type-reference-group"})),
        ("robot", "robot" in types),
    ):
        if present:
            found.add(name)
    for event in (node for node in tree.nodes() if node.label == "event"):
        for part in event.children:
            if part.label == "entity" and _is_modified(part):
                found.add("modifier of the moved thing")
            if part.label == "destination" and any(_is_modified(n) for n in part.nodes() if n.label == "entity"):
                found.add("modifier in the destination")
    return found


def _is_modified(entity: PublicNode) -> bool:
    return any(child.label == "spatial-relation" for child in entity.children)


def outside_vocabulary(tree: PublicNode) -> tuple[str, ...]:
    """Name the labels and values of a tree that the thesis's vocabulary of meaning cannot express; empty if none."""
    outside: set[str] = set()
    for node in tree.nodes():
        if node.label == "entity" and sum(child.label == "color" for child in node.children) > 1:
            outside.add("several colours of one thing")
        if node.label == "measure":
            outside.add("measure")
        if node.value is None:
            continue
        allowed = VOCABULARY.get(node.label, frozenset())
        if allowed is not None and node.value not in allowed:
            outside.add(node.label if node.label not in VOCABULARY else f"{node.label} {node.value}")
    return tuple(sorted(outside))
