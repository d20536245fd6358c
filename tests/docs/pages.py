"""The papers of the repository, taken apart: links, anchors, code spans and fences."""

import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from markdown_it import MarkdownIt
from markdown_it.token import Token

REPOSITORY = Path(__file__).resolve().parents[2]
PAGES = [
    *(REPOSITORY / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")),
    *sorted((REPOSITORY / "docs").glob("*.md")),
]
LANGUAGES = {
    "bash": "commands to copy: parsed",
    "console": "a session in a terminal: run, and its output compared",
    "json": "parsed",
    "python": "run",
    "text": "drawings and lists, or after `python` what that prints: compared",
    "toml": "parsed",
}
"""Languages of fences, and what the tests do with each."""


def name_of(page: Path) -> str:
    """A page's path from the repository."""
    return page.relative_to(REPOSITORY).as_posix()


@dataclass(frozen=True, slots=True)
class Fence:
    """A block of code: its language, text, and line in the page."""

    language: str
    text: str
    line: int


class Page:
    """A page of Markdown as GitHub reads it."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.text = path.read_text(encoding="utf-8")
        self._tokens = MarkdownIt("commonmark").enable("table").parse(self.text)

    @cached_property
    def links(self) -> list[str]:
        """Where its links and pictures point."""
        where = {"link_open": "href", "image": "src"}
        return [str(token.attrs[where[token.type]]) for token in self._inline() if token.type in where]

    @cached_property
    def spans(self) -> list[str]:
        """What stands between single backticks."""
        return [token.content for token in self._inline() if token.type == "code_inline"]

    @cached_property
    def fences(self) -> list[Fence]:
        """Its blocks of code."""
        return [
            Fence(token.info.strip(), token.content, (token.map or [0])[0] + 1)
            for token in self._tokens
            if token.type in ("fence", "code_block")
        ]

    @cached_property
    def anchors(self) -> set[str]:
        """The anchors that GitHub gives its headings."""
        given: set[str] = set()
        for token, after in zip(self._tokens, self._tokens[1:], strict=False):
            if token.type == "heading_open":
                title = "".join(child.content for child in after.children or ())
                slug = re.sub(r"[^\w\- ]", "", title.strip().lower()).replace(" ", "-")
                number = 0
                while (anchor := f"{slug}-{number}" if number else slug) in given:
                    number += 1
                given.add(anchor)
        return given

    def _inline(self) -> Iterator[Token]:
        for token in self._tokens:
            yield from token.children or ()


@dataclass(frozen=True, slots=True)
class Exchange:
    """One command of a session: its words, what was typed at it, and what it said."""

    words: tuple[str, ...]
    typed: str
    said: str


def commands(fence: Fence) -> list[tuple[str, ...]]:
    """The commands of a `bash` block, one a line (`\\` goes on), without comments."""
    lines = fence.text.replace("\\\n", " ").splitlines()
    return [tuple(words) for line in lines if (words := shlex.split(line, comments=True))]


def exchanges(fence: Fence) -> list[Exchange]:
    """The commands of a `console` block: `$ ` stands before a command, `> ` before a line that is typed at it."""
    found: list[Exchange] = []
    for part in re.split(r"^\$ ", fence.text, flags=re.MULTILINE)[1:]:
        command, _, rest = part.partition("\n")
        lines = rest.splitlines(keepends=True)
        typed = "".join(line.removeprefix("> ") for line in lines if line.startswith("> "))
        said = "".join(line for line in lines if not line.startswith("> "))
        found.append(Exchange(tuple(shlex.split(command, comments=True)), typed, said))
    return found
