"""An action graphlet drawn state by state (thesis, figure 3.14)."""

from executor.knowledge_page import svg
from learning.graphs.action_graphlet import ActionGraphlet
from learning.graphs.graphlet_state import GraphletState

STATE = (168.0, 206.0)
"""Room of one state."""
GAP = 34.0
"""Between two states, for the arrow."""
NODE = (62.0, 24.0)


def draw_graphlet(graphlet: ActionGraphlet) -> str:
    """Each state with its object layer (gripper and object), its relation layer below, and arrows between states."""
    parts: list[str] = []
    width = len(graphlet.states) * (STATE[0] + GAP) - GAP
    for index, state in enumerate(graphlet.states):
        left = index * (STATE[0] + GAP)
        parts += _state(left, index, state, graphlet.states[index - 1] if index else None)
        if index:
            middle = 0.5 * STATE[1]
            parts.append(svg.line(left - GAP + 4, middle, left - 6, middle, "arrow"))
            parts.append(svg.line(left - 12, middle - 5, left - 6, middle, "arrow"))
            parts.append(svg.line(left - 12, middle + 5, left - 6, middle, "arrow"))
    return svg.drawing(width, STATE[1], parts, f"action graphlet {graphlet}")


def _state(left: float, index: int, state: GraphletState, before: GraphletState | None) -> list[str]:
    """One state; what differs from the state before stands out."""
    gripper, thing, relation = (left + 44.0, 62.0), (left + 124.0, 62.0), (left + 84.0, 136.0)
    grip = "closed" if state.gripper_closed else "open"
    place = f"L{state.object_location}" + (" raised" if state.raised else "")
    near = "touch" if state.touching else "apart"
    if state.side is not None:
        near += f" {state.side.name.lower()}"
    new = (
        before is None or before.gripper_closed != state.gripper_closed,
        before is None or (before.object_location, before.raised) != (state.object_location, state.raised),
        before is None or (before.touching, before.side) != (state.touching, state.side),
    )
    nodes = ((gripper, "gripper", "node"), (thing, "c", "connection"), (relation, "R", "node"))
    leaves = (((gripper[0], 108.0), grip), ((thing[0], 108.0), place), ((relation[0], 182.0), near))
    parts = [svg.box(left + 0.5, 0.5, STATE[0] - 1, STATE[1] - 1, "edge")]
    parts.append(svg.text(left + STATE[0] / 2, 20, f"state {index + 1}", "faint"))
    parts += [svg.line(gripper[0], gripper[1], relation[0], relation[1])]
    parts += [svg.line(thing[0], thing[1], relation[0], relation[1])]
    for (place_of, _, _), ((x, y), words), is_new in zip(nodes, leaves, new, strict=True):
        parts.append(svg.line(place_of[0], place_of[1], x, y))
        wide = max(NODE[0], 7.0 * len(words) + 10.0)
        parts.append(svg.box(x - wide / 2, y - NODE[1] / 2, wide, NODE[1], "leaf changed" if is_new else "leaf"))
        parts.append(svg.text(x, y + 4, words))
    for (x, y), words, kind in nodes:
        parts.append(svg.box(x - NODE[0] / 2, y - NODE[1] / 2, NODE[0], NODE[1], kind))
        parts.append(svg.text(x, y + 4, words))
    return parts
