"""Do demos driven on the twin teach the same actions as the key frames that their layouts imply?"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from executor.import_release import demo_path
from learning.concepts import ConceptSpaces, fit_demo
from learning.graphs import ActionGraphlet, action_of
from learning.perception import observe_demo
from learning.train_robots import Release, key_frames
from teleop import is_whole, load_demo


@dataclass(frozen=True, slots=True)
class GraphletPair:
    """Action graphlets of one scene.

    Attributes:
        scene: Scene number.
        driven: Seen in the demo that was driven on the twin.
        implied: Seen in the key frames of the layouts.
    """

    scene: int
    driven: ActionGraphlet
    implied: ActionGraphlet

    @property
    def same(self) -> bool:
        """Whether the two are isomorphic (thesis 3.4.2)."""
        return self.driven.matches(self.implied)


def compare_graphlets(
    release: Release, demos_dir: str | Path, count: int, rng: np.random.Generator
) -> list[GraphletPair]:
    """Compare `count` scenes drawn at random among those with a whole demo, all where there are fewer.

    Both are observed through the board's noise; what is *at it* is learned from these very demos.

    Raises:
        DemoError: A demo cannot be read.
    """
    paths = [(scene, demo_path(demos_dir, scene.number)) for scene in release.one_block_scenes()]
    made = [(scene, path) for scene, path in paths if path.exists() and is_whole(path)]
    seen = []
    spaces = ConceptSpaces()
    for index in sorted(rng.permutation(len(made))[:count]):
        scene, path = made[index]
        observations = observe_demo(load_demo(path), rng), key_frames(scene, rng)
        for observation in observations:
            spaces.update(fit_demo(observation, rng))
        seen.append((scene.number, observations))
    return [
        GraphletPair(number, action_of(driven, spaces), action_of(implied, spaces))
        for number, (driven, implied) in seen
    ]
