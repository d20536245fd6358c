"""What libraries print from C does not reach stdout, which is for results."""

import os

import pytest

from executor.quiet import words_to_stderr


def test_words_go_to_stderr_meanwhile_also_from_c(capfd: pytest.CaptureFixture[str]) -> None:
    print("before")
    with words_to_stderr():
        print("python")
        os.write(1, b"from C\n")
    print("after")
    said = capfd.readouterr()
    assert said.out == "before\nafter\n"
    assert "from C\n" in said.err and "python\n" in said.err
