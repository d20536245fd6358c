"""The digest of the learner's source changes with the source, and with nothing else."""

from pathlib import Path

import pytest

from learning.code_digest import code_digest


def test_it_is_the_same_again_and_another_after_any_change(tmp_path: Path) -> None:
    (tmp_path / "part").mkdir()
    (tmp_path / "one.py").write_text("X = 1\n")
    (tmp_path / "part" / "two.py").write_text("Y = 2\n")
    ask = code_digest.__wrapped__
    first = ask(tmp_path)
    (tmp_path / "notes.txt").write_text("not source")
    assert ask(tmp_path) == first and len(first) == 12 and set(first) <= set("0123456789abcdef")
    seen = {first}
    for change in (("one.py", "X = 2\n"), ("part/two.py", "Y = 3\n"), ("part/three.py", "")):
        (tmp_path / change[0]).write_text(change[1])
        seen.add(ask(tmp_path))
    (tmp_path / "one.py").rename(tmp_path / "four.py")
    seen.add(ask(tmp_path))
    assert len(seen) == 5


@pytest.mark.parametrize("texts", [("AB", ""), ("A", "B")])
def test_files_are_told_apart(tmp_path: Path, texts: tuple[str, str]) -> None:
    for name, text in zip(("a.py", "b.py"), texts, strict=True):
        (tmp_path / name).write_text(text)
    moved = code_digest.__wrapped__(tmp_path)
    (tmp_path / "a.py").write_text("")
    (tmp_path / "b.py").write_text("".join(texts))
    assert code_digest.__wrapped__(tmp_path) != moved
