"""The two catalogues as data: what there is, without what it takes to build it."""

from dataclasses import dataclass
from typing import Literal

from ..board import ALL_COLOURS_RGB
from .model import Rgb

COLOURS_RGB: dict[str, Rgb] = {
    **ALL_COLOURS_RGB,
    "orange": (0.95, 0.50, 0.08),
    "purple": (0.45, 0.15, 0.65),
    "brown": (0.42, 0.24, 0.11),
}
"""Surface colours of all objects, red green blue in 0..1."""


@dataclass(frozen=True, slots=True)
class TabletopEntry:
    """An object of the tabletop: its class, its colour, and how much larger than usual it is."""

    shape: str
    colour: str
    scale: float


@dataclass(frozen=True, slots=True)
class OrderingEntry:
    """An object of the counter: its class, size word and colour, its sides and what its contents weigh [m, kg]."""

    shape: str
    size: Literal["small", "large"]
    colour: str
    width: float
    height: float
    contents: float


_TABLETOP_COLOURS = {
    "cube": "red blue yellow purple",
    "cylinder": "green orange red purple",
    "apple": "red green yellow orange",
    "pear": "green yellow brown red",
    "banana": "yellow green brown",
    "fork": "gray black blue white",
    "spoon": "gray brown orange white",
    "knife": "gray black purple white",
    "bowl": "white blue orange brown",
    "mug": "red green blue white",
    "marker": "black red blue green",
    "stapler": "black gray red purple",
    "tape": "brown gray yellow purple",
}
_SCALES = (1.0, 0.94, 0.97, 0.92)
"""Things of one class differ a little in size, in this order."""

TABLETOP: dict[str, TabletopEntry] = {
    f"{colour}_{shape}": TabletopEntry(shape, colour, scale)
    for shape, colours in _TABLETOP_COLOURS.items()
    for colour, scale in zip(colours.split(), _SCALES, strict=False)
}
"""51 objects of 13 shape classes and ten colours, for Baxter, by name."""

_SMALL_OR_LARGE: dict[str, dict[Literal["small", "large"], tuple[float, float]]] = {
    "cup": {"small": (0.056, 0.075), "large": (0.068, 0.105)},
    "bottle": {"small": (0.052, 0.150), "large": (0.066, 0.200)},
    "can": {"small": (0.053, 0.090), "large": (0.066, 0.120)},
    "jar": {"small": (0.056, 0.070), "large": (0.068, 0.095)},
    "carton": {"small": (0.050, 0.100), "large": (0.064, 0.150)},
    "tub": {"small": (0.056, 0.050), "large": (0.068, 0.065)},
}
"""Width and height [m] of each class."""

_CONTENTS: dict[str, dict[Literal["small", "large"], dict[str, float]]] = {
    "cup": {
        "small": {"red": 0.0, "white": 0.06, "blue": 0.03},
        "large": {"red": 0.15, "green": 0.0, "yellow": 0.22},
    },
    "bottle": {
        "small": {"blue": 0.15, "green": 0.0, "white": 0.20},
        "large": {"red": 0.50, "blue": 0.30, "black": 0.04},
    },
    "can": {
        "small": {"red": 0.15, "orange": 0.18, "green": 0.02},
        "large": {"blue": 0.33, "black": 0.20, "yellow": 0.02},
    },
    "jar": {"small": {"yellow": 0.12, "red": 0.03}, "large": {"orange": 0.30, "white": 0.20, "green": 0.05}},
    "carton": {"small": {"white": 0.20, "orange": 0.08, "blue": 0.02}, "large": {"green": 0.45, "yellow": 0.25}},
    "tub": {"small": {"green": 0.05, "yellow": 0.0}, "large": {"white": 0.15, "black": 0.03}},
}
"""What the contents weigh [kg], by class, size and colour."""

ORDERING: dict[str, OrderingEntry] = {
    f"{size}_{colour}_{shape}": OrderingEntry(shape, size, colour, *_SMALL_OR_LARGE[shape][size], contents)
    for shape, sizes in _CONTENTS.items()
    for size, colours in sizes.items()
    for colour, contents in colours.items()
}
"""32 objects of six shape classes and seven colours, for the Mico, by name."""
