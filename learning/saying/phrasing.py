"""How a language is spoken: what meanings are called beside each other, and which words stand between them.

Counted from trees of sentences that were understood. Words that mean nothing by themselves ("the", "that is") are
learned here as what stands at a juncture of a tree; which of two names fits the name before it (gender in Arabic), as
which was heard there. Sparse counts are smoothed by less specific ones (interpolated as by Witten and Bell 1991).
"""

import math
from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

from learning.concept_id import Concept
from learning.grammar.rcl import RclNode
from learning.grammar.table_chart import element_of
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
MAINLY = 0.6
"""Share of a word's readings that must be of a concept, for Φ to give it as a name."""
NEW_JUNCTURE = 0.01
"""How much less likely are two leaves beside each other that never met so."""
NEW_WORDS = 0.01
"""How likely words are that never stood at a juncture, though they do beside one of the names elsewhere."""
NEW_ENDING = 0.3
"""What an ending counts that was never heard beside a name."""
ESTABLISHED = 3.0
"""Sightings of a use before it tells what is usual in it."""
UNHEARD = 1e-4
"""Probability of what was never heard."""
FIELD = "|"
"""Between the parts of a context when it is written; neither words nor elements hold it."""

AFTER, BEFORE, ANYWHERE = "after", "before", "anywhere"
"""Last part of a context that tells the name before, the name behind, or that alone."""
SEVERAL = "s"
"""Marks an element of which a part has several."""
JOIN = "+"
"""Marks a part of a word on the side where it is joined to what is beside it."""
JOIN = "+"
"""Marks a part of a word on the side where it is joined to what is beside it."""
TELLING = 0.2
"""Counts that give no words a share so different from what is usual tell nothing."""

Name = str
"""Words of a leaf, joined by spaces; `+` marks where a part is joined to what is beside it."""
Row = dict[str, float]


class Phrasing:
    """Names of meanings and words between them, in one language.

    Attributes:
        names: Concept to names to counts.
        nearby: Concept and the name before it, or its use, to names to counts.
        endings: Element and the name beside it, to last letters of names to counts: what has to agree often shows at
            the end.
        fillers: Context to words between to counts.
        sentences: Sentences counted.
    """

    def __init__(self) -> None:
        """Start without a word."""
        self.names: defaultdict[Concept, Row] = defaultdict(dict)
        self.nearby: defaultdict[tuple[Concept, Name], Row] = defaultdict(dict)
        self.endings: defaultdict[tuple[str, Name], Row] = defaultdict(dict)
        self.fillers: defaultdict[str, Row] = defaultdict(dict)
        self.sentences = 0
        self._meant: dict[Name, Row] | None = None
        self._varying: dict[Concept, bool] = {}
        self._agreeing: dict[tuple[str, Name], Row] = {}

    def hear(self, pieces: Sequence[str], tree: RclNode) -> None:
        """Count a sentence that was understood.

        Args:
            pieces: The sentence, in the pieces that the tree's positions count from 1.
            tree: How it was understood.
        """
        self.sentences += 1
        self._forget()
        before: Path | None = None
        spoken: tuple[str, Name] = EDGE, EDGE
        last = 0
        paths = sorted(paths_of(tree), key=lambda path: path[-1].first)
        starts = {path[-1].first - 1 for path in paths}
        for path in (*paths, None):
            first = len(pieces) + 1 if path is None else path[-1].first
            end = last if path is None else _end(pieces, starts, path[-1].last)
            name = EDGE if path is None else " ".join(pieces[first - 1 : end])
            here = EDGE if path is None else element(path), name
            between = " ".join(pieces[last : first - 1])
            where = juncture_of(before, path)
            for context in contexts(spoken, where, here):
                _count(self.fillers[context], between)
            if begins_part(where, here[0]):
                _count(self.fillers[anywhere(name, where)], between)
            concept = None if path is None else path[-1].concept
            if path is not None and concept is not None:
                _count(self.names[concept], name)
                _count(self.nearby[concept, use_of(path)], name)
                if before is not None and beside(before, path):
                    _count(self.nearby[concept, spoken[1]], name)
                    _count(self.endings[here[0], spoken[1]], name[-1])
            before, spoken, last = path, here, end

    def learn_names(self, counts: Mapping[Name, Mapping[Concept | None, float]]) -> None:
        """Take names from Φ for concepts that nothing was called by in the sentences that were heard here.

        Args:
            counts: Word to concept, or None, to how often it was read so.
        """
        found: dict[Concept, Row] = {}
        for word, row in counts.items():
            total = sum(row.values())
            for concept, count in row.items():
                if concept is not None and count >= ESTABLISHED and count > MAINLY * total:
                    found.setdefault(concept, {})[word] = count
        for concept, names in found.items():
            if sum(self.names.get(concept, {}).values()) < LEAST:
                self.names[concept] = names
        self._forget()

    def _forget(self) -> None:
        """What follows from the counts must be found anew."""
        self._meant = None
        self._varying.clear()
        self._agreeing.clear()

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

    def names_beside(self, concept: Concept, label: str, use: str, before: Name) -> dict[Name, float]:
        """P(name | concept, its use, the name beside it in the same part, or `EDGE`).

        Where a concept is called otherwise in other uses ("top", "forward"), only what was heard in this one is likely.
        """
        row = self.names.get(concept, {})
        total = sum(row.values())
        shares = {name: count / total for name, count in row.items()}
        if self._varies(concept):
            heard = self._heard_in(concept, use)
            shares = {name: share if name in heard else share * NEW_USE for name, share in shares.items()}
        shares = _smoothed(self.nearby.get((concept, use), {}), shares)
        ends = self._agrees(label, before)
        if ends:
            fit = {name: share * (ends.get(name[-1], 0.0) + NEW_ENDING) for name, share in shares.items()}
            whole = sum(fit.values())
            shares = {name: share / whole for name, share in fit.items()}
        return _smoothed(self.nearby.get((concept, before), {}), shares)

    def _heard_in(self, concept: Concept, use: str) -> Row:
        """Names of a concept in a use, or in others within the same element where it was never heard in that."""
        if (concept, use) in self.nearby:
            return self.nearby[concept, use]
        found: Row = {}
        for (each, other), row in self.nearby.items():
            if each == concept and other.startswith(f"{use.partition(':')[0]}:"):
                for name, count in row.items():
                    _count(found, name, count)
        return found

    def _agrees(self, label: str, before: Name) -> Row:
        """Endings that names have beside a name, and beside names that have others like it: they are of one gender."""
        key = label, before
        if key not in self._agreeing:
            own = self.endings.get(key, {})
            found: Row = {}
            for (other, _), row in self.endings.items() if own else ():
                likeness = _likeness(own, row) if other == label else 0.0
                for ending, count in row.items() if likeness else ():
                    _count(found, ending, likeness * count)
            self._agreeing[key] = found
        return self._agreeing[key]

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
        place, between, after, after_before, before = contexts(left, where, right)
        if between not in self.fillers:
            # Such leaves never met so: what stands before the name elsewhere is all there is to go by.
            usual = _smoothed(self.fillers.get(anywhere(right[1], where), {}), {})
            return [(words, NEW_JUNCTURE * share) for words, share in _best(usual)] or [("", NEW_JUNCTURE)]
        usual = _smoothed(self.fillers[between], _smoothed(self.fillers.get(place, {}), {}))
        # The name before and the name behind each have their say, as if they had it independently of each other.
        one = _smoothed(self.fillers.get(after_before, {}), _smoothed(self.fillers.get(after, {}), usual))
        # Where a name begins a part, what stands before it elsewhere does so here; inside a part that tells nothing.
        elsewhere = self.fillers.get(anywhere(right[1], where), {}) if begins_part(where, right[0]) else {}
        known = _smoothed(elsewhere, usual)
        two = _smoothed(self.fillers.get(before, {}), known)
        shares = {
            words: one.get(words, NEW_WORDS) * two.get(words, NEW_WORDS) / usual.get(words, NEW_WORDS)
            for words in {**one, **two}
        }
        whole = sum(shares.values())
        return [(words, share / whole) for words, share in _best(shares)] if whole else [("", UNHEARD)]

    def between(self) -> Row:
        """All words that stood between names, with how often, wherever that was."""
        found: Row = {}
        for context, row in self.fillers.items():
            if FIELD not in context:  # of the juncture alone; the others count the same words again
                for words, count in row.items():
                    _count(found, words, count)
        return found

    def rename(self, old: Concept, new: Concept) -> None:
        """Carry over the names of a concept that turned out to be another."""
        self._forget()
        for name, count in self.names.pop(old, {}).items():
            _count(self.names[new], name, count)
        for concept, before in [key for key in self.nearby if key[0] == old]:
            for name, count in self.nearby.pop((concept, before)).items():
                _count(self.nearby[new, before], name, count)

    def to_json(self) -> dict[str, Any]:
        """Plain numbers and strings; what was heard once, or tells no more than what is kept anyway, is left out."""
        names = {concept: kept for concept, row in sorted(self.names.items()) if (kept := _often(row))}
        several = {element_of(concept) for concept, row in names.items() if len(row) > 1}
        several |= {f"{label}{SEVERAL}" for label in several}
        nearby = {
            key: kept
            for key, row in sorted(self.nearby.items())
            if len(names.get(key[0], {})) > 1
            and (self._varies(key[0]) if ":" in key[1] else self._disagrees(key, row))
            and (kept := _often(row))
        }
        endings = {
            key: kept for key, row in sorted(self.endings.items()) if key[0] in several and (kept := _often(row))
        }
        labels: dict[Name, set[str]] = {}
        for concept, row in self.names.items():
            for name in row:
                labels.setdefault(name, set()).update((element_of(concept), f"{element_of(concept)}{SEVERAL}"))
        between = {key: self._telling(key, row, labels) for key, row in sorted(self.fillers.items())}
        return {
            "sentences": self.sentences,
            "names": {str(concept): row for concept, row in names.items()},
            "nearby": {f"{concept}{FIELD}{before}": row for (concept, before), row in nearby.items()},
            "endings": {FIELD.join(key): row for key, row in endings.items() if row},
            "between": {key: row for key, row in between.items() if row},
        }

    def _disagrees(self, key: tuple[Concept, Name], row: Row) -> bool:
        """Whether a name beside another is not the one that endings would have there."""
        concept, before = key
        ends = self._agrees(element_of(concept), before)
        fit = {name: count * (ends.get(name[-1], 0.0) + NEW_ENDING) for name, count in self.names[concept].items()}
        return _tells(row, fit)

    def _telling(self, key: str, row: Row, labels: Mapping[Name, set[str]]) -> dict[str, int]:
        """What of the words between two leaves is saved: nothing where less specific counts tell the same."""
        parts = key.split(FIELD)
        if parts[-1] == ANYWHERE:
            return _often(row) if max(row, key=lambda words: row[words]) else {}
        if parts[-1] == BEFORE:
            less = [FIELD.join((*parts[:2], label)) for label in labels.get(parts[2], (EDGE,))]
        elif parts[-1] == AFTER and len(parts) == 4:
            less = [FIELD.join((parts[0], parts[1], AFTER))]
        elif parts[-1] == AFTER:
            begins = tuple(f"{label}{FIELD}{parts[1]}{FIELD}" for label in labels.get(parts[0], (EDGE,)))
            less = [each for each in self.fillers if each.startswith(begins) and each.count(FIELD) == 2]
        else:
            return _often(row)
        return _often(row) if any(_tells(row, self.fillers.get(each, {})) for each in less) else {}

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
        for text, row in data["endings"].items():
            label, _, before = text.partition(FIELD)
            phrasing.endings[label, before] = _row(row, text)
        for context, row in data["between"].items():
            phrasing.fillers[str(context)] = _row(row, context)
        return phrasing

    def concepts(self) -> Iterable[Concept]:
        """All concepts that have a name."""
        return {*self.names, *(concept for concept, _ in self.nearby)}


def contexts(left: tuple[str, Name], where: Juncture, right: tuple[str, Name]) -> tuple[str, str, str, str, str]:
    """Keys of the counts of words between two leaves.

    Returns:
        The juncture; with the elements of both; with the name before; with that and the element behind; with the
        element before and the name behind.
    """
    place = place_of(where)
    return (
        place,
        FIELD.join((left[0], place, right[0])),
        FIELD.join((left[1], place, AFTER)),
        FIELD.join((left[1], place, right[0], AFTER)),
        FIELD.join((left[0], place, right[1], BEFORE)),
    )


def element(path: Path) -> str:
    """Element of a leaf; marked where its part has several such: a corner is told by two places, a side by one."""
    label = path[-1].label
    several = len(path) > 1 and sum(child.label == label for child in path[-2].children) > 1
    return f"{label}{SEVERAL}" if several else label


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


def anywhere(name: Name, where: Juncture) -> str:
    """Key of the counts of words before a name that begins such a part, whatever is before."""
    part = "spatial-relation" if where.right == "destination" else where.right
    return FIELD.join((name, part, ANYWHERE))


def begins_part(where: Juncture, label: str) -> bool:
    """Whether a leaf with this element begins a part of the tree at a juncture, and is not just one more in it."""
    return where.right != label.removesuffix(SEVERAL)


def _end(pieces: Sequence[str], starts: Collection[int], end: int) -> int:
    """Position after a leaf with the endings that are joined to it and mean nothing by themselves."""
    while end < len(pieces) and pieces[end].startswith(JOIN) and end not in starts:
        end += 1
    return end


def _best(shares: Row) -> list[tuple[str, float]]:
    """What is likeliest, the best first."""
    return sorted(shares.items(), key=lambda entry: (-entry[1], entry[0]))[:FILLERS_TRIED]


def _likeness(one: Row, other: Row) -> float:
    """Cosine of the angle between two rows of counts."""
    shared = sum(count * other.get(key, 0.0) for key, count in one.items())
    return shared / math.sqrt(sum(n * n for n in one.values()) * sum(n * n for n in other.values())) if shared else 0.0


def _smoothed(row: Row, usual: Row) -> Row:
    """Shares of what was counted, with `usual` as what is expected without."""
    total = sum(row.values()) + DOUBT
    return {key: (row.get(key, 0.0) + DOUBT * usual.get(key, 0.0)) / total for key in {**usual, **row}}


def _count(row: Row, key: str, amount: float = 1.0) -> None:
    row[key] = row.get(key, 0.0) + amount


def _tells(row: Row, usual: Row) -> bool:
    """Whether counts, if they are many enough, have something else as the likeliest than what is usual."""
    if sum(row.values()) < ESTABLISHED:
        return False
    return not usual or max(row, key=lambda key: row[key]) != max(usual, key=lambda key: usual[key])


def _often(row: Mapping[str, float]) -> dict[str, int]:
    total = sum(row.values())
    return {key: int(n) for key, n in sorted(row.items()) if n >= LEAST and n >= LEAST_SHARE * total}


def _row(data: Mapping[str, Any], what: str) -> Row:
    return {str(key): saved_count(count, f"count of '{key}' at {what}") for key, count in data.items()}
