"""K of a table's language as it is saved: only what its words go with, and how often anything of a space was there.

K is a table of counts that is nearly all chance: of each n-gram some pairs go together, and for each feature space it
counts how often anything of it was salient. The latter stand in one list, in the order of the spaces, which takes a
fifth of the room that names would.
"""

from collections.abc import Callable, Mapping
from typing import Any

from learning.concept_id import Concept

Entry = list[Any]


def packed(matrix: Mapping[str, Any], before: str, kept: Callable[[str, Concept], bool]) -> dict[str, Any]:
    """What `CorrelationMatrix.to_json` gives, in less room; `unpacked` gives back all that was kept.

    Args:
        matrix: Sentences, concepts and n-grams.
        before: What the names of pseudo-concepts begin with that stand for anything of a space.
        kept: Whether the pair of an n-gram and a concept is saved.
    """
    spaces = [text for text in matrix["concepts"] if text.startswith(before)]
    ngrams: dict[str, Entry] = {}
    for ngram, (count, first, frozen, row) in matrix["ngrams"].items():
        pairs = {text: n for text, n in row.items() if text not in spaces and kept(ngram, Concept.parse(text))}
        entry: Entry = [count, first, [row.get(text, 0) for text in spaces], pairs]
        ngrams[ngram] = entry if frozen is None else [*entry, frozen]
    return {"sentences": matrix["sentences"], "concepts": matrix["concepts"], "spaces": spaces, "ngrams": ngrams}


def unpacked(data: Mapping[str, Any]) -> dict[str, Any]:
    """What `CorrelationMatrix.from_json` reads.

    Raises:
        KeyError, TypeError, ValueError: `packed` did not write it.
    """
    if "spaces" not in data:
        return dict(data)  # older files hold it as it is
    ngrams = {}
    for ngram, (count, first, anything, pairs, *frozen) in data["ngrams"].items():
        row = {text: n for text, n in zip(data["spaces"], anything, strict=True) if n}
        ngrams[ngram] = [count, first, frozen[0] if frozen else None, {**row, **pairs}]
    return {"sentences": data["sentences"], "concepts": data["concepts"], "ngrams": ngrams}
