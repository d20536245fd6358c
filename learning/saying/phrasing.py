"""How a language is spoken: what meanings are called beside each other, and which words stand between them.

Counted from trees of sentences that were understood. Words that mean nothing by themselves ("the", "that is") are learned
here as what stands at a juncture of a tree; which of two names fits the name before it (gender in Arabic), as which was
heard there. Sparse counts are smoothed by less specific ones (interpolated as by Witten and Bell 1991).
"""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from learning.concept_id import Concept
from learning.grammar.rcl import RclNode
from learning.saved_numbers import saved_count
from learning.saying.juncture import EDGE, Juncture, Path, juncture_of, paths_of

DOUBT = 2.0
"""Sightings that the less specific counts are worth."""
LEAST = 2.0
"""Sightings of a name or of words between below which they are not saved."""
LEAST_SHARE = 0.03
"""Nor are words between that stand there more rarely than this."""
NAMES_TRIED = 6
"""Names of a concept that are tried."""
FILLERS_TRIED = 5
"""Words between that are tried at a juncture."""
NEW_USE = 1e-4
"""How much less likely a name is in a use that it was never heard in, where names depend on the use."""
ESTABLISHED = 3.0
"""Sightings of a use before it tells what is usual in it."""
UNHEARD = 1e-4
"""Probability of what was never heard."""
FIELD = "|"
"""Between the parts of a context when it is written; neither words nor elements hold it."""

Name = str
"""Words of a leaf, joined by spaces; `+` marks where a part is joined to what is beside it."""
Row = dict[str, float]


class Phrasing:
    """Names of meanings and words between them, in one language.

    Attributes:
        names: Concept to names to counts.
        nearby: Concept and the name before it, or its use, to names to counts.
        fillers: Context to words between to counts.
        sentences: Sentences counted.
    """

    def __init__(self) -> None:
        """Start without a word."""
        self.names: defaultdict[Concept, Row] = defaultdict(dict)
        self.nearby: defaultdict[tuple[Concept, Name], Row] = defaultdict(dict)
        self.fillers: defaultdict[str, Row] = defaultdict(dict)
        self.sentences = 0
        self._meant: dict[Name, Row] | None = None
        self._varying: dict[Concept, bool] = {}

    def hear(self, pieces: Sequence[str], tree: RclNode) -> None:
        """Count a sentence that was understood.

        Args:
            pieces: The sentence, in the pieces that the tree's positions count from 1.
            tree: How it was understood.
        """
        self.sentences += 1
        self._forget()
        paths = sorted(paths_of(tree), key=lambda path: path[-1].first)
        before: Path | None = None
        last = 0
        for path in (*paths, None):
            first = len(pieces) + 1 if path is None else path[-1].first
            between = " ".join(pieces[last : first - 1])
            where = juncture_of(before, path)
            for context in contexts(self._side(pieces, before), where, self._side(pieces, path)):
                _count(self.fillers[context], between)
            if path is None:
                break
            leaf = path[-1]
            name = " ".join(pieces[leaf.first - 1 : leaf.last])
            if leaf.concept is not None:
                _count(self.names[leaf.concept], name)
                _count(self.nearby[leaf.concept, use_of(path)], name)
                if before is not None and beside(before, path):
                    _count(self.nearby[leaf.concept, self._side(pieces, before)[1]], name)
            before, last = path, leaf.last

    def _forget(self) -> None:
        """What follows from the counts must be found anew."""
        self._meant = None
        self._varying.clear()

    def _side(self, pieces: Sequence[str], path: Path | None) -> tuple[str, Name]:
        """Element and name of a leaf."""
        if path is None:
            return EDGE, EDGE
        leaf = path[-1]
        return leaf.label, " ".join(pieces[leaf.first - 1 : leaf.last])

    def clarity(self, name: Name, concept: Concept) -> float:
        """P(concept | name)."""
        if self._meant is None:
            self._meant = {}
            for each, row in self.names.items():
                for known, count in row.items():
                    _count(self._meant.setdefault(known, {}), str(each), count)
        row = self._meant.get(name, {})
        total = sum(row.values())
        return row.get(str(concept), 0.0) / total if total else 0.0

    def names_of(self, concept: Concept) -> list[tuple[Name, float]]:
        """The usual and clear names of a concept with P(name | concept), the best first; none if it has no name."""
        row = self.names.get(concept, {})
        total = sum(row.values())
        if not total:
            return []
        rated = [
            (count / total * self.clarity(name, concept) ** 2, name, count / total)
            for name, count in row.items()
            if self.clarity(name, concept) > 0.5
        ]
        rated.sort(key=lambda each: (-each[0], each[1]))
        return [(name, share) for _, name, share in rated[:NAMES_TRIED]]

    def name_probability(self, concept: Concept, name: Name, use: str, before: Name) -> float:
        """P(name | concept, its use, the name beside it in the same part, or `EDGE`).

        Where a concept is called otherwise in other uses ("top" and "forward"), only what was heard in this one is likely.
        """
        row = self.names.get(concept, {})
        total = sum(row.values())
        share = row.get(name, 0.0) / total if total else 0.0
        if name not in self.nearby.get((concept, use), {}) and self._varies(concept):
            share *= NEW_USE
        for near in (use, before):
            row = self.nearby.get((concept, near), {})
            share = (row.get(name, 0.0) + DOUBT * share) / (sum(row.values()) + DOUBT)
        return share

    def _varies(self, concept: Concept) -> bool:
        """Whether the usual name of a concept depends on its use."""
        if concept not in self._varying:
            rows = [row for (each, use), row in self.nearby.items() if each == concept and ":" in use]
            usual = {max(row, key=lambda name: row[name]) for row in rows if sum(row.values()) >= ESTABLISHED}
            self._varying[concept] = len(usual) > 1
        return self._varying[concept]

    def fillers_at(self, left: tuple[str, Name], where: Juncture, right: tuple[str, Name]) -> list[tuple[str, float]]:
        """Words that stand between two names, with their probabilities, the likeliest first.

        Args:
            left: Element and name of the leaf before, `EDGE` twice at the beginning.
            where: Where in the tree.
            right: Element and name of the leaf behind, `EDGE` twice at the end.
        """
        shares: Row = {}
        for context in reversed(contexts(left, where, right)):
            row = self.fillers.get(context, {})
            total = sum(row.values())
            words = {*row, *shares}
            shares = {each: (row.get(each, 0.0) + DOUBT * shares.get(each, 0.0)) / (total + DOUBT) for each in words}
        if not shares:
            return [("", UNHEARD)]
        best = sorted(shares.items(), key=lambda entry: (-entry[1], entry[0]))
        return best[:FILLERS_TRIED]

    def rename(self, old: Concept, new: Concept) -> None:
        """Carry over the names of a concept that turned out to be another."""
        self._forget()
        for name, count in self.names.pop(old, {}).items():
            _count(self.names[new], name, count)
        for concept, before in [key for key in self.nearby if key[0] == old]:
            for name, count in self.nearby.pop((concept, before)).items():
                _count(self.nearby[new, before], name, count)

    def to_json(self) -> dict[str, Any]:
        """Plain numbers and strings; what was heard only once, or seldom where it stands, is left out."""
        names = {concept: _often(row) for concept, row in sorted(self.names.items())}
        nearby = {
            key: _often(row)
            for key, row in sorted(self.nearby.items())
            if len(names.get(key[0], {})) > 1 or ":" in key[1]  # one name alone needs no telling which
        }
        return {
            "sentences": self.sentences,
            "names": {str(concept): row for concept, row in names.items() if row},
            "nearby": {f"{concept}{FIELD}{before}": row for (concept, before), row in nearby.items() if row},
            "between": {context: kept for context, row in sorted(self.fillers.items()) if (kept := _often(row))},
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "Phrasing":
        """Rebuild; raises KeyError, TypeError, ValueError or AttributeError for what `to_json` did not write."""
        phrasing = cls()
        phrasing.sentences = int(saved_count(data["sentences"], "number of sentences said"))
        for text, row in data["names"].items():
            phrasing.names[Concept.parse(text)] = _row(row, text)
        for text, row in data["nearby"].items():
            concept, _, before = text.partition(FIELD)
            phrasing.nearby[Concept.parse(concept), before] = _row(row, text)
        for context, row in data["between"].items():
            phrasing.fillers[str(context)] = _row(row, context)
        return phrasing

    def concepts(self) -> Iterable[Concept]:
        """All concepts that have a name."""
        return {*self.names, *(concept for concept, _ in self.nearby)}


def contexts(left: tuple[str, Name], where: Juncture, right: tuple[str, Name]) -> tuple[str, ...]:
    """Keys of the counts of words between, the most specific first."""
    place = place_of(where)
    return (
        FIELD.join((left[1], place, right[0], "name")),
        FIELD.join((left[0], place, right[1], "named")),
        FIELD.join((left[0], place, right[0])),
        place,
    )


def beside(left: Path, right: Path) -> bool:
    """Whether two leaves are of one part, so that one may have to agree with the other."""
    return len(left) > 1 and len(right) > 1 and left[-2] is right[-2]


def use_of(path: Path) -> str:
    """What a leaf is used for: the rule that it is part of."""
    if len(path) < 2:
        return EDGE
    return f"{path[-2].label}:{'+'.join(child.label for child in path[-2].children)}"


def place_of(where: Juncture) -> str:
    """A juncture as a key."""
    return f"{where.within}:{where.left}:{where.right}"


def _count(row: Row, key: str, amount: float = 1.0) -> None:
    row[key] = row.get(key, 0.0) + amount


def _often(row: Mapping[str, float]) -> dict[str, int]:
    total = sum(row.values())
    return {key: int(n) for key, n in sorted(row.items()) if n >= LEAST and n >= LEAST_SHARE * total}


def _row(data: Mapping[str, Any], what: str) -> Row:
    return {str(key): saved_count(count, f"count of '{key}' at {what}") for key, count in data.items()}
