"""`showtell do` is killed while an arm moves at a table: what is known stays as it was, and nobody is blocked."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from executor.execution.knowledge_lock import changing
from learning import Knowledge
from tests.executor.table_cases import CASES, knowledge_of

TELLING = """
import sys
from executor.cli import app
from executor.tables.table_runner import TableRunner

play = TableRunner._play

def told(self, *given):
    steps = []
    def step():
        steps.append(0)
        if len(steps) == 60:
            print("moving", flush=True)
    self.world.on_step = step
    return play(self, *given)

TableRunner._play = told
app(sys.argv[1:])
"""
"""The command line as it is, which says so when an arm has moved for a quarter of a second."""


@pytest.mark.parametrize("robot", sorted(CASES))
def test_a_command_killed_in_the_middle_of_a_motion_leaves_knowledge_whole(robot: str, tmp_path: Path) -> None:
    known, scene = tmp_path / "known.json", CASES[robot].write(tmp_path)
    shutil.copy(knowledge_of(robot), known)
    before = known.read_bytes()
    told = {"baxter": "pick up the apple", "mico_segway": "hold the blue carton"}[robot]
    program = subprocess.Popen(
        [sys.executable, "-c", TELLING, "do", str(known), told, "--scene", str(scene)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert program.stdout is not None
    said = next((line for line in program.stdout if line == "moving\n"), "")
    program.kill()
    _, complaints = program.communicate()
    assert said, complaints
    assert known.read_bytes() == before
    with changing(known) as again:  # the lock is free
        again.sentences += 1
    assert Knowledge.load(known).sentences == again.sentences
