"""Train-Robots releases in the public format: commands, scenes, and the demos that a pair of layouts implies.

A release is a directory with `commands.txt` and `configuration.txt`. The tree annotations beside them are for scoring
and are read in `learning.evaluation` alone.
"""

from learning.train_robots.change import CHANGES, Change
from learning.train_robots.extended import extended
from learning.train_robots.key_frames import implied_key_frames, key_frames, observe_before
from learning.train_robots.layout import Block, Cell, Layout
from learning.train_robots.release import Command, Release
from learning.train_robots.scene import Scene, ShownMove
from learning.train_robots.scene_spec import scene_spec
from learning.train_robots.synthetic import write_synthetic_release

__all__ = [
    "CHANGES",
    "Block",
    "Change",
    "Cell",
    "Command",
    "Layout",
    "Release",
    "Scene",
    "ShownMove",
    "extended",
    "implied_key_frames",
    "key_frames",
    "observe_before",
    "scene_spec",
    "write_synthetic_release",
]
