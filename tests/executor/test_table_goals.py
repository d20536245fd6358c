"""When a thing is where a sentence says."""

import numpy as np
import pytest

from executor.collections.rules import Facts
from executor.collections.table_goals import FARTHEST_BESIDE, Goal, reached
from robots.pose import FloatArray
from teleop.annotators import Destination
from twin import ObjectSpec, SceneSpec, World
from twin.objects import object_model


class Ended:
    """What came of a thing, as far as its place tells."""

    def __init__(self, place: FloatArray, height: float = 0.0) -> None:
        self.positions, self.heights = [place], [height]


@pytest.mark.parametrize(
    ("off", "side", "beside"),
    [
        ((0.0, 0.12), True, True),
        ((0.0, -0.12), False, True),  # on another side than the demo's, of which nobody spoke
        ((0.12, 0.05), False, True),
        ((0.0, FARTHEST_BESIDE + 0.01), False, False),
    ],
)
def test_a_side_counts_where_it_was_said(off: tuple[float, float], side: bool, beside: bool) -> None:
    mug = ObjectSpec.of_model(0, "red_mug", (0.65, 0.0, object_model("red_mug").half_extents[2]))
    goal = Goal(Destination(relation="left", reference=0), np.zeros(3))
    with World(SceneSpec(name="side", kind="table", robot="baxter", objects=(mug,))) as world:
        end: Facts = Ended(np.array([0.65 + off[0], off[1], 0.03]))  # type: ignore[assignment]
        assert (reached(end, goal, world) == "") is side
        assert (reached(end, goal, world, only_beside=True) == "") is beside
        above: Facts = Ended(np.array([0.65, 0.12, 0.2]), 0.1)  # type: ignore[assignment]
        assert reached(above, goal, world, only_beside=True) == "not beside it as meant"
