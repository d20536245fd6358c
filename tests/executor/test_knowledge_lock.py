"""Several programs and one knowledge file: nothing is corrupted, nothing is lost."""

import subprocess
import sys
from pathlib import Path

import pytest

from executor.execution.knowledge_lock import changing
from learning import Knowledge
from learning.graphs import ActionGraphlet, GraphletState

ADD = """
import sys
from pathlib import Path
from executor.execution.knowledge_lock import changing
print("ready", flush=True)
for _ in range({times}):
    with changing(Path(sys.argv[1])) as knowledge:
        knowledge.sentences += 1
"""
HOLD = """
import sys, time
from pathlib import Path
from executor.execution.knowledge_lock import changing
with changing(Path(sys.argv[1])) as knowledge:
    knowledge.sentences = 999
    print("ready", flush=True)
    time.sleep(60)
"""


@pytest.fixture(params=["board", "table"])
def known(request: pytest.FixtureRequest, knowledge: Knowledge) -> Knowledge:
    """What was learned on the board, or at a table."""
    if request.param == "board":
        return knowledge
    at_table = Knowledge("table")
    at_table.spaces.actions.match_or_add(ActionGraphlet((GraphletState(False, False, 0), GraphletState(True, True, 0))))
    at_table.sentences = 3
    return at_table


def started(code: str, path: Path) -> "subprocess.Popen[str]":
    return subprocess.Popen([sys.executable, "-c", code, str(path)], stdout=subprocess.PIPE, text=True)


def test_two_programs_that_change_one_file_both_count(known: Knowledge, tmp_path: Path) -> None:
    path = tmp_path / "k.json"
    known.save(path)
    programs = [started(ADD.format(times=5), path) for _ in range(2)]
    for each in programs:
        assert each.wait(timeout=60) == 0
        each.communicate()
    assert Knowledge.load(path).sentences == known.sentences + 10


def test_a_killed_program_loses_nothing_and_blocks_nobody(known: Knowledge, tmp_path: Path) -> None:
    path = tmp_path / "k.json"
    known.save(path)
    before = path.read_bytes()
    program = started(HOLD, path)
    assert program.stdout is not None and program.stdout.readline() == "ready\n"
    program.kill()
    program.communicate()
    assert path.read_bytes() == before
    with changing(path) as again:  # the lock is free
        again.sentences += 1
    assert Knowledge.load(path).sentences == known.sentences + 1
