"""Learning from a release of our own, incrementally, and what is kept of it."""

import json
from pathlib import Path

import numpy as np
import pytest

from learning import Interpreter, Knowledge, Learner
from learning.concept_id import Concept
from learning.errors import KnowledgeError
from learning.grounding.language_learner import LanguageLearner
from learning.grounding.reading_learner import ReadingLearner
from learning.learner import Lesson
from learning.perception import percept_of
from learning.train_robots import Release, key_frames, observe_before
from robots.errors import ShowtellError

SCENES = 48


def study(learner: Learner, release: Release, after: int) -> list[Lesson]:
    lessons = []
    for scene in release.one_block_scenes()[:after]:
        rng = np.random.default_rng([3, scene.number])
        sentences = [command.sentence for command in release.commands_of(scene.number)]
        lessons.append(learner.study(key_frames(scene, rng), sentences))
    return lessons


@pytest.fixture(scope="module")
def release(synthetic_release_directory: Path) -> Release:
    return Release.load(synthetic_release_directory)


@pytest.fixture(scope="module")
def course(release: Release) -> tuple[Knowledge, list[Lesson]]:
    learner = Learner(seed=1)
    lessons = study(learner, release, SCENES)
    return learner.knowledge, lessons


@pytest.fixture
def taught(course: tuple[Knowledge, list[Lesson]]) -> Knowledge:
    return course[0]


def test_the_same_seed_learns_the_same(release: Release) -> None:
    texts = []
    for _ in range(2):
        learner = Learner(seed=1)
        study(learner, release, 6)
        texts.append(json.dumps(learner.knowledge.to_json()))
    assert texts[0] == texts[1]


def test_knowledge_survives_a_file(taught: Knowledge, tmp_path: Path) -> None:
    path = tmp_path / "k.json"
    taught.save(path)
    again = Knowledge.load(path)
    again.save(tmp_path / "again.json")
    assert path.read_text() == (tmp_path / "again.json").read_text()
    assert [p.name for p in tmp_path.iterdir() if p.name.startswith(".")] == []


def test_sentences_of_demos_are_mostly_validated(course: tuple[Knowledge, list[Lesson]]) -> None:
    late = course[1][-SCENES // 3 :]
    heard = sum(lesson.sentences for lesson in late)
    assert heard >= SCENES // 3
    # The rest speaks of what the vocabulary of meaning lacks.
    assert sum(lesson.validated for lesson in late) >= 0.6 * heard


def test_nothing_of_a_demo_is_kept(taught: Knowledge, release: Release) -> None:
    text = json.dumps(taught.to_json())
    assert not any(command.sentence.lower() in text for command in release.commands if command.sentence.count(" ") > 3)
    assert not any(name in json.dumps(taught.spaces.to_json()) for name in ("red", "cube", "pick"))


def test_what_nothing_ever_rested_on_bears_nothing() -> None:
    knowledge = Knowledge()
    knowledge.seen.update({0: 100.0, 1: 100.0, 2: 5.0})
    knowledge.bearing.update({0: 40.0, 1: 0.0, 2: 0.0})
    assert knowledge.bearing_shapes() == {0, 2}  # 2 was not seen often enough to tell


def test_merged_concepts_are_renamed_in_language() -> None:
    language = LanguageLearner()
    old, new = Concept("colour", 5), Concept("colour", 2)
    language.correlation.observe(["red"], [old])
    language.grounding.add("red", old, 3.0)
    language.preferences.weights["red = colour_5"] = 1.5
    language.rename(old, new)
    assert language.grounding.probability("red", new) == pytest.approx(1.0)
    assert language.correlation.joint_counts["red"] == {new: 1.0}
    assert language.preferences.of("red = colour_2") == 1.5


def test_merged_concepts_are_renamed_in_readings() -> None:
    language = ReadingLearner()
    old, new = Concept("colour", 5), Concept("colour", 2)
    language.alignment.observe(["red"], [old])
    language.grounding.add("red", old, 3.0)
    language.weights.learned["means", "red", "colour_5"] = 1.5
    language.rename(old, new)
    assert language.grounding.probability("red", new) == pytest.approx(1.0)
    assert old not in language.alignment.totals
    assert language.weights.of(("means", "red", "colour_2")) == 1.5


@pytest.mark.parametrize(
    ("sentence", "said"),
    [
        ("", "sentence is empty"),
        ("…!", "sentence is empty"),
        ("ceci n'est pas une pipe", "never heard: ceci, n'est, pas, une, pipe"),
    ],
)
def test_what_is_not_understood_is_explained(taught: Knowledge, release: Release, sentence: str, said: str) -> None:
    scene = release.one_block_scenes()[0]
    percept = percept_of(observe_before(scene, np.random.default_rng(0)), taught.spaces)
    reading = Interpreter(taught).interpret(sentence, percept)
    assert not reading.understood
    assert reading.goals == ()
    assert said in reading.explanation


@pytest.mark.parametrize(
    ("sentence", "named"),
    [
        ("🙂", "🙂"),
        ("ارفع المكعب الأحمر", "المكعب"),
        ("拿起红色方块", "拿起红色方块"),
        ("red " * 10_000, "10000 words"),
        ("pick up the zorgle " * 80, "320 words"),
        ("zorgle " * 20 + "🙂" * 10_000, "🙂"),
        ("x" * 100_000, "xxx…"),
        ("\x00\u202e\t", "empty"),
    ],
)
def test_bad_input_is_answered_shortly_by_what_is_not_understood(
    taught: Knowledge, release: Release, sentence: str, named: str
) -> None:
    percept = percept_of(observe_before(release.one_block_scenes()[0], np.random.default_rng(0)), taught.spaces)
    reading = Interpreter(taught).interpret(sentence, percept)
    assert not reading.understood
    assert named in reading.explanation
    assert len(reading.explanation) < 1000  # ten words of each sort, the beginning of each: whatever came in


def test_words_and_signs_never_heard_are_named_where_the_rest_is_clear(taught: Knowledge, release: Release) -> None:
    scene = next(each for each in release.one_block_scenes() if release.commands_of(each.number))
    percept = percept_of(observe_before(scene, np.random.default_rng(0)), taught.spaces)
    sentence = release.commands_of(scene.number)[0].sentence
    clear = Interpreter(taught).interpret(sentence, percept)
    assert clear.understood
    assert clear.unknown == ()
    reading = Interpreter(taught).interpret(f"zorgle {sentence} 🙂", percept)
    assert reading.understood
    assert reading.unknown == ("zorgle", "🙂")
    assert "zorgle" in reading.explanation
    assert "🙂" in reading.explanation


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"version": 99}, "field 'version' is 99"),
        ({"schema": "other"}, "field 'schema'"),
        ({"concepts": {}}, "concepts"),
        ({"language": {"correlation": 3}}, "field 'language' is malformed"),
        ({"bearing": {"x": [1]}}, "field 'bearing' is malformed"),
    ],
)
def test_a_wrong_knowledge_file_is_refused_by_name(
    taught: Knowledge, tmp_path: Path, change: dict[str, object], message: str
) -> None:
    path = tmp_path / "wrong.json"
    path.write_text(json.dumps({**taught.to_json(), **change}))
    with pytest.raises(KnowledgeError, match=message) as caught:
        Knowledge.load(path)
    assert "wrong.json" in str(caught.value)
    assert isinstance(caught.value, ShowtellError)


def test_files_that_are_no_knowledge_are_refused(tmp_path: Path) -> None:
    (tmp_path / "text.json").write_text("{not json")
    with pytest.raises(KnowledgeError, match=r"text\.json: is not JSON"):
        Knowledge.load(tmp_path / "text.json")
    with pytest.raises(KnowledgeError, match=r"none\.json: cannot be read"):
        Knowledge.load(tmp_path / "none.json")


def test_a_failed_save_leaves_the_old_file(taught: Knowledge, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "k.json"
    taught.save(path)
    before = path.read_text()
    monkeypatch.setattr(Knowledge, "to_json", lambda self: {"x": object()})
    with pytest.raises(TypeError, match="not JSON serializable"):
        taught.save(path)
    assert path.read_text() == before
    assert list(tmp_path.iterdir()) == [path]
