"""Make the README's picture of the three robots at work: `python tools/robots_at_work.py docs/robots.png`.

Each picks up an object of a random scene by friction and is drawn with it.
"""

import sys
from pathlib import Path

import numpy as np

from executor.handling import Handling
from executor.picture import save_strip
from executor.portrait import at_work
from twin import SceneSpec, World
from twin.ordering_scene import random_ordering
from twin.scenes import resolve_scene
from twin.tabletop_scene import random_tabletop


def main(path: Path) -> None:
    """Draw the three."""
    rng = np.random.default_rng(3)
    shots: list[tuple[str, SceneSpec, tuple[float, ...], tuple[float, ...], float]] = [
        ("three_dof: board", resolve_scene("board-all", 4), (1.0, -0.72, 0.80), (0.10, 0.20, 0.30), 1.1),
        (
            "baxter: tabletop",
            random_tabletop(rng, including="red_mug"),
            (2.25, -1.25, 1.05),
            (0.36, 0.0, 0.30),
            1.35,
        ),
        (
            "mico_segway: ordering",
            random_ordering(rng, including="large_blue_bottle"),
            (1.45, -1.15, 0.75),
            (0.22, 0.0, -0.02),
            1.4,
        ),
    ]
    views, titles = [], []
    for title, spec, eye, target, zoom in shots:
        with World(spec) as world:
            for thing in spec.objects:
                side = next(iter(world.robot.arms)) if thing.position[1] >= 0 else list(world.robot.arms)[-1]
                if Handling(world, side, rng).pick(thing.id, 0.12).success:
                    break
            views.append(at_work(world, eye, target, zoom, 460, 460))
            titles.append(title)
    save_strip(path, views, titles, "Held by friction alone.")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
