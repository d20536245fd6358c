"""What the learner may not see changes nothing that it learns (design section 7)."""

import shutil
from pathlib import Path

import numpy as np

from executor.release_student import study_release
from learning import Learner
from learning.train_robots import Release

SCENES = 6


def learned(directory: Path) -> object:
    release = Release.load(directory)
    scenes = [scene for scene in release.scenes.values() if scene.number <= SCENES]
    commands = [command for command in release.commands if command.scene <= SCENES]
    learner = Learner(seed=1)
    study_release(learner, scenes, commands, np.random.default_rng(1))
    return learner.knowledge.to_json()


def test_learning_gives_the_same_knowledge_whatever_the_annotation_says(
    tmp_path: Path, synthetic_release_directory: Path
) -> None:
    assert (synthetic_release_directory / "annotation.txt").exists()
    knowledge = learned(synthetic_release_directory)
    for name in ("commands.txt", "configuration.txt"):
        shutil.copy(synthetic_release_directory / name, tmp_path)
    assert learned(tmp_path) == knowledge
    (tmp_path / "annotation.txt").write_bytes(b"\xff no tree at all")  # whoever opens it fails
    assert learned(tmp_path) == knowledge
