"""What a public tree denotes among the true blocks of a layout: a check on sentences that our own parser has no say in.

The words are read by a supervised tagger that knows only the annotated trees, and put together in all ways in which
relations can be attached; colours and shapes are the true ones of the layout. A sentence is true of an event when every
way that can be carried out does just that. Shared with the learner is how places and relations are measured
(`learning.grammar.innate`).
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from learning.concept_id import Concept
from learning.evaluation.annotation import tokens_of
from learning.evaluation.board_exam import _tagged_leaves, _tags
from learning.evaluation.innate_names import AS_HEADING, AS_RELATION, AS_WORD
from learning.evaluation.public_tree import PublicNode
from learning.evaluation.tagger import Tagger
from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import BoardElements
from learning.grammar.description import senses
from learning.grammar.innate import COLLECTIVE, GROUP, IT, REGION, SIDES, UNIT
from learning.grammar.scene import bits
from learning.train_robots.layout import COLOUR_OF_CODE, SHAPE_OF_CODE, Layout
from twin.board import CELLS

COLOURS = tuple(sorted(COLOUR_OF_CODE.values()))
SHAPES = tuple(sorted(SHAPE_OF_CODE.values()))
BEARING = frozenset((SHAPES.index("cube"),))
"""True shapes that a block can rest on."""
WORDS = {named: concept for concept, named in AS_WORD.items()}
SIDE_OF = {name: side for names in (AS_RELATION, AS_HEADING) for side, name in names.items()}
GROUPS = {"cube-group": GROUP, "stack": COLLECTIVE}

Move = tuple[int, int | None]


class SupervisedReader:
    """Reads sentences by the words of the annotated trees, in all ways in which their parts can be attached."""

    def __init__(self, annotated: Iterable[tuple[str, PublicNode]]) -> None:
        """Train on sentences with their trees."""
        self._tagger = Tagger(_tags(lowered(sentence), tree) for sentence, tree in annotated)

    def commands(self, sentence: str) -> list[PublicNode]:
        """The trees that a command may have."""
        events: list[tuple[PublicNode, list[_Part]]] = []
        for part in _parts(self._leaves(lowered(sentence))):
            if part.action is not None:
                events.append((part.action, []))
            elif events:
                events[-1][1].append(part)
        if not events:
            return []
        action, parts = events[0]
        if len(events) == 1:
            return [_node("event", action, *told) for told in _told(parts, action.value != "take")]
        # What is taken is told in the first event, where it goes in the last.
        (taking, told_first), (putting, told_last) = events[0], events[-1]
        return [
            _node("sequence", _node("event", taking, *first), _node("event", putting, *last))
            for first in _told(told_first, False)
            for last in _told(told_last, True)
        ]

    def things(self, phrase: str) -> list[PublicNode]:
        """The trees that a phrase about a thing may have."""
        parts = [part for part in _parts(self._leaves(lowered(phrase))) if part.action is None]
        return [told[0] for told in _told(parts, False) if told]

    def _leaves(self, tokens: Sequence[str]) -> list[PublicNode]:
        return [PublicNode(each.label, each.value, each.span) for each in _tagged_leaves(self._tagger.tags(tokens))]


@dataclass(frozen=True, slots=True)
class _Part:
    """A word for an action, or words about one thing with the relation before them.

    Attributes:
        action: Leaf of an action.
        relation: Leaves of the relation, and the measure, by which the thing is told.
        about: Leaves about the thing.
    """

    action: PublicNode | None = None
    relation: tuple[PublicNode, ...] = ()
    about: tuple[PublicNode, ...] = ()


def _parts(leaves: Sequence[PublicNode]) -> list[_Part]:
    """Split leaves into actions and things; so many tiles are part of the relation that follows or precedes them."""
    found: list[_Part] = []
    for at, leaf in enumerate(leaves):
        last = found[-1] if found else None
        following = leaves[at + 1] if at + 1 < len(leaves) else None
        if leaf.label == "action":
            found.append(_Part(action=leaf))
        elif leaf.value == "reference":
            continue
        elif leaf.label == "cardinal" and following is not None and following.value == "tile":
            found.append(_Part(relation=(_node("measure", _node("entity", leaf, following)),)))
        elif leaf.value == "tile":
            continue
        elif leaf.label == "relation" or (last is not None and _unfinished(last) and leaf.value in SIDE_OF):
            if last is not None and last.relation and not last.about:
                found[-1] = _Part(relation=(*last.relation, leaf))
            else:
                found.append(_Part(relation=(leaf,)))
        elif last is None or last.action is not None:
            found.append(_Part(about=(leaf,)))
        else:
            found[-1] = _Part(None, last.relation, (*last.about, leaf))
    return found


def _unfinished(part: _Part) -> bool:
    """Whether a part is so many tiles, to a side that is yet to come."""
    return len(part.relation) == 1 and part.relation[0].label == "measure" and not part.about


def _told(parts: Sequence[_Part], goes: bool) -> Iterator[tuple[PublicNode, ...]]:
    """Ways to tell a thing, and where it goes if it does: each relation says more of a thing before it, or where to."""
    things = [part for part in parts if part.action is None]
    heads = things[:1] if things and not things[0].relation else []
    rest = things[len(heads) :]
    for goal in range(len(rest)) if goes else ():
        for before in _attached(heads, rest[:goal]):
            for where in _attached([_Part(None, (), rest[goal].about)], rest[goal + 1 :]):
                relation = _node("spatial-relation", *rest[goal].relation, *where)
                yield (*before, _node("destination", relation))
    if not goes or not rest:
        yield from _attached(heads, rest)


def _attached(heads: Sequence[_Part], more: Sequence[_Part]) -> Iterator[tuple[PublicNode, ...]]:
    """Ways to attach relations to a thing or to what they relate it to; nothing where there is no thing."""
    if not heads or not heads[0].about:
        if not more:
            yield ()
        return
    head = heads[0]
    if not more:
        yield (_node("entity", *head.about),)
        return
    # The first relation is of the head itself; of the rest, some are of its ground and the others of the head again.
    for inner in range(1, len(more) + 1):
        for ground in _attached([_Part(None, (), more[0].about)], more[1:inner]):
            where = _node("spatial-relation", *more[0].relation, *ground)
            yield from _attached([_Part(None, (), (*head.about, where))], more[inner:])


def _node(label: str, *children: PublicNode) -> PublicNode:
    return PublicNode(label, None, None, children)


def lowered(sentence: str) -> tuple[str, ...]:
    """Tokens of a sentence in lower case."""
    return tuple(token.lower() for token in tokens_of(sentence))


@dataclass(frozen=True, slots=True)
class _Goal:
    """Where something goes: in a relation to elements, or so many steps to one side of them (0: of itself)."""

    relation: Concept
    ground: int
    steps: int = 0


class TrueBoard:
    """The true blocks of a layout."""

    def __init__(self, layout: Layout) -> None:
        """Index a layout."""
        self.scene = BoardElements(
            Arrangement(
                columns=tuple(block.cell[0] * CELLS + block.cell[1] for block in layout.blocks),
                levels=tuple(block.cell[2] for block in layout.blocks),
                colours=tuple(COLOURS.index(block.colour) for block in layout.blocks),
                shapes=tuple(SHAPES.index(block.shape) for block in layout.blocks),
                held=layout.held,
            ),
            BEARING,
        )

    def thing(self, node: PublicNode) -> int:
        """Elements that an entity denotes, as a mask; 0 for none."""
        concepts = frozenset(self._concepts(node))
        if not concepts:
            return 0
        known = senses(concepts, self.scene)
        mask = known[0].elements if known else 0
        if known and known[0].nearest:
            mask = self.scene.nearest_to_robot(mask)
        for child in node.children:
            if child.label == "spatial-relation" and mask:
                goal = self._goal(child)
                mask = 0 if goal is None else next(iter(self.scene.related(goal.relation, goal.ground, mask)), 0)
        return mask

    def moves(self, tree: PublicNode) -> set[Move]:
        """Moves that a command allows; a moved block with None stays in the gripper."""
        events = [node for node in tree.nodes() if node.label == "event"]
        if not events:
            return set()
        thing = next((child for child in events[0].children if child.label == "entity"), None)
        goal = next((child for child in events[-1].children if child.label == "destination"), None)
        action = tree.values("action")[-1:] or [""]
        if thing is None:
            return set()
        scene = self.scene
        holds = bool(scene.held)
        mask = self.thing(thing) & scene.blocks & (scene.held if holds else scene.clear & ~scene.held)
        if goal is None and action[0] == "take" and not holds:
            return {(each, None) for each in bits(mask)}
        found: set[Move] = set()
        for each in bits(mask):
            own = 1 << scene.columns[each]
            places = own if goal is None and holds else 0 if goal is None else self._places(goal, each)
            places &= scene.usable & (own if holds else ~own)
            found |= {(each, place) for place in bits(places)}
        return found

    def _places(self, destination: PublicNode, moved: int) -> int:
        where = next((child for child in destination.children if child.label == "spatial-relation"), None)
        goal = self._goal(where) if where is not None else None
        if goal is None:
            return 0
        ground = goal.ground & ~(1 << moved)
        if goal.steps:
            if goal.relation not in SIDES:
                return 0
            return self.scene.shifted(goal.relation, goal.steps, ground or 1 << moved)
        return self.scene.landing(goal.relation, ground)

    def _goal(self, node: PublicNode) -> _Goal | None:
        relation: Concept | None = None
        ground = steps = 0
        for child in node.children:
            if child.label == "relation" and child.value is not None:
                relation = WORDS.get(("relation", child.value)) or SIDE_OF.get(child.value)
            elif child.label == "indicator" and child.value in SIDE_OF:
                relation = SIDE_OF[child.value]
            elif child.label == "entity":
                ground = self.thing(child)
            elif child.label == "measure":
                counts = child.values("cardinal")
                steps = int(counts[0]) if counts and counts[0].isdigit() else 1
        if relation is None or not (ground or steps):
            return None
        return _Goal(relation, ground, steps)

    def _concepts(self, node: PublicNode) -> Iterator[Concept]:
        labels = [child.label for child in node.children]
        for child in node.children:
            value = child.value or ""
            if child.label == "color" and value in COLOURS:
                yield Concept("colour", COLOURS.index(value))
            elif child.label == "type" and value in SHAPES:
                yield Concept("shape", SHAPES.index(value))
            elif child.label == "type" and value in GROUPS:
                yield GROUPS[value]
            elif (child.label, value) in WORDS and WORDS[child.label, value] not in (UNIT, IT):
                yield WORDS[child.label, value]
        if "type" not in labels and "color" in labels:
            yield COLLECTIVE if labels.count("color") > 1 else Concept("shape", SHAPES.index("cube"))
        elif "type" not in labels and "indicator" in labels and "cardinal" not in labels:
            yield REGION
