"""Tables of keys in the pages are those of the code: files, answers, what a feature space says of itself."""

import re
import tomllib
from pathlib import Path

import numpy as np

from executor.execution.answer import Answer
from learning import Knowledge
from learning.concepts import FeatureSpace
from learning.knowledge import SCHEMA_VERSION
from learning.perception import Observation
from learning.perception.camera_observation import Perceived
from learning.perception.observation_file import load_observation, save_observation
from tests.docs.pages import REPOSITORY, Page
from twin import JointCommand, World
from twin.scene_spec import SceneSpec
from twin.scenes import read_scene

PAGE = Page(REPOSITORY / "docs" / "file-formats.md")


def section(title: str) -> str:
    return re.split(r"^## ", PAGE.text.partition(f"## {title}\n")[2], maxsplit=1, flags=re.MULTILINE)[0]


def keys_of_table(text: str) -> set[str]:
    """What stands between backticks in the first column."""
    rows = re.findall(r"^\| (`.+?`)(?=,? ?\||, `| \|)(.*)$", text, flags=re.MULTILINE)
    return {key for first, rest in rows for key in re.findall(r"`([^`]+)`", f"{first}{rest}".split(" |")[0])}


def test_the_keys_of_knowledge_are_those_of_the_file() -> None:
    knowledge = Knowledge()
    data = knowledge.to_json()
    text = section("Knowledge")
    assert keys_of_table(text) == set(data)
    assert f'`"{data["schema"]}"` and {SCHEMA_VERSION};' in text
    named = {name for span in PAGE.spans for name in re.split(r"\W", span)}
    language, tables = data["language"], data["table_language"]
    assert named >= {*data["concepts"], *language, *language["grammar"], *tables} - {"demos", "sentences"}


def test_the_arrays_of_observations_are_those_of_the_file(tmp_path: Path) -> None:
    frames, things = 3, 2
    seen = Observation(
        times=np.arange(frames) / 10.0,
        gripper_location=np.zeros((frames, 3)),
        gripper_closed=np.zeros(frames, dtype=bool),
        object_ids=np.arange(things),
        location=np.zeros((frames, things, 3)),
        colour=np.zeros((frames, things, 3)),
        shape=np.zeros((frames, things, 33)),
        visible=np.ones((frames, things), dtype=bool),
        extent=np.ones((frames, things, 3)),
        gripper_opening=np.zeros(frames),
        wrist_force=np.zeros((frames, 3)),
        features={"NAME": np.zeros((frames, things, 5))},
    )
    file = tmp_path / "seen.npz"
    save_observation(file, Perceived(seen, ()))
    with np.load(file) as arrays:
        assert keys_of_table(section("Observations")) == set(arrays.files)
        assert f'`"{arrays["format"]}"`' in section("Observations")
    assert load_observation(file).observation.location.shape == (frames, things, 3)


def test_the_scene_of_the_page_stands_in_physics_and_no_key_is_forgotten(tmp_path: Path) -> None:
    (fence,) = (each for each in PAGE.fences if each.language == "toml")
    file = tmp_path / "scene.toml"
    file.write_text(fence.text, encoding="utf-8")
    with World.from_scene(str(file)) as world:
        still = JointCommand(np.zeros(len(world.state().q)), world.state().gripper_opening)
        for _ in range(120):
            world.step(still)
        found = {each.id: each.pose_object_in_world.position for each in world.state().objects}
    for each in read_scene(file).objects:
        # What is written stands on the board: half a second later it is still there.
        np.testing.assert_allclose(found[each.id], each.position, atol=0.002)
    named = set(tomllib.loads(fence.text)) | set(PAGE.spans)
    assert set(SceneSpec.model_fields) <= named


def test_every_answer_is_explained() -> None:
    page = Page(REPOSITORY / "docs" / "commands.md")
    table = page.text.partition("## Answers\n")[2].partition("\n## ")[0]
    assert set(re.findall(r"^\| `([a-z-]+)` \|", table, flags=re.MULTILINE)) == {str(answer) for answer in Answer}


def test_every_scale_of_a_feature_space_is_explained() -> None:
    page = Page(REPOSITORY / "docs" / "own-feature.md")
    assert set(FeatureSpace.__annotations__) - {"name"} <= set(page.spans)
