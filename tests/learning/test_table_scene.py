"""What holds between things at a table: on or in one another, or beside and on a side."""

import numpy as np
import pytest

from learning.concepts import ConceptSpaces
from learning.concepts.space_set import TABLE
from learning.grounding.table_scene import BESIDE, OVER, relation_of

CUBE = (0.034, 0.034, 0.034)
BOWL = (0.10, 0.09, 0.045)
FORK = (0.15, 0.024, 0.014)


@pytest.mark.parametrize(
    ("offset", "one", "other", "over"),
    [
        ((0.0, 0.0, 0.034), CUBE, CUBE, True),  # stacked
        ((0.01, 0.02, -0.005), CUBE, BOWL, True),  # in the bowl, as low as the bowl's own middle
        ((-0.01, -0.02, 0.005), BOWL, CUBE, False),  # the bowl around it is not in it
        ((0.0, 0.08, 0.0), CUBE, BOWL, False),  # beside the bowl
        ((0.0, 0.06, 0.01), CUBE, FORK, False),  # beside something narrow
    ],
)
def test_on_and_in_are_told_from_beside(
    offset: tuple[float, ...], one: tuple[float, ...], other: tuple[float, ...], over: bool
) -> None:
    found = relation_of(np.array(offset), ConceptSpaces(TABLE), np.array([one, other]))
    assert (OVER in found) == over
    assert (BESIDE in found) != over


def test_without_sides_nothing_is_over_another_and_what_is_far_has_no_relation() -> None:
    spaces = ConceptSpaces(TABLE)
    assert relation_of(np.array([0.0, 0.0, 0.03]), spaces) == {BESIDE}
    assert relation_of(np.array([0.0, 0.4, 0.0]), spaces, np.array([CUBE, BOWL])) == frozenset()
