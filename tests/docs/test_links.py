"""The papers point to what is there: files, headings, pictures, modules, targets of make."""

import importlib
import json
import re
import tomllib
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

from tests.docs.pages import LANGUAGES, PAGES, REPOSITORY, Page, name_of

FLOORS = ("robots", "twin", "teleop", "learning", "executor")
FOLDERS = (*FLOORS, "tests", "docs", "tools")

every_page = pytest.mark.parametrize("path", PAGES, ids=name_of)


@every_page
def test_links_lead_to_files_and_headings(path: Path) -> None:
    for link in Page(path).links:
        parts = urlsplit(link)
        if parts.scheme:
            assert parts.scheme == "https" and parts.netloc, f"{name_of(path)} links to {link}"
            continue
        target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
        assert target.is_file(), f"{name_of(path)} links to {link}, which is not there"
        assert target.is_relative_to(REPOSITORY), f"{name_of(path)} links to {link}, outside of the repository"
        if parts.fragment:
            assert parts.fragment in Page(target).anchors, f"{name_of(path)} links to {link}: no such heading"


@every_page
def test_paths_and_modules_that_are_named_exist(path: Path) -> None:
    for span in Page(path).spans:
        if re.fullmatch(rf"(?:{'|'.join(FOLDERS)})/[\w./-]*", span):
            assert (REPOSITORY / span).exists(), f"{name_of(path)} names {span}, which is not there"
        elif re.fullmatch(rf"(?:{'|'.join(FLOORS)})(?:\.\w+)+", span):
            assert _resolves(span), f"{name_of(path)} names {span}, which is no module or name"
        elif made := re.fullmatch(r"make ([a-z]+)", span):
            assert re.search(rf"^{made[1]}:", (REPOSITORY / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)


@every_page
def test_fences_say_what_they_are_and_data_in_them_parses(path: Path) -> None:
    for fence in Page(path).fences:
        where = f"{name_of(path)}, line {fence.line}"
        assert fence.language in LANGUAGES, f"{where}: say which of {', '.join(LANGUAGES)} this is"
        if fence.language == "json":
            json.loads(fence.text)
        elif fence.language == "toml":
            tomllib.loads(fence.text)


def test_pictures_of_the_docs_are_shown_somewhere() -> None:
    shown = {(path.parent / link).resolve() for path in PAGES for link in Page(path).links if "://" not in link}
    pictures = [each for each in (REPOSITORY / "docs").iterdir() if each.suffix in (".png", ".gif", ".svg")]
    assert [each.name for each in pictures if each not in shown] == []


def _resolves(dotted: str) -> bool:
    """Whether a dotted name is a module, or a name in one."""
    module, *rest = dotted.split(".")
    found: object = importlib.import_module(module)
    for name in rest:
        if not hasattr(found, name):
            try:
                importlib.import_module(f"{module}.{name}")
            except ImportError:
                return False
        found, module = getattr(found, name), f"{module}.{name}"
    return True
