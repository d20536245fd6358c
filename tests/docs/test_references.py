"""The bibliography and the code name the same works."""

import re
from functools import cache

from tests.docs.pages import PAGES, REPOSITORY

FLOORS = ("robots", "twin", "teleop", "learning", "executor", "tests")
NAME = r"[A-Z][a-zà-ü]+(?:[A-Z][a-z]+)?"
YEAR = re.compile(r"\b(?:19|20)\d\d\b(?!-)")
BEFORE = re.compile(rf"\b({NAME})(?:(?:, {NAME})*,? (?:and|&) {NAME}| et al\.)?,? \(?$")
"""What stands before the year of a citation."""
ENTRY = re.compile(r"^- \*\*(.+?)\*\*:", re.MULTILINE)


def entries() -> list[str]:
    return ENTRY.findall((REPOSITORY / "docs" / "references.md").read_text(encoding="utf-8"))


@cache
def sources() -> dict[str, str]:
    """The code by its path, with lines of prose joined."""
    files = [file for floor in FLOORS for file in (REPOSITORY / floor).rglob("*.py") if "docs" not in file.parts]
    return {
        file.relative_to(REPOSITORY).as_posix(): " ".join(
            line.strip().removeprefix("# ") for line in file.read_text(encoding="utf-8").splitlines()
        )
        for file in files
    }


def test_what_the_code_cites_is_in_the_bibliography() -> None:
    known = {(name, year) for each in entries() for year in YEAR.findall(each) for name in re.findall(NAME, each)}
    missing, found = set(), set()
    for path, text in sources().items():
        for year in YEAR.finditer(text):
            author = BEFORE.search(text[max(0, year.start() - 80) : year.start()])
            if author is not None:
                found.add((author[1], year[0]))
                if (author[1], year[0]) not in known:
                    missing.add(f"{path}: {author[0]}{year[0]}")
    assert not missing
    assert len(found) > 20, "citations are no longer recognised"


def test_what_the_bibliography_lists_is_named_somewhere() -> None:
    pages = [page.read_text(encoding="utf-8") for page in PAGES if page.name != "references.md"]
    text = " ".join([*sources().values(), *pages])
    first = [re.split(r"[ ,]", entry)[0] for entry in entries()]
    assert [name for name in first if name not in text] == []


def test_the_bibliography_is_in_order() -> None:
    names = entries()
    assert names[0] == "Alomari", "the work that this one follows comes first"
    assert names[1:] == sorted(names[1:], key=str.lower)
