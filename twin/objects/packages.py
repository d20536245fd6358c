"""Cups, bottles, cans and containers: what stands on a counter, empty or filled.

Each is a shell, weighed by the volume of its wall, with contents that weigh what the catalogue says. The contents move
with the shell and are not touched.
"""

from .assembly import Blueprint
from .holds import from_above, from_the_side, pinch
from .model import Grasp, Rgb
from .parts import drum_part, ring_parts, turned_part
from .solids import Solid, bar, box, drum, turned

PLASTIC = 1100.0
"""Density [kg/m^3] of the shells."""
CLEAR = 0.004
"""Height [m] above which walls begin for contact: only the bottom touches the table, which keeps physics fast."""
_THIN = 0.0012
"""Wall [m] of what is closed; open things have thicker ones, which contact feels from both sides."""
_THICK = 0.0035
_LID = (0.80, 0.80, 0.82)
_STEEL = (0.70, 0.70, 0.72)
_SIDES = ((1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0))


def cup(rgb: Rgb, width: float, height: float, contents: float) -> Blueprint:
    """A beaker without a handle that widens towards its rim."""
    top, low = width / 2, 0.44 * width

    def radius(z: float) -> float:
        return low + (top - low) * z / height

    base = [(0.0, 0.0), (low - 0.002, 0.0), (low - 0.001, 0.005), (0.0, 0.005)]
    wall = [(radius(CLEAR) - _THICK, CLEAR), (radius(CLEAR), CLEAR), (top, height), (top - _THICK, height)]
    outside = [(0.0, 0.0), (low - 0.002, 0.0), (radius(0.003), 0.003), (top, height)]
    inside = [(top - _THICK, height), (radius(0.005) - _THICK, 0.005), (0.0, 0.005)]
    shell = turned([*outside, *inside], PLASTIC, rgb, [turned_part(base), *ring_parts(wall)])
    filling = _filling(low - _THICK, 0.006, 0.8 * height, contents)
    holds = [hold for z in (0.55 * height, 0.70 * height) for hold in from_the_side(2 * radius(z), z)]
    return Blueprint([shell, *filling], holds)


def bottle(rgb: Rgb, width: float, height: float, contents: float) -> Blueprint:
    """A bottle with a shoulder, a neck and a screw cap of 36 mm."""
    radius, neck, lid = width / 2, 0.0145, 0.018
    shoulder, throat, cap = 0.60 * height, 0.80 * height, height - 0.018
    slope = [(radius, shoulder), (0.88 * radius + 0.12 * neck, 0.68 * height), (neck, throat)]
    body = [(0.0, 0.0), (radius - 0.003, 0.0), (radius, 0.003), *slope, (neck, cap), (0.0, cap)]
    parts = [drum_part(radius, 0.0, shoulder), turned_part(slope), drum_part(neck, throat, cap)]
    shell = turned(body, PLASTIC, rgb, parts)
    top = drum(lid, cap, height, PLASTIC, _LID)
    filling = _filling(radius - 0.002, 0.002, shoulder, contents)
    holds = [hold for z in (0.40 * height, 0.52 * height) for hold in from_the_side(width, z)]
    return Blueprint([shell, shell.cavity(_THIN), top, *filling], [*holds, *from_above(2 * lid, height - 0.010)])


def can(rgb: Rgb, width: float, height: float, contents: float) -> Blueprint:
    """A drinks can with a steel top and its tab."""
    radius = width / 2
    profile = [
        (0.0, 0.0),
        (radius - 0.004, 0.0),
        (radius, 0.005),
        (radius, height - 0.007),
        (radius - 0.004, height - 0.001),
    ]
    shell = turned([*profile, (0.0, height - 0.001)], 2700.0, rgb, [drum_part(radius, 0.0, height)])
    edge, inner = radius - 0.0035, radius - 0.0055
    ring = [(inner, height - 0.003), (edge, height - 0.003), (edge, height), (inner, height), (inner, height - 0.003)]
    top = turned(ring, 2700.0, _STEEL)
    tab = box([0.018, 0.010, 0.0008], [0.006, 0, height - 0.0006], 2700.0, _STEEL)
    filling = _filling(radius - 0.001, 0.002, 0.9 * height, contents)
    holds = [hold for z in (0.5 * height, 0.65 * height) for hold in from_the_side(width, z)]
    solids = [shell, shell.cavity(0.0004), top, Solid(tab.mesh, tab.density, tab.rgb), *filling]
    return Blueprint(solids, [*holds, *from_above(width, height - 0.020)])


def jar(rgb: Rgb, width: float, height: float, contents: float) -> Blueprint:
    """A squat jar with a metal lid a little narrower than its body."""
    radius, lid, neck = width / 2, 0.44 * width, height - 0.018
    slope = [(radius, neck - 0.010), (lid - 0.002, neck)]
    body = [(0.0, 0.0), (radius - 0.004, 0.0), (radius, 0.004), *slope, (0.0, neck)]
    shell = turned(body, PLASTIC, rgb, [drum_part(radius, 0.0, neck - 0.010), turned_part(slope)])
    top = drum(lid, neck, height, PLASTIC, _LID)
    filling = _filling(radius - 0.002, 0.002, 0.9 * neck, contents)
    holds = [hold for z in (0.40 * height, 0.50 * height) for hold in from_the_side(width, z)]
    return Blueprint([shell, shell.cavity(0.0025), top, *filling], [*holds, *from_above(2 * lid, height - 0.009)])


def carton(rgb: Rgb, width: float, height: float, contents: float) -> Blueprint:
    """A square drinks carton with a gabled top."""
    half, eaves, ridge = width / 2, 0.78 * height, 0.93 * height
    body = box([width, width, eaves], [0, 0, eaves / 2], 700.0, rgb)
    roof = bar([(-half, eaves), (half, eaves), (0.004, ridge), (-0.004, ridge)], width, 700.0, _LID)
    crest = box([0.006, width, height - ridge + 0.002], [0, 0, (height + ridge - 0.002) / 2], 700.0, rgb)
    filling = _filling(half, 0.002, 0.75 * height, contents, square=True)
    holds = _square_holds(width, (0.40 * height, 0.55 * height))
    return Blueprint([body, body.cavity(0.001), roof, roof.cavity(0.001), crest, *filling], holds)


def tub(rgb: Rgb, width: float, height: float, contents: float) -> Blueprint:
    """An open square container."""
    half, floor = width / 2, 0.004
    base = box([width, width, floor], [0, 0, floor / 2], PLASTIC, rgb)
    long, short, tall = width, width - 2 * _THICK, height - floor
    middle = (half - _THICK / 2, (height + floor) / 2)
    walls = [box([_THICK, long, tall], [side * middle[0], 0, middle[1]], PLASTIC, rgb) for side in (-1, 1)]
    walls += [box([short, _THICK, tall], [0, side * middle[0], middle[1]], PLASTIC, rgb) for side in (-1, 1)]
    filling = _filling(half - _THICK, floor, 0.7 * height, contents, square=True)
    return Blueprint([base, *walls, *filling], _square_holds(width, (0.5 * height, 0.65 * height)))


def _filling(radius: float, bottom: float, top: float, mass: float, *, square: bool = False) -> list[Solid]:
    """Contents of a given mass [kg] up to a radius, or half of a side, between two heights [m]; none weigh nothing."""
    if mass <= 0:
        return []
    if square:
        solid = box([2 * radius, 2 * radius, top - bottom], [0, 0, (bottom + top) / 2], 1.0, None)
    else:
        solid = drum(radius, bottom, top, 1.0, None)
    return [Solid(solid.mesh, mass / solid.mesh.volume, None)]


def _square_holds(width: float, heights: tuple[float, float]) -> list[Grasp]:
    """Hold a square thing from its four sides."""
    return [pinch((0, 0, z), (-y, x, 0), width, (-x, -y, 0)) for z in heights for x, y, _ in _SIDES]
