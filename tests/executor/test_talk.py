"""What is said on the page and what is told there, without a browser."""

import os
import shutil
import signal
import time
from pathlib import Path

import numpy as np
import pytest

from executor import Executor
from executor.errors import InputError
from executor.execution.answer import Answer
from executor.knowledge_fit import check_fit
from executor.lexicon import entry_of, lexicon
from executor.talk.marks import marks_of
from executor.talk.plan_words import line_of, plan_lines
from executor.talk.said_words import words_of_report
from executor.talk.serving import talk_files
from executor.talk.student import Student, learn_demo
from executor.talk.told_knowledge import told_knowledge
from executor.word_kinds import WordKind, kind_of
from learning import Knowledge
from learning.concept_id import Concept
from learning.grammar.innate import COLLECTIVE, NEAREST_ONE, SIDES
from teleop import ScriptedOperator, Task, record_demo
from teleop.server_files import page_files
from tests.executor.page_visit import board_scene
from twin import World
from twin.board import cell_centre

SENTENCE = "put the red cube on the blue cube, then take the white prism"


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    return board_scene(tmp_path, ((2, 2, 0), "red", "cube"), ((5, 3, 0), "blue", "cube"), ((4, 6, 0), "white", "prism"))


@pytest.fixture
def demo(scene: Path, tmp_path: Path) -> Path:
    return shown(scene, tmp_path / "shown.mcap", seed=1)


def shown(scene: Path, path: Path, seed: int) -> Path:
    """Record how the red cube is put on the blue one; each seed drives in its own manner."""
    with World.from_scene(scene) as world:
        operator = ScriptedOperator(Task(0, cell_centre(5, 3, 1)), np.random.default_rng(seed))
        record_demo(world, operator, path, utterances=("put the red cube on the blue cube",), truth={"moved": 0})
    return path


@pytest.mark.parametrize(
    ("concept", "kind"),
    [
        (None, WordKind.FUNCTION),
        (Concept("action", 1), WordKind.ACTION),
        (Concept("named shape", 4), WordKind.SHAPE),
        (COLLECTIVE, WordKind.SHAPE),
        (Concept("weight", 0), WordKind.SIZE),
        (NEAREST_ONE, WordKind.WHICH),
        (SIDES[0], WordKind.PLACE),
        (Concept("direction", 2), WordKind.PLACE),
        (Concept("reference", 1), WordKind.IT),
    ],
)
def test_a_meaning_has_a_kind(concept: Concept | None, kind: WordKind) -> None:
    assert kind_of(concept) is kind


def test_each_word_of_several_steps_is_told_by_its_own_reading(scene: Path, knowledge: Knowledge) -> None:
    with World.from_scene(scene) as world:
        report = Executor(world, knowledge).preview(SENTENCE)
        assert world.time == 0.0
    assert report.answer is Answer.PLANNED and len(report.steps) == 2
    told = {word.text: (word.kind, word.meaning) for word in words_of_report(report, knowledge)}
    assert told["put"][0] is told["take"][0] is WordKind.ACTION
    assert told["put"][1] != told["take"][1]
    assert told["white"][0] is WordKind.COLOUR and told["white"][1].startswith("colour_")
    assert told["prism"][0] is WordKind.SHAPE and told["on"][0] is WordKind.PLACE
    assert told["then"][0] is WordKind.FUNCTION
    assert len(words_of_report(report, knowledge)) == len(SENTENCE.split())


def test_a_word_that_was_never_heard_is_told_as_unknown(scene: Path, knowledge: Knowledge) -> None:
    with World.from_scene(scene) as world:
        report = Executor(world, knowledge).preview("take the zorch cube")
    assert [word.kind for word in words_of_report(report, knowledge)] == [
        WordKind.ACTION,
        WordKind.FUNCTION,
        WordKind.UNKNOWN,
        WordKind.SHAPE,
    ]


def test_plans_name_the_action_and_its_things_before_what_the_hand_does(scene: Path, knowledge: Knowledge) -> None:
    with World.from_scene(scene) as world:
        executor = Executor(world, knowledge)
        report = executor.preview(SENTENCE)
        lines = plan_lines(report)
        begun: list[str] = []
        executor.doer.on_progress = lambda step: begun.append(line_of(step).text)
        done = executor.execute("put the red cube on the blue cube")
    headings = [line.text for line in lines if line.heading]
    assert headings == ["action_3 with “red cube” to “on the blue cube”", "action_1 with “white prism”"]
    first = [line.text for line in lines[1 : lines.index(next(each for each in lines[1:] if each.heading))]]
    assert "close the gripper" in first and "lower it to its place" in first
    assert done.answer is Answer.DONE and set(begun) == set(first)  # progress speaks the plan's words


def test_marks_are_where_the_things_are(scene: Path, knowledge: Knowledge) -> None:
    with World.from_scene(scene) as world:
        executor = Executor(world, knowledge)
        report = executor.preview("put the red cube on the blue cube")
        marks = {mark.role: mark for mark in marks_of(report, executor.doer, executor.doer.look())}
    assert marks["entity"].label == "red cube"
    assert np.allclose(marks["entity"].position, cell_centre(2, 2, 0), atol=0.008)  # looking is noisy
    assert np.allclose(marks["goal"].position, cell_centre(5, 3, 1), atol=0.008)


def test_a_lesson_is_kept_as_a_whole_and_changes_the_next_command(scene: Path, demo: Path, tmp_path: Path) -> None:
    path = tmp_path / "learned.json"
    knowledge, lesson = learn_demo(demo, path, 0)
    assert lesson is not None and lesson.sentences == 1
    assert knowledge.demos == Knowledge.load(path).demos == 1
    knowledge, _ = learn_demo(shown(scene, tmp_path / "again.mcap", seed=2), path, 0)
    assert knowledge.demos == Knowledge.load(path).demos == 2
    with World.from_scene(scene) as world:
        assert Executor(world, knowledge).execute("put the red cube on the blue cube").answer is Answer.DONE
    assert entry_of(knowledge, "cube").heard == 4.0
    assert {entry.word for entry in lexicon(knowledge)} == {"put", "the", "red", "cube", "on", "blue"}


def test_a_demo_is_learned_once_whatever_it_is_called(demo: Path, tmp_path: Path) -> None:
    path, copy = tmp_path / "learned.json", tmp_path / "copy.mcap"
    shutil.copy(demo, copy)
    learn_demo(demo, path, 0)
    before = path.read_bytes()
    for each in (demo, copy):
        knowledge, lesson = learn_demo(each, path, 0)
        assert lesson is None and knowledge.demos == 1
    assert path.read_bytes() == before
    student = Student(path, 0)
    try:
        student.learn(demo)
        answer = _wait_for(student)
    finally:
        student.close()
    assert answer["before"] is True and "sentences" not in answer


def test_a_demo_that_cannot_be_learned_changes_nothing(demo: Path, tmp_path: Path, knowledge_file: str) -> None:
    path = tmp_path / "known.json"
    shutil.copy(knowledge_file, path)
    before = path.read_bytes()
    broken = tmp_path / "broken.mcap"
    broken.write_bytes(demo.read_bytes()[:40])
    student = Student(path, 0)
    try:
        student.learn(broken)
        answer = _wait_for(student)
        assert answer["demo"] == "broken.mcap" and "broken.mcap" in answer["error"]
        assert path.read_bytes() == before
        student.learn(demo)  # it goes on afterwards
        answer = _wait_for(student)
        assert answer["sentences"] == 1 and answer["knowledge"]["demos"] == 51
    finally:
        student.close()
    assert Knowledge.load(path).demos == 51


def test_a_student_that_is_killed_leaves_the_knowledge_whole(demo: Path, tmp_path: Path, knowledge_file: str) -> None:
    path = tmp_path / "known.json"
    shutil.copy(knowledge_file, path)
    for delay in (0.0, 0.05, 0.2):
        student = Student(path, 0)
        student.tell()
        _wait_for(student)  # it has loaded all that it needs
        student.learn(demo)
        time.sleep(delay)
        os.kill(student.pid, signal.SIGKILL)
        student.close()
        assert Knowledge.load(path).demos in (50, 51, 52, 53)
    learn_demo(demo, path, 0)  # no lock is left behind


def test_what_was_learned_is_told_with_how_sure_it_is(knowledge: Knowledge) -> None:
    told = told_knowledge(knowledge)
    sections = {each["name"]: each["html"] for each in told["sections"]}  # type: ignore[index, union-attr]
    assert told["words"]["red"] == ["colour", 1.0]  # type: ignore[index]
    assert sections["actions"].count("<svg") == 3
    assert "spatial-relation" in sections["grammar"]
    assert 'style="' not in "".join(sections.values())  # the page's policy allows no inline styles


def test_words_are_escaped(knowledge: Knowledge) -> None:
    other = Knowledge(method="thesis")
    other.language.grounding.add("<b>x</b>", None, 3.0)
    html = told_knowledge(other)["sections"][0]["html"]  # type: ignore[index]
    assert "&lt;b&gt;x&lt;/b&gt;" in html and "<b>x" not in html


def test_the_page_loads_nothing_inline_and_nothing_from_elsewhere() -> None:
    files = talk_files()
    assert {"/talk.js", "/talk.css"} <= set(files)
    assert not set(files) & set(page_files())  # nothing of the page that drives is replaced
    for kind, data in files.values():
        assert kind.startswith(("text/javascript", "text/css"))
        assert b"http://" not in data and b"https://" not in data


def test_knowledge_of_tables_is_refused_on_the_board(scene: Path, tmp_path: Path) -> None:
    with (
        World.from_scene(scene) as world,
        pytest.raises(InputError, match="learned on tables, but this scene is the b"),
    ):
        check_fit(Knowledge("table"), world.spec.kind, tmp_path / "k.json")


def _wait_for(student: Student, seconds: float = 60.0) -> dict[str, object]:
    until = time.monotonic() + seconds
    while not (answers := student.answers()):
        assert time.monotonic() < until, "the student does not answer"
        time.sleep(0.02)
    return answers[0]
