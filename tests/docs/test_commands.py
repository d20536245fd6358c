"""Every `showtell` command in the papers is one that the command line takes."""

import re
import shlex
from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command

from executor.cli import app
from tests.docs.pages import PAGES, REPOSITORY, Page, commands, exchanges, name_of

PLACEHOLDER = r"[A-Z]+|…|\.\.\."


def parse(words: tuple[str, ...]) -> None:
    """Let the command line read a command, down to the types of its values, without doing it.

    Raises:
        Exception: The usage error that a user would get.
    """
    command: Any = get_command(app)
    context = None
    rest = [word for word in words if word != "--help"]  # help would be printed
    while hasattr(command, "resolve_command"):
        if not rest:
            return
        context = command.make_context(command.name, [rest[0]], parent=context)
        name, command, _ = command.resolve_command(context, rest[:1])
        rest = rest[1:]
    command.make_context(name, rest, parent=context)


def options_of(command: Any) -> set[str]:
    return {name for parameter in command.params for name in (*parameter.opts, *parameter.secondary_opts)}


def check_mention(span: str) -> None:
    """Check a command between backticks, where alternatives and capital letters may stand for what a user gives."""
    command: Any = get_command(app)
    words = span.split()[1:]
    while words and hasattr(command, "commands"):
        if words[0].startswith("-"):
            break
        if re.fullmatch(PLACEHOLDER, words[0]):
            return
        # `evaluate tracking / concepts / actions DEMOS` names several
        names = [words.pop(0)]
        while words[:1] == ["/"]:
            names.append(words[1])
            del words[:2]
        for name in names:
            assert name in command.commands, f"`{span}`: {command.name} has no command '{name}'"
        command = command.commands[names[0]]
    known = options_of(command) | {"--help"}
    for word in words:
        if word.startswith("-") and not re.fullmatch(r"-[\d.]+", word):
            assert word.rstrip(",.") in known, f"`{span}`: no option {word}; there are {', '.join(sorted(known))}"


@pytest.mark.parametrize("path", PAGES, ids=name_of)
def test_commands_are_taken(path: Path) -> None:
    page = Page(path)
    for fence in page.fences:
        found = commands(fence) if fence.language == "bash" else []
        found += [each.words for each in exchanges(fence)] if fence.language == "console" else []
        for words in found:
            where = f"{name_of(path)}, line {fence.line}: {shlex.join(words)}"
            if words[0] == "showtell":
                try:
                    parse(words[1:])
                except Exception as error:
                    pytest.fail(f"{where}: {error}")
            elif words[0] == "make":
                made = (REPOSITORY / "Makefile").read_text(encoding="utf-8")
                assert re.search(rf"^{words[1]}:", made, re.MULTILINE), where


@pytest.mark.parametrize("path", PAGES, ids=name_of)
def test_commands_that_are_spoken_of_exist(path: Path) -> None:
    for span in Page(path).spans:
        if span.startswith("showtell "):
            check_mention(span)


@pytest.mark.parametrize(
    "line", ["do k.json --nonsense", "evaluate nothing", "do k.json --seed many", "record", "do k.json a b"]
)
def test_a_wrong_command_is_found(line: str) -> None:
    """The check itself: what a user could not type is not taken."""
    with pytest.raises(Exception, match=r"(?i)no such|missing|valid integer|unexpected extra"):
        parse(tuple(line.split()))


@pytest.mark.parametrize(
    "span", ["showtell fly", "showtell learn DEMOS --fast", "showtell evaluate concepts / nothing X"]
)
def test_a_wrong_mention_is_found(span: str) -> None:
    with pytest.raises(AssertionError, match="no command|no option"):
        check_mention(span)
