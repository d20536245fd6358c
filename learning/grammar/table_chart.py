"""All readings of a table sentence at once: a chart of RCL elements, and how often each part is expected in them.

Innate are the elements and what may consist of what (a command tells an event, an event has an action, an entity and
perhaps a destination ...). In which order and how often is the grammar's; which words, the lexicon's. In a scene only
readings that do there what was shown are built (algorithm 1, generalised to all readings); the inside-outside
algorithm (Lari and Young 1990) then counts words and rules by the probability of the readings that they are part of.
"""

import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from learning.concept_id import ACTION_SPACE, REFERENCE, REFERENCE_SPACE, Concept
from learning.grammar.rcl import RclNode
from learning.grounding.kind_sizes import AMONG_KIND
from learning.grounding.table_scene import NAMED, NEAR_SPACE, PLACE_SPACE, SUPPORT_SPACE, TableScene

Rule = tuple[str, tuple[str, ...]]
RuleWeight = Callable[[str, tuple[str, ...]], float]
JunctureWeight = Callable[[str, tuple[str, ...]], float]
LOCATION = "location"
ELEMENTS = {PLACE_SPACE: LOCATION, NEAR_SPACE: "distance", SUPPORT_SPACE: "direction", AMONG_KIND: "size"}
"""Elements of concepts whose feature space is innate; all others are called as their space."""
RELATIONS = ("direction", "distance")
LONGEST_GAP = 5
"""Words passed over in a row at most."""
MOST_LOOKS = 4
MOST_ITEMS = 10
"""Items of one kind that an event may be made of."""
ANYTHING = -1
"""Mask of an entity where there is no scene."""
NOWHERE = "nowhere"
"""What an event has in the place of a destination where it has none."""
END = ""
"""Where no more words are passed over."""
LEAST_SHARE = 1e-4
"""Ways that are rarer in all readings of a sentence are not counted."""


@dataclass(frozen=True, slots=True)
class WordUse:
    """A way to read an n-gram.

    Attributes:
        first: Position of its first piece.
        after: Position after its last.
        concept: What it means; number -1 for any concept of the space, where there is no scene.
        ngram: Its pieces, joined by spaces.
        weight: Log probability of the n-gram, given the concept.
        unseen: Whether it is taken to be said of what was not seen well enough to tell.
    """

    first: int
    after: int
    concept: Concept
    ngram: str
    weight: float
    unseen: bool = False


Edge = tuple[float, tuple["Item", ...], Rule | None]


@dataclass(slots=True, eq=False)
class Item:
    """All ways to read a span as one element with one meaning.

    Attributes:
        label: Element.
        first: Position of its first piece.
        after: Position after its last.
        mask: Objects it may be about, as a bit mask.
        key: What else tells items of one label and span apart.
        inside: Log of the summed weight of all ways.
        edges: The ways: own weight, parts, and the rule used.
        use: The word use of a leaf.
        outside: Log of the summed weight of all that is around.
    """

    label: str
    first: int
    after: int
    mask: int
    key: tuple[object, ...] = ()
    inside: float = -math.inf
    edges: list[Edge] = field(default_factory=list)
    use: WordUse | None = None
    outside: float = -math.inf


@dataclass(frozen=True, slots=True)
class Expected:
    """What readings are made of, in expectation.

    Attributes:
        uses: (N-gram, concept) to how often it is read so.
        passed: Piece to how often it is passed over.
        rules: Rule to how often it is used.
        junctures: Place between two parts, with a piece that is passed over there or `END`, to how often it is.
    """

    uses: Mapping[tuple[str, Concept], float]
    passed: Mapping[str, float]
    rules: Mapping[Rule, float]
    junctures: Mapping[tuple[str, str], float]


class TableChart:
    """Readings of one sentence."""

    def __init__(
        self,
        pieces: Sequence[str],
        uses: Sequence[WordUse],
        skip: Sequence[float],
        weight: RuleWeight,
        juncture: JunctureWeight,
        scene: TableScene | None,
    ) -> None:
        """Build the chart.

        Args:
            pieces: The sentence.
            uses: Ways to read its n-grams.
            skip: Log weight of passing over each piece before and behind the command.
            weight: Log probability of a rule.
            juncture: Log probability of passing over some pieces between two parts: name of the place, pieces.
            scene: What was shown; None reads the sentence by itself.
        """
        self._pieces = tuple(pieces)
        self._skip = skip
        self._weight = weight
        self._juncture = juncture
        self._passing: dict[tuple[str, int, int], float] = {}
        self._scene = scene
        self._masks = {} if scene is None else scene.masks()
        self._sums = [0.0]
        for cost in skip:
            self._sums.append(self._sums[-1] + cost)
        self._items: dict[tuple[object, ...], Item] = {}
        self._order: list[Item] = []
        self.root: Item | None = None
        self._build(uses)

    def expected(self) -> Expected | None:
        """Expected counts over all readings; None where there is none."""
        if self.root is None:
            return None
        total = self.root.inside
        self.root.outside = 0.0
        uses: defaultdict[tuple[str, Concept], float] = defaultdict(float)
        rules: defaultdict[Rule, float] = defaultdict(float)
        junctures: defaultdict[tuple[str, str], float] = defaultdict(float)
        covered = [0.0] * len(self._pieces)
        for item in (self.root, *reversed(self._order)):
            if item.outside == -math.inf:
                continue
            if item.use is not None:
                share = math.exp(item.outside + item.inside - total)
                uses[item.use.ngram, item.use.concept] += share
                for at in range(item.first, item.after):
                    covered[at] += share
            for own, parts, rule in item.edges:
                below = own + sum(part.inside for part in parts)
                share = math.exp(item.outside + below - total)
                if rule is not None:
                    rules[rule] += share
                if share > LEAST_SHARE:
                    for before, behind in zip(parts, parts[1:], strict=False):
                        for piece in (*self._pieces[before.after : behind.first], END):
                            junctures[_place(item.label, behind), piece] += share
                for part in parts:
                    part.outside = _add(part.outside, item.outside + below - part.inside)
        passed: defaultdict[str, float] = defaultdict(float)
        for piece, share in zip(self._pieces, covered, strict=True):
            passed[piece] += max(0.0, 1.0 - share)
        return Expected(uses, passed, rules, junctures)

    def best(self) -> RclNode | None:
        """The most likely tree, over positions of pieces counted from 1; None where there is none."""
        if self.root is None:
            return None
        scores: dict[int, tuple[float, Edge | None]] = {}
        for item in (*self._order, self.root):
            options = [(edge[0] + sum(scores[id(part)][0] for part in edge[1]), edge) for edge in item.edges]
            leaf = item.use.weight if item.use is not None else -math.inf
            scores[id(item)] = max(options, key=lambda option: option[0]) if options else (leaf, None)
        return self._tree(self.root, scores)[0]

    def _tree(self, item: Item, scores: Mapping[int, tuple[float, Edge | None]]) -> list[RclNode]:
        if item.use is not None:
            return [RclNode(item.label, item.use.concept, item.first + 1, item.after)]
        edge = scores[id(item)][1]
        parts = () if edge is None else edge[1]
        nodes = [node for part in parts for node in self._tree(part, scores)]
        if edge is None or edge[2] is None or item.label in ("command", "framed"):
            return nodes
        return [RclNode(item.label, None, min(n.first for n in nodes), max(n.last for n in nodes), tuple(nodes))]

    def _put(
        self,
        label: str,
        parts: tuple[Item, ...],
        mask: int,
        key: tuple[object, ...] = (),
        rule: Rule | None = None,
    ) -> Item:
        """Add one way to read a span."""
        first, after = parts[0].first, parts[-1].after
        name = label, first, after, mask, key
        item = self._items.get(name)
        if item is None:
            item = self._items[name] = Item(label, first, after, mask, key)
            self._order.append(item)
        own = 0.0 if rule is None else self._weight(*rule)
        for before, behind in zip(parts, parts[1:], strict=False):
            own += self._passed_between(_place(label, behind), before.after, behind.first)
        item.edges.append((own, parts, rule))
        item.inside = _add(item.inside, own + sum(part.inside for part in parts))
        return item

    def _passed_between(self, place: str, first: int, after: int) -> float:
        """Log weight of passing over the pieces first .. after - 1 in a place between two parts."""
        name = place, first, after
        known = self._passing.get(name)
        if known is None:
            known = self._passing[name] = self._juncture(place, self._pieces[first:after])
        return known

    def _build(self, uses: Sequence[WordUse]) -> None:
        leaves = [self._leaf(use) for use in uses]
        looks = [leaf for leaf in leaves if leaf.label not in (ACTION_SPACE, REFERENCE_SPACE, LOCATION, *RELATIONS)]
        described = self._descriptions([leaf for leaf in looks if leaf.mask])
        plain = _unique(self._entity(each, None) for each in described)
        relations = [leaf for leaf in leaves if leaf.label in RELATIONS]
        places = [leaf for leaf in leaves if leaf.label == LOCATION]
        spatial = _unique((*self._related(relations, plain), *self._placed(places)))
        located = [
            self._entity(each, where)
            for each in described
            for where in spatial
            if self._follows(each, where) and each.mask & self._where(where)
        ]
        entities = _unique((*plain, *located))
        destinations = _unique(
            self._put("destination", (each,), 0, (), ("destination", (each.label,)))
            for each in spatial
            if self._reached(each)
        )
        actions = [leaf for leaf in leaves if leaf.label == ACTION_SPACE]
        references = _unique(
            self._put("entity", (leaf,), leaf.mask, ("reference",), ("entity", (REFERENCE_SPACE,)))
            for leaf in leaves
            if leaf.label == REFERENCE_SPACE
        )
        meant = [each for each in entities if self._scene is None or each.mask >> self._scene.moved & 1]
        self._commands(actions, meant, references, destinations)

    def _leaf(self, use: WordUse) -> Item:
        label = element_of(use.concept)
        mask = ANYTHING if self._scene is None else self._masks.get(use.concept, 0)
        if use.concept == REFERENCE and self._scene is not None:
            mask = 1 << self._scene.moved
        if use.unseen and self._scene is not None:
            mask = self._scene.unseen[use.concept.space]
        item = Item(label, use.first, use.after, mask, (use.concept,), use.weight, [], use)
        self._order.append(item)
        return item

    def _follows(self, before: Item, behind: Item) -> bool:
        return 0 <= behind.first - before.after <= LONGEST_GAP

    def _descriptions(self, looks: Sequence[Item]) -> list[Item]:
        """Words about one thing, in any order, each of another feature space."""
        found = _unique(self._put("description", (leaf,), leaf.mask, (leaf.label,)) for leaf in looks)
        longer = found
        for _ in range(MOST_LOOKS - 1):
            longer = _unique(
                self._put("description", (each, leaf), each.mask & leaf.mask, (*each.key, leaf.label))
                for each in longer
                for leaf in looks
                if self._follows(each, leaf) and leaf.label not in each.key and each.mask & leaf.mask
            )
            found = [*found, *longer]
        return found

    def _entity(self, described: Item, where: Item | None) -> Item:
        """A thing that is described, and where it is."""
        if where is None:
            rule = "entity", tuple(str(label) for label in described.key)
            return self._put("entity", (described,), described.mask, (), rule)
        rule = "entity", (*(str(label) for label in described.key), where.label)
        return self._put("entity", (described, where), described.mask & self._where(where), ("located",), rule)

    def _related(self, relations: Sequence[Item], entities: Sequence[Item]) -> list[Item]:
        """Relations to things, before or after their word."""
        found = []
        for leaf in relations:
            for thing in entities:
                if self._follows(leaf, thing):
                    parts: tuple[Item, Item] = leaf, thing
                elif self._follows(thing, leaf):
                    parts = thing, leaf
                else:
                    continue
                stands, reached = self._standing(leaf, thing.mask)
                if stands or reached:
                    rule = "spatial-relation", tuple(part.label for part in parts)
                    found.append(self._put("spatial-relation", parts, stands, (reached,), rule))
        return found

    def _standing(self, leaf: Item, ground: int) -> tuple[int, bool]:
        """Objects that stand in a relation to any of `ground`, and whether the moved one does in the end."""
        scene, use = self._scene, leaf.use
        if scene is None or use is None:
            return ANYTHING, True
        mask = 0
        for (i, j), concepts in scene.relations.items():
            if ground >> j & 1 and use.concept in concepts:
                mask |= 1 << i
        reached = any(ground >> j & 1 and use.concept in concepts for j, concepts in scene.goal_relations.items())
        return mask, reached

    def _placed(self, places: Sequence[Item]) -> list[Item]:
        """Places, told by one word or two."""
        pairs = [(one, two) for one in places for two in places if self._follows(one, two) and one.key != two.key]
        found = []
        for parts in (*((each,) for each in places), *pairs):
            concepts = {part.use.concept for part in parts if part.use is not None}
            if self._scene is None:
                stands, reached = ANYTHING, True
            else:
                stands = sum(1 << i for i, at in enumerate(self._scene.places) if concepts <= at)
                reached = concepts <= self._scene.goal
            if stands or reached:
                rule = "spatial-relation", tuple(part.label for part in parts)
                found.append(self._put("spatial-relation", parts, stands, (reached,), rule))
        return found

    def _where(self, spatial: Item) -> int:
        return spatial.mask

    def _reached(self, spatial: Item) -> bool:
        return bool(spatial.key[0])

    def _commands(
        self,
        actions: Sequence[Item],
        entities: Sequence[Item],
        references: Sequence[Item],
        destinations: Sequence[Item],
    ) -> None:
        """Events, sequences of two, and the whole command."""
        groups = (
            ("action", self._foremost(actions)),
            *(("entity", self._foremost(group)) for group in self._ranked(entities)),
            ("it", self._foremost(references)),
            ("destination", self._foremost(destinations)),
        )
        components = [(kind, item) for kind, group in groups for item in group]
        partial: list[tuple[Item, tuple[str, ...]]] = [
            (self._put("part", (item,), 0, self._started(kind, item)), (kind,))
            for kind, item in components
            if kind != "it"
        ]
        partial = list({id(part): (part, kinds) for part, kinds in partial}.values())
        every = list(partial)
        for _ in range(3):
            grown: dict[int, tuple[Item, tuple[str, ...]]] = {}
            for each, kinds in partial:
                for kind, item in components:
                    if kind in kinds or not _may_follow(kinds, kind) or not self._follows(each, item):
                        continue
                    which = each.key[1] if kind != "action" else self._started(kind, item)[1]
                    now = (*kinds, kind)
                    longer = self._put("part", (each, item), 0, (now, which))
                    grown[id(longer)] = longer, now
            partial = list(grown.values())
            every += partial
        framed = [(self._framed(each, kinds), kinds) for each, kinds in every if "action" in kinds]
        events = [event for each, kinds in framed if (event := self._event(each, kinds)) is not None]
        firsts = _unique(event for event in events if event.key in (("first",), ("any",)))
        alone = _unique(event for event in events if event.key in (("alone",), ("any",)))
        seconds = _unique(event for event in events if event.key == ("second",))
        for event in alone:
            self._finish(event, "event")
        for one in firsts:
            for two in seconds:
                if self._follows(one, two):
                    pair = self._put("sequence", (one, two), 0, (), ("sequence", ("event", "event")))
                    self._finish(pair, "sequence")

    def _ranked(self, entities: Sequence[Item]) -> Iterator[list[Item]]:
        """Entities in groups that are not weighed against each other.

        Where a thing is explains more words than what it is, and would leave it no room. In a scene few are possible.
        """
        if self._scene is not None:
            yield list(entities)
            return
        yield [each for each in entities if not each.key]
        yield [each for each in entities if each.key]

    def _foremost(self, items: Sequence[Item]) -> list[Item]:
        """The items that explain most of what they span, compared with passing it over."""
        if len(items) <= MOST_ITEMS:
            return list(items)
        worth = {id(item): item.inside - self._sums[item.after] + self._sums[item.first] for item in items}
        return sorted(items, key=lambda item: -worth[id(item)])[:MOST_ITEMS]

    def _started(self, kind: str, item: Item) -> tuple[tuple[str, ...], int | None]:
        """Key of a part of an event: kinds of its components, and the number of its action."""
        use = item.use
        return (kind,), use.concept.number if kind == "action" and use is not None else None

    def _framed(self, part: Item, kinds: tuple[str, ...]) -> Item:
        """Parts of an event, weighed by how often its action has a destination."""
        number = part.key[1]
        frame = f"{ACTION_SPACE}_{number}", ("destination",) if "destination" in kinds else (NOWHERE,)
        return self._put("framed", (part,), 0, (number, kinds), frame)

    def _event(self, framed: Item, kinds: tuple[str, ...]) -> Item | None:
        """An event, where its components make one."""
        rule = "event", tuple("entity" if kind == "it" else kind for kind in kinds)
        whole = self._scene is None or framed.key[0] == self._scene.action
        if "entity" in kinds:
            if "destination" not in kinds and "it" not in kinds and (self._scene is None or not whole):
                key = "any" if self._scene is None else "first"
            elif whole:
                key = "alone"
            else:
                return None
        elif "it" in kinds:
            key = "second"
        else:
            return None
        return self._put("event", (framed,), 0, (key,), rule)

    def _finish(self, item: Item, label: str) -> None:
        """The whole command: what is before and behind is passed over."""
        outer = self._sums[item.first] + self._sums[-1] - self._sums[item.after]
        rule = "command", (label,)
        if self.root is None:
            self.root = Item("command", 0, len(self._pieces), 0)
        weight = outer + self._weight(*rule)
        self.root.edges.append((weight, (item,), rule))
        self.root.inside = _add(self.root.inside, weight + item.inside)


def element_of(concept: Concept) -> str:
    """RCL element of a leaf with a concept: its feature space, also of the sorts that words tell apart there."""
    return ELEMENTS.get(concept.space, concept.space.removeprefix(NAMED))


def _may_follow(kinds: tuple[str, ...], kind: str) -> bool:
    """Whether a component may stand in an event behind others: again is spoken only of what was spoken of before.

    A thing is spoken of again once it is told what to do with it: "the cup, lift it", or in the second of two events.
    """
    if kind == "it":
        return "action" in kinds and "entity" not in kinds[kinds.index("action") :]
    return kind != "entity" or "it" not in kinds


def _place(label: str, behind: Item) -> str:
    """Name of the place before a part of an element, where words may be passed over."""
    return f"{label} {behind.label}"


def _unique(items: Iterable[Item]) -> list[Item]:
    """Items without repetition, in order."""
    return list({id(item): item for item in items}.values())


def _add(one: float, two: float) -> float:
    """Logarithm of the sum of two numbers given by their logarithms."""
    if one < two:
        one, two = two, one
    return one if two == -math.inf else one + math.log1p(math.exp(two - one))
