"""Bottom-up chart (CKY) over a sentence and a scene: substitute, group, query (thesis 5.3, algorithm 1).

An item is an RCL element over a span of words together with what it denotes in the scene. Items of the same element,
the same children and the same denotation differ only in how they came about, so of these the most probable alone is
kept (Viterbi). An element that denotes nothing in the scene is dropped at once. Words that carry no concept are passed
over at the cost of their probability of being function words.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from learning.concept_id import ACTION_SPACE, OBJECT_SPACES, REFERENCE_SPACE, RELATION_SPACES, Concept
from learning.grammar.actions import ActionTable
from learning.grammar.pcfg import Pcfg, Rule
from learning.grammar.preferences import Preferences, rule_feature
from learning.grammar.rcl import RclNode
from learning.grammar.scene import SceneSets

MAX_GAP = 5
"""Most words that are passed over between two elements."""
BEAM = 12
"""Items kept of one kind of element over one span."""
ROOT_BEAM = 30
"""The same for events and sequences, whose readings are compared with one another."""
SETTLED = 40.0
"""Sightings of an element after which orders of its children that were hardly ever seen are no longer tried."""

PROPERTIES = frozenset((*OBJECT_SPACES, REFERENCE_SPACE))
EVENT_PARTS = ("action", "entity", "destination")
ENTITY_PARTS = (*OBJECT_SPACES, "spatial-relation")
USUAL_EVENTS = (
    ("action",),
    ("action", "entity"),
    ("action", "entity", "destination"),
    ("action", "destination"),
)
UNUSUAL = -3.0
"""Added to the log weight of an order of children in which what governs does not come first, seen before or not."""
ROOTS = frozenset(("event", "sequence", "event*"))


@dataclass(frozen=True, slots=True)
class LexicalEntry:
    """One way to read a span of words: a concept and its log probability."""

    first: int
    after: int
    concept: Concept
    log_probability: float


@dataclass(slots=True)
class Item:
    """An element over the words [first, after) that denotes objects and places (bit masks) in the scene."""

    label: str
    parts: tuple[str, ...]
    first: int
    after: int
    objects: int
    places: int
    action: int
    score: float
    children: tuple["Item", ...]
    concept: Concept | None = None

    def tree(self) -> RclNode:
        """Build the RCL node of this item."""
        return RclNode(
            self.label, self.concept, self.first + 1, self.after, tuple(child.tree() for child in self.children)
        )

    def covered(self) -> set[int]:
        """Positions of the words that a lexical item stands for; the others are passed over."""
        return {position for leaf in self.leaves() for position in range(leaf.first, leaf.after)}

    def leaves(self) -> list["Item"]:
        """List the lexical items from left to right."""
        if self.concept is not None:
            return [self]
        return [leaf for child in self.children for leaf in child.leaves()]


@dataclass(frozen=True, slots=True)
class Reading:
    """A reading of a whole sentence: what it would do in the scene.

    Attributes:
        item: Root item (`event` or `sequence`).
        action: Number of the action graphlet that is carried out, a sequence counted as the action it composes to.
        moved: Objects it may be about, as a mask.
        places: Placements it may end at, as a mask; 0 when it ends in the gripper.
        score: Log probability.
    """

    item: Item
    action: int
    moved: int
    places: int
    score: float

    def rules(self) -> list[Rule]:
        """List the productions used, that of the whole command first."""
        return [("command", (self.item.label,)), *self.item.tree().rules()]

    @property
    def moves(self) -> int:
        """How many different moves the reading allows."""
        return self.moved.bit_count() * max(1, self.places.bit_count())


Cell = dict[str, list[Item]]
"""Items over one span by label, most probable first."""
Found = dict[tuple[str, tuple[str, ...], int, int, int, Concept | None], Item]
"""The best item of each label, children, denotation and concept over one span."""


class Chart:
    """All readings of one sentence in one scene."""

    def __init__(
        self,
        n_words: int,
        entries: Sequence[LexicalEntry],
        skip: Sequence[float],
        grammar: Pcfg,
        scene: SceneSets,
        actions: ActionTable,
        preferences: Preferences,
    ) -> None:
        """Fill the chart.

        Args:
            n_words: Number of words.
            entries: Lexical entries.
            skip: Log probability of passing over each word, (n_words,).
            grammar: Π, for the weights of rules.
            scene: What concepts are true of.
            actions: The known action graphlets.
            preferences: Weights of rules beside their probabilities.
        """
        self.n_words = n_words
        self.grammar = grammar
        self.scene = scene
        self.actions = actions
        self.preferences = preferences
        self._skipped = [0.0]
        for cost in skip:
            self._skipped.append(self._skipped[-1] + cost)
        self._cells: dict[tuple[int, int], Cell] = {}
        self._orders: dict[tuple[str, tuple[str, ...]], bool] = {}
        self._weights: dict[tuple[str, tuple[str, ...]], float] = {}
        lexical: dict[tuple[int, int], list[Item]] = {}
        for entry in entries:
            item = self._lexical_item(entry)
            if item is not None:
                lexical.setdefault((entry.first, entry.after), []).append(item)
        for width in range(1, n_words + 1):
            for first in range(n_words - width + 1):
                self._fill(first, first + width, lexical.get((first, first + width), []))

    def readings(self) -> list[Reading]:
        """Give the readings of the whole sentence, most probable first, one an action, object and place set."""
        best: dict[tuple[int, int, int], Reading] = {}
        for (first, after), cell in self._cells.items():
            around = self._skipped[first] + self._skipped[self.n_words] - self._skipped[after]
            for item in (*cell.get("event", ()), *cell.get("sequence", ())):
                outcome = self._outcome(item)
                if outcome is None:
                    continue
                score = item.score + around + self._weight("command", (item.label,))
                known = best.get(outcome)
                if known is None or known.score < score:
                    best[outcome] = Reading(item, *outcome, score)
        return sorted(best.values(), key=lambda reading: -reading.score)

    def _weight(self, left: str, right: tuple[str, ...]) -> float:
        key = (left, right)
        weight = self._weights.get(key)
        if weight is None:
            weight = self.grammar.log_weight(left, right) + self.preferences.of(rule_feature(left, right))
            if (left == "event" and right not in USUAL_EVENTS) or right[0] == "entity" and left == "spatial-relation":
                weight += UNUSUAL
            self._weights[key] = weight
        return weight

    def _lexical_item(self, entry: LexicalEntry) -> Item | None:
        concept, scene = entry.concept, self.scene
        objects = places = 0
        action = -1
        if concept.space in OBJECT_SPACES:
            objects, places = scene.objects.get(concept, 0), scene.places.get(concept, 0)
            if not objects and not places:
                return None
        elif concept.space == REFERENCE_SPACE:
            objects = scene.all_objects
        elif concept.space == ACTION_SPACE:
            action = concept.number
        return Item(
            concept.space, (), entry.first, entry.after, objects, places, action, entry.log_probability, (), concept
        )

    def _fill(self, first: int, after: int, lexical: list[Item]) -> None:
        found: Found = {}
        for item in lexical:
            _keep(found, item)
        for middle in range(first + 1, after):
            left = self._cells.get((first, middle))
            if left is None:
                continue
            for start in range(middle, min(middle + MAX_GAP, after - 1) + 1):
                right = self._cells.get((start, after))
                if right is not None:
                    self._join(found, left, right, self._skipped[start] - self._skipped[middle])
        if found:
            self._close(found)
            self._cells[first, after] = self._prune(found)

    def _prune(self, found: Found) -> Cell:
        kept: Cell = {}
        for item in sorted(found.values(), key=lambda item: -item.score):
            alike = kept.setdefault(item.label, [])
            if len(alike) < (ROOT_BEAM if item.label in ROOTS else BEAM):
                alike.append(item)
        return kept

    def _allowed(self, label: str, parts: tuple[str, ...], usual: bool) -> bool:
        """Whether to try an order of children: the usual ones, those seen, and all until the element has settled."""
        if usual:
            return True
        key = (label, parts)
        allowed = self._orders.get(key)
        if allowed is None:
            settled = self.grammar.total(label) >= SETTLED
            allowed = self._orders[key] = not settled or self.grammar.seen_start(label, parts)
        return allowed

    def _join(self, found: Found, left: Cell, right: Cell, gap: float) -> None:
        """Make every element that an element of the left cell and one of the right cell make up."""
        for whole in left.get("entity*", ()):
            for kind in ENTITY_PARTS:
                if kind not in whole.parts and "reference" not in whole.parts:
                    for part in right.get(kind, ()):
                        self._extend_entity(found, whole, part, gap)
        grounds = [item for item in right.get("entity", ()) if "reference" not in item.parts]
        for kind in RELATION_SPACES:
            for relation in left.get(kind, ()) if grounds else ():
                for ground in grounds:
                    self._relate(found, relation, ground, (relation, ground), gap)
            relations = right.get(kind)
            if relations and self._allowed("spatial-relation", ("entity", kind), usual=False):
                for ground in left.get("entity", ()):
                    if "reference" not in ground.parts:
                        for relation in relations:
                            self._relate(found, relation, ground, (ground, relation), gap)
        for whole in left.get("event*", ()):
            for kind in EVENT_PARTS:
                if kind not in whole.parts and self._event_order((*whole.parts, kind)):
                    for part in right.get(kind, ()):
                        self._extend_event(found, whole, part, gap)
        closing = [item for item in right.get("event", ()) if item.places]
        for opening in left.get("event", ()) if closing else ():
            if not opening.places and "entity" in opening.parts:
                for event in closing:
                    self._sequence(found, opening, event, gap)

    def _event_order(self, parts: tuple[str, ...]) -> bool:
        # An imperative begins or ends with its action: in between, two clauses would pass for one.
        if parts[0] != "action" and "action" in parts[:-1]:
            return False
        return self._allowed("event", parts, usual=parts in USUAL_EVENTS)

    def _extend_entity(self, found: Found, left: Item, right: Item, gap: float) -> None:
        objects = left.objects & right.objects
        if objects:
            score = left.score + right.score + gap
            parts, children = (*left.parts, right.label), (*left.children, right)
            _keep(found, Item("entity*", parts, left.first, right.after, objects, 0, -1, score, children))

    def _relate(self, found: Found, relation: Item, ground: Item, children: tuple[Item, Item], gap: float) -> None:
        if relation.concept is None:
            return
        objects, places = self.scene.related(relation.concept, ground.objects)
        if not objects and not places:
            return
        parts = (children[0].label, children[1].label)
        score = children[0].score + children[1].score + gap + self._weight("spatial-relation", parts)
        first, after = children[0].first, children[1].after
        _keep(found, Item("spatial-relation", parts, first, after, objects, places, -1, score, children))

    def _extend_event(self, found: Found, left: Item, right: Item, gap: float) -> None:
        objects = right.objects if right.label == "entity" else left.objects
        places = right.places if right.label == "destination" else left.places
        action = right.action if right.label == "action" else left.action
        score = left.score + right.score + gap
        parts, children = (*left.parts, right.label), (*left.children, right)
        _keep(found, Item("event*", parts, left.first, right.after, objects, places, action, score, children))

    def _sequence(self, found: Found, left: Item, right: Item, gap: float) -> None:
        action = self.actions.composed.get((left.action, right.action))
        objects = left.objects & right.objects if "entity" in right.parts else left.objects
        if action is None or not objects:
            return
        parts = ("event", "event")
        score = left.score + right.score + gap + self._weight("sequence", parts)
        children = (left, right)
        _keep(found, Item("sequence", parts, left.first, right.after, objects, right.places, action, score, children))

    def _close(self, found: Found) -> None:
        """Apply unary steps: begin and complete entities, destinations and events."""
        for item in list(found.values()):
            if item.label in PROPERTIES and item.objects:
                self._over(found, item, "entity*", (item.label,), item.objects, 0, 0.0, (item,))
            if item.label in ("location", "spatial-relation") and item.places:
                weight = self._weight("destination", (item.label,))
                self._over(found, item, "destination", (item.label,), 0, item.places, weight, (item,))
        for item in list(found.values()):
            if item.label == "entity*":
                weight = self._weight("entity", item.parts)
                self._over(found, item, "entity", item.parts, item.objects, 0, weight, item.children)
        for item in list(found.values()):
            if item.label in EVENT_PARTS and self._event_order((item.label,)):
                self._over(found, item, "event*", (item.label,), item.objects, item.places, 0.0, (item,))
        for item in list(found.values()):
            if item.label == "event*" and "action" in item.parts and len(item.parts) > 1:
                weight = self._weight("event", item.parts)
                self._over(found, item, "event", item.parts, item.objects, item.places, weight, item.children)

    def _over(
        self,
        found: Found,
        item: Item,
        label: str,
        parts: tuple[str, ...],
        objects: int,
        places: int,
        weight: float,
        children: tuple[Item, ...],
    ) -> None:
        score = item.score + weight
        _keep(found, Item(label, parts, item.first, item.after, objects, places, item.action, score, children))

    def _outcome(self, item: Item) -> tuple[int, int, int] | None:
        """Give action, movable objects and free places of a root item; None when the scene does not allow it."""
        action, scene = item.action, self.scene
        has_destination = item.label == "sequence" or "destination" in item.parts
        if item.label == "event" and "entity" not in item.parts:
            return None
        starts_held = item.label == "event" and self.actions.starts_held[action]
        ends_held = item.label == "event" and self.actions.ends_held[action]
        moved = item.objects & (scene.held if starts_held else scene.clear & ~scene.held)
        if not moved:
            return None
        if ends_held:
            return None if has_destination else (action, moved, 0)
        places = item.places & scene.usable_places
        if not has_destination:
            if not starts_held or scene.percept.held is None:
                return None
            # A block that is let go without a word about where falls straight down.
            places = 1 << scene.column_of[scene.percept.held]
        elif moved.bit_count() == 1 and not starts_held:
            places &= ~(1 << scene.column_of[moved.bit_length() - 1])
        return (action, moved, places) if places else None


def _keep(found: Found, item: Item) -> None:
    key = (item.label, item.parts, item.objects, item.places, item.action, item.concept)
    known = found.get(key)
    if known is None or known.score < item.score:
        found[key] = item
