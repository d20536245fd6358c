"""Words that look like others: how many slips of the keys make one of another (Damerau 1964)."""

from collections.abc import Mapping

SHORTEST = 3
"""Letters of a word that may be misspelt."""
ONE_SLIP = 4
"""Letters that the longer of two words has where one letter may be wrong; in shorter ones two may change places."""
TWO_SLIPS = 8
"""Letters of a word that may be wrong in two places."""


def near_words(word: str, heard: Mapping[str, float]) -> dict[int, list[str]]:
    """Heard words that a word may be a slip for, by the number of slips; none where it is short or no plain word."""
    near: dict[int, list[str]] = {}
    if len(word) < SHORTEST or not word.isalpha():
        return near
    most = 2 if len(word) >= TWO_SLIPS else 1
    for other in heard:
        slips = distance(word, other, most) if _may_be(word, other) else None
        if slips is not None:
            near.setdefault(slips, []).append(other)
    return near


def _may_be(word: str, other: str) -> bool:
    """Whether a word may be a slip for another by its length and letters."""
    if not other.isalpha() or other == word:
        return False
    return max(len(word), len(other)) >= ONE_SLIP or sorted(word) == sorted(other)


def distance(word: str, other: str, most: int) -> int | None:
    """Letters to insert, leave out, replace or swap with a neighbour to make one word of another; None above `most`.

    Each place is touched once (optimal string alignment).
    """
    if abs(len(word) - len(other)) > most:
        return None
    before: list[int] = []
    row = list(range(len(other) + 1))
    for at, letter in enumerate(word, start=1):
        last, row = row, [at]
        for place, wanted in enumerate(other, start=1):
            least = min(last[place] + 1, row[-1] + 1, last[place - 1] + (letter != wanted))
            if at > 1 and place > 1 and (letter, word[at - 2]) == (other[place - 2], wanted):
                least = min(least, before[place - 2] + 1)
            row.append(least)
        if min(row) > most and min(last) > most:
            return None
        before = last
    return row[-1] if row[-1] <= most else None
