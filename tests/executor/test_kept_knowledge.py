"""What was learned once is kept, and only for the learner that learned it."""

from pathlib import Path

import pytest

from executor.execution.evaluation import learned
from executor.execution.evaluation.learned import Kept
from learning import Knowledge


def test_another_learner_learns_anew_and_replaces_what_an_earlier_one_left(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = Kept.of(tmp_path, "board_6_0")
    assert not kept.complete
    kept.write(Knowledge(), ["take the cube", "put it down", "take the cube"])
    assert kept.complete and Kept.of(tmp_path, "board_6_0") == kept
    assert kept.read().heard == {("take", "the", "cube"), ("put", "it", "down")}
    assert Knowledge.load(kept.read().path).demos == 0
    other = Kept.of(tmp_path, "board_60_0")
    other.write(Knowledge(), ["lift it"])

    monkeypatch.setattr(learned, "code_digest", lambda: "of a new one")
    renewed = Kept.of(tmp_path, "board_6_0")
    assert not renewed.complete  # what an earlier learner made is not taken for its own
    renewed.write(Knowledge(), ["drop it"])
    assert renewed.read().heard == {("drop", "it")}
    assert not kept.knowledge.exists() and not kept.sentences.exists()
    assert other.complete  # another collection's is left alone


def test_knowledge_without_its_sentences_is_not_complete(tmp_path: Path) -> None:
    kept = Kept.of(tmp_path, "board_6_0")
    kept.write(Knowledge(), ["take the cube"])
    kept.sentences.unlink()
    assert not kept.complete
