"""Objects by name. What was built once is kept: objects do not change."""

from functools import cache

from ..board import ALL_COLOURS_RGB, ALL_SHAPES
from ..errors import SceneError
from .model import ObjectModel
from .tables import COLOURS_RGB, ORDERING, TABLETOP

CATALOGUES: dict[str, tuple[str, ...]] = {"tabletop": tuple(TABLETOP), "ordering": tuple(ORDERING)}
"""Names of the objects of each catalogue."""


def look_of(name: str) -> tuple[str, str]:
    """Shape class and colour of an object, without building it.

    Raises:
        SceneError: There is no such object; lists the names.
    """
    entry = TABLETOP.get(name) or ORDERING.get(name)
    if entry is None:
        raise SceneError(f"unknown model; use one of {', '.join([*TABLETOP, *ORDERING])}")
    return entry.shape, entry.colour


@cache
def object_model(name: str) -> ObjectModel:
    """The object of a catalogue.

    Args:
        name: Such as `green_mug` or `large_red_bottle`.

    Raises:
        SceneError: There is no such object; lists the names.
    """
    from . import crockery, cutlery, fruit, office, packages, toys
    from .assembly import assemble

    shape, colour = look_of(name)
    rgb = COLOURS_RGB[colour]
    if name in TABLETOP:
        makers = {
            "cube": toys.cube,
            "cylinder": toys.cylinder,
            "apple": fruit.apple,
            "pear": fruit.pear,
            "banana": fruit.banana,
            "fork": cutlery.fork,
            "spoon": cutlery.spoon,
            "knife": cutlery.knife,
            "bowl": crockery.bowl,
            "mug": crockery.mug,
            "marker": office.marker,
            "stapler": office.stapler,
            "tape": office.tape,
        }
        return assemble(name, shape, colour, rgb, makers[shape](rgb), TABLETOP[name].scale)
    entry = ORDERING[name]
    packers = {
        "cup": packages.cup,
        "bottle": packages.bottle,
        "can": packages.can,
        "jar": packages.jar,
        "carton": packages.carton,
        "tub": packages.tub,
    }
    return assemble(name, shape, colour, rgb, packers[shape](rgb, entry.width, entry.height, entry.contents))


@cache
def board_model(shape: str, colour: str) -> ObjectModel:
    """A block of the board.

    Args:
        shape: One of `board.ALL_SHAPES`.
        colour: One of `board.ALL_COLOURS_RGB`.

    Raises:
        SceneError: There is no such shape or colour; lists those that there are.
    """
    from . import board_blocks
    from .assembly import assemble

    if shape not in ALL_SHAPES:
        raise SceneError(f"unknown shape {shape!r} of a block; use one of {', '.join(ALL_SHAPES)}")
    if colour not in ALL_COLOURS_RGB:
        raise SceneError(f"unknown colour {colour!r} of a block; use one of {', '.join(ALL_COLOURS_RGB)}")
    makers = {
        "cube": board_blocks.cube,
        "prism": board_blocks.prism,
        "sphere": board_blocks.sphere,
        "cylinder": board_blocks.cylinder,
    }
    rgb = ALL_COLOURS_RGB[colour]
    return assemble(f"board_{colour}_{shape}", shape, colour, rgb, makers[shape](rgb))
