"""What the extended Train-Robots release changes (thesis 6.2.1)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True)
class Change:
    """What some scenes change.

    Attributes:
        what: Property of a block.
        old: Its public value before.
        new: Its value afterwards.
        words: Words for the old value, each with the word that takes its place.
    """

    what: Literal["shape", "colour"]
    old: str
    new: str
    words: Mapping[str, str]


CHANGES = (
    Change(
        "shape",
        "prism",
        "sphere",
        {
            "prism": "sphere",
            "prisms": "spheres",
            "pyramid": "ball",
            "pyramids": "balls",
            "tetrahedron": "globe",
            "triangle": "orb",
        },
    ),
    Change(
        "shape",
        "cube",
        "cylinder",
        {
            "cube": "cylinder",
            "cubes": "cylinders",
            "block": "drum",
            "blocks": "drums",
            "brick": "roller",
            "bricks": "rollers",
            "box": "can",
            "boxes": "cans",
        },
    ),
    Change("colour", "red", "black", {"red": "black"}),
)
