"""Small scenes of each robot at its table, and knowledge to begin with.

The knowledge in `data/` was learned from the first demos of the collections, by

    showtell record --collection leeds --languages en,ar --count 30 -o leeds/
    showtell learn leeds/ -o tests/executor/data/baxter.json
    showtell record --collection ordering --languages en,ar --count 35 -o ordering/
    showtell learn ordering/ -o tests/executor/data/mico_segway.json
"""

from dataclasses import dataclass
from pathlib import Path

DATA = Path(__file__).parent / "data"


@dataclass(frozen=True)
class Case:
    """A robot at its table.

    Attributes:
        scene: The scene's TOML.
        arm: The arm that is driven.
        top_speed: Its speed with the stick pushed all the way [m/s].
        grasp: Where the tool closes around the first thing [m].
        word: What that thing is called.
        demos: Demos to learn from first: as many as `data/` was learned from.
    """

    scene: str
    arm: str
    top_speed: float
    grasp: tuple[float, float, float]
    word: str
    demos: int

    def write(self, folder: Path) -> Path:
        """Write the scene into a folder."""
        path = folder / "scene.toml"
        path.write_text(self.scene, encoding="utf-8")
        return path


CASES = {
    "baxter": Case(
        """
name = "tabletop"
kind = "table"
robot = "baxter"
objects = [
  {id = 0, model = "orange_apple", position = [0.52, 0.345, 0.01702]},
  {id = 1, model = "blue_cube", position = [0.70, 0.10, 0.016005]},
]
""",
        "left",
        0.05,
        (0.52, 0.345, 0.017),
        "apple",
        30,
    ),
    "mico_segway": Case(
        """
name = "ordering"
kind = "table"
robot = "mico_segway"
objects = [{id = 0, model = "small_blue_carton", position = [0.5, 0.0, 0.05]}]
""",
        "arm",
        0.1,
        (0.5, 0.0, 0.06),
        "carton",
        35,
    ),
}


def knowledge_of(robot: str) -> Path:
    """File of what is known of a robot's table."""
    return DATA / f"{robot}.json"
