"""What the papers show is what happens: sessions in a terminal and Python snippets are run, their output compared."""

import doctest
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from executor.cli import app
from tests.docs.pages import PAGES, REPOSITORY, Exchange, Fence, Page, exchanges, name_of

ELSEWHERE = {"docs/own-robot.md"}
"""Pages whose snippets another test runs, with the files that they need (tests/test_own_robot.py)."""
FENCES = {page: Page(page).fences for page in PAGES}
SESSIONS = [page for page, fences in FENCES.items() if any(each.language == "console" for each in fences)]
SNIPPETS = [
    page
    for page, fences in FENCES.items()
    if any(each.language == "python" for each in fences) and page not in SESSIONS and name_of(page) not in ELSEWHERE
]
MARK = "--- next snippet ---"


def check_output(expected: str, got: str, where: str) -> None:
    """Compare line by line; `…` stands for anything, and how often spaces come does not matter."""
    flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    want = expected.replace("…", "...")
    if not doctest.OutputChecker().check_output(want, got, flags):
        pytest.fail(f"{where}: the page shows\n{expected}\nbut it is\n{got}")


def check_exchange(exchange: Exchange, where: str) -> None:
    """Run a command of ours and compare what it says on stdout; other commands are the reader's own."""
    if exchange.words[0] != "showtell":
        return
    result = CliRunner().invoke(app, exchange.words[1:], input=exchange.typed)
    assert result.exit_code in (0, 1), f"{where}: {result.stderr or result.exception!r}"
    if exchange.said:
        check_output(exchange.said, result.stdout, f"{where}, {' '.join(exchange.words)}")


def run_snippets(fences: list[Fence], where: str) -> None:
    """Run the `python` blocks of a page in one fresh interpreter; a `text` block after one is what it prints."""
    snippets = [number for number, fence in enumerate(fences) if fence.language == "python"]
    script = f"\nprint({MARK!r})\n".join(fences[number].text for number in snippets)
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, f"{where}: {done.stderr}"
    for number, printed in zip(snippets, done.stdout.split(f"{MARK}\n"), strict=True):
        after = fences[number + 1] if number + 1 < len(fences) else None
        if after is not None and after.language == "text":
            check_output(after.text, printed, f"{where}, line {after.line}")


@pytest.mark.parametrize("page", SESSIONS, ids=name_of)
def test_sessions_go_as_they_are_shown(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(REPOSITORY))
    for fence in FENCES[page]:
        if fence.language == "console":
            for exchange in exchanges(fence):
                check_exchange(exchange, f"{name_of(page)}, line {fence.line}")
    if any(fence.language == "python" for fence in FENCES[page]):
        run_snippets(FENCES[page], name_of(page))


@pytest.fixture(scope="module")
def demos(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Some demos, called as the pages call theirs."""
    folder = tmp_path_factory.mktemp("recorded") / "demos"
    made = CliRunner().invoke(app, ["record", "-n", "3", "-o", str(folder), "--jobs", "1"])
    assert made.exit_code == 0, made.stderr
    for file, name in zip(sorted(folder.glob("*.mcap")), ("demo_0001.mcap", "page_0001.mcap"), strict=False):
        file.rename(folder / name)
    return folder


@pytest.mark.parametrize("page", SNIPPETS, ids=name_of)
def test_snippets_run(page: Path, demos: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shutil.copytree(demos, tmp_path / "demos")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(REPOSITORY))
    run_snippets(FENCES[page], name_of(page))
