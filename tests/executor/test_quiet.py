"""What libraries print from C does not reach stdout, which is for results."""

import subprocess
import sys

CODE = """
import os
from executor.quiet import words_to_stderr
print("before")
with words_to_stderr():
    print("python")
    os.write(1, b"from C\\n")
print("after")
"""


def test_words_go_to_stderr_meanwhile_also_from_c() -> None:
    done = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, check=True)
    assert done.stdout == "before\nafter\n"
    assert "from C\n" in done.stderr and "python\n" in done.stderr
