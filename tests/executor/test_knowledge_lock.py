"""Several programs and one knowledge file: nothing is corrupted, nothing is lost."""

import subprocess
import sys
from pathlib import Path

from executor.execution.knowledge_lock import changing
from learning import Knowledge

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


def started(code: str, path: Path) -> "subprocess.Popen[str]":
    return subprocess.Popen([sys.executable, "-c", code, str(path)], stdout=subprocess.PIPE, text=True)


def test_two_programs_that_change_one_file_both_count(knowledge: Knowledge, tmp_path: Path) -> None:
    path = tmp_path / "k.json"
    knowledge.save(path)
    programs = [started(ADD.format(times=5), path) for _ in range(2)]
    for each in programs:
        assert each.wait(timeout=60) == 0
        each.communicate()
    assert Knowledge.load(path).sentences == knowledge.sentences + 10


def test_a_killed_program_loses_nothing_and_blocks_nobody(knowledge: Knowledge, tmp_path: Path) -> None:
    path = tmp_path / "k.json"
    knowledge.save(path)
    before = path.read_bytes()
    program = started(HOLD, path)
    assert program.stdout is not None and program.stdout.readline() == "ready\n"
    program.kill()
    program.communicate()
    assert path.read_bytes() == before
    with changing(path) as again:  # the lock is free
        again.sentences += 1
    assert Knowledge.load(path).sentences == knowledge.sentences + 1
