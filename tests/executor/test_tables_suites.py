"""Commands at tables for evaluation: suites are what they say they are, and written ones are read."""

from pathlib import Path

import numpy as np
import pytest

from executor.errors import InputError
from executor.execution.answer import Answer
from executor.execution.evaluation.suite_cases import SUITES
from executor.tables.suite_commands import MAKERS, suite_command
from executor.tables.written_commands import written_commands
from learning.grounding.ngrams import words_of
from twin import World


@pytest.mark.parametrize("robot", list(MAKERS))
@pytest.mark.parametrize("suite", SUITES)
@pytest.mark.parametrize("language", ["en", "ar"])
def test_every_kind_of_a_suite_is_made_and_expects_its_answer(robot: str, suite: str, language: str) -> None:
    named = next(each for each in SUITES if each == suite)
    kinds = MAKERS[robot][named]
    for number, kind in enumerate(kinds):
        rng = np.random.default_rng([3, number])
        command = suite_command(robot, named, number, rng, language, frozenset())
        assert command.action == kind
        assert command.expected is Answer(suite)
        assert command.sentence
        looks = [(each.shape, each.colour) for each in command.scene.objects]
        mine = [each for each in command.scene.objects if each.id == command.target]
        if kind.startswith("two alike"):
            assert looks.count((mine[0].shape, mine[0].colour)) == 2
        elif kind == "two of a shape":
            assert [shape for shape, _ in looks].count(mine[0].shape) == 2
        elif kind in ("not there", "of another colour"):
            assert not mine


def test_a_strange_word_stands_in_a_sentence_that_was_sound() -> None:
    known = frozenset([words_of("pick up the red cube")])
    command = suite_command("baxter", "unknown-word", 0, np.random.default_rng(1), "en", known)
    assert not set(words_of(command.sentence)) <= {word for words in known for word in words}


def test_written_commands_are_judged_by_what_is_written(tmp_path: Path) -> None:
    path = tmp_path / "said.txt"
    path.write_text(
        "# seed, sentence, what should come of it\n"
        "7\tpick up the stapler\n"
        "7\tpick up the glorbin\tunknown-word\n"
        "7\tpick up the stapler\t1\theld\n"
        "7\tmove the apple to the top left corner\t0\ttop left\n"
        "7\tput the apple behind the mug\t0\tbehind 3\n",
        encoding="utf-8",
    )
    free, strange, held, corner, behind = written_commands("baxter", path)
    assert free.judge is None and free.expected is None
    assert strange.expected is Answer.UNKNOWN_WORD
    assert held.target == 1 and corner.target == 0 and behind.target == 0
    with World(held.scene) as world:
        state = world.state()
        for command in (held, corner, behind):  # nothing was done
            assert command.judge is not None and command.judge(world, state)


@pytest.mark.parametrize(
    "line", ["x\tpick it up", "7", "7\ttake it\tdone", "7\ttake it\t0\tin 99", "7\ttake it\t0\tup"]
)
def test_a_line_of_another_form_is_named(line: str, tmp_path: Path) -> None:
    path = tmp_path / "said.txt"
    path.write_text(f"7\tpick up the stapler\n{line}\n", encoding="utf-8")
    with pytest.raises(InputError, match="line 2: .* is not a seed, a sentence"):
        written_commands("baxter", path)
