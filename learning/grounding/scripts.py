"""Which script a sentence is written in: all that tells languages apart here, and it can be seen."""

import unicodedata
from collections import Counter


def script_of(words: tuple[str, ...]) -> str:
    """Name of the script of most letters of some words, such as `LATIN`; `NONE` where there are no letters.

    Unicode names each letter by its script first. Two languages in one script are learned as one.
    """
    names = (unicodedata.name(letter, "NONE").split(" ")[0] for word in words for letter in word if letter.isalpha())
    return max(Counter(names).items(), key=lambda entry: (entry[1], entry[0]), default=("NONE", 0))[0]
