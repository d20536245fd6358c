"""Drawings of the concepts of each feature space (figures 6.14 to 6.16 of the thesis)."""

import math
from collections.abc import Mapping

import numpy as np

from executor.knowledge_page import svg
from learning.concepts.gaussian import Gaussian
from robots.pose import FloatArray

ROSE = 300.0
"""Side of the compass rose in the page's pixels."""
PLAN = 300.0
"""Longest side of the plan of places."""
BARS = (230.0, 70.0)
LINE = (520.0, 130.0)
CURVE_POINTS = 160

Components = Mapping[int, Gaussian]


def swatch(colour: tuple[int, int, int]) -> str:
    """A patch of a colour, red, green and blue in 0..255."""
    fill = "rgb({},{},{})".format(*colour)
    return svg.drawing(96, 56, [svg.box(0.5, 0.5, 95, 55, "frame", fill)], "a patch of " + fill)


def histogram(bins: FloatArray) -> str:
    """The bins of a shape's descriptor as bars; the three angles of FPFH stand apart."""
    width, height = BARS
    each = (width - 16.0) / max(len(bins), 1)
    largest = max(float(np.max(bins)), 1e-9)
    parts = [svg.line(0, height - 1, width, height - 1)]
    for index, value in enumerate(bins):
        tall = (height - 4.0) * max(float(value), 0.0) / largest
        left = index * each + 8.0 * min(index // 11, 2)
        parts.append(svg.box(left, height - 1 - tall, max(each - 1.0, 1.0), tall, "bar"))
    return svg.drawing(width, height, parts, f"histogram of {len(bins)} bins")


def compass_rose(components: Components) -> str:
    """Directions as seen from above by the robot: away from it is up, its left is left; above is in the middle.

    The farther a mark is from the middle, the more level the direction; what points downwards is drawn hollow.
    """
    middle, radius = ROSE / 2.0, ROSE / 2.0 - 24.0
    parts = [svg.circle(middle, middle, radius * math.cos(math.radians(angle))) for angle in (0, 30, 60)]
    for words, x, y in (("away", 0.0, -1.0), ("left", -1.0, 0.0), ("near", 0.0, 1.0), ("right", 1.0, 0.0)):
        parts.append(svg.line(middle, middle, middle + x * radius, middle + y * radius))
        parts.append(svg.text(middle + x * (radius + 12), middle + y * (radius + 12) + 4, words, "faint"))
    for number, size, component in _by_size(components):
        x, y, z = (float(value) for value in component.mean)
        length = max(math.sqrt(x * x + y * y + z * z), 1e-9)
        right, down = middle - y / length * radius, middle - x / length * radius
        parts.append(svg.circle(right, down, 5.0 + 9.0 * size, "blob" if z >= -0.2 * length else "hollow"))
        parts.append(svg.text(right, down + 4, str(number)))
    return svg.drawing(ROSE, ROSE, parts, "directions on a compass rose")


def plan(components: Components) -> str:
    """Places on the table seen from above, the robot below: each with two standard deviations."""
    means = np.array([component.mean[:2] for component in components.values()])
    low, high = means.min(axis=0) - 0.05, means.max(axis=0) + 0.05
    scale = (PLAN - 20.0) / max(float((high - low).max()), 0.1)
    width, height = (high[1] - low[1]) * scale + 20.0, (high[0] - low[0]) * scale + 40.0
    parts = [svg.box(0.5, 0.5, width - 1, height - 21, "edge"), svg.text(width / 2, height - 6, "robot", "faint")]
    turn = np.array([[0.0, -1.0], [-1.0, 0.0]])  # x goes up on the page, y to the left
    for number, _, component in _by_size(components):
        right = 10.0 + (high[1] - float(component.mean[1])) * scale
        down = 10.0 + (high[0] - float(component.mean[0])) * scale
        parts.append(svg.ellipse(right, down, turn @ component.covariance[:2, :2] @ turn.T, scale))
        parts.append(svg.text(right, down + 4, str(number)))
    return svg.drawing(width, height, parts, "places on the table")


def density_curves(components: Components, unit: str, factor: float) -> str:
    """One-dimensional components as curves over a common axis; `factor` turns values into `unit`."""
    width, height = LINE
    spread = {number: math.sqrt(float(one.covariance[0, 0])) for number, one in components.items()}
    low = min(float(one.mean[0]) - 3 * spread[number] for number, one in components.items())
    high = max(float(one.mean[0]) + 3 * spread[number] for number, one in components.items())
    span = max(high - low, 1e-9)
    base = height - 24.0
    parts = [svg.line(0, base, width, base)]
    for value in np.linspace(low, high, 6):
        x = 20.0 + (width - 40.0) * (float(value) - low) / span
        parts.append(svg.text(x, height - 8, f"{factor * float(value):.3g} {unit}", "faint"))
    for number, one in components.items():
        values = np.linspace(float(one.mean[0]) - 3 * spread[number], float(one.mean[0]) + 3 * spread[number],
                             CURVE_POINTS)  # fmt: skip
        heights = np.exp(-0.5 * ((values - float(one.mean[0])) / spread[number]) ** 2)
        places = 20.0 + (width - 40.0) * (values - low) / span
        parts.append(svg.path(np.stack([places, base - heights * (base - 24.0)], axis=1), "curve"))
        parts.append(svg.text(20.0 + (width - 40.0) * (float(one.mean[0]) - low) / span, 16, str(number)))
    return svg.drawing(width, height, parts, "curves of " + ", ".join(str(number) for number in components))


def _by_size(components: Components) -> list[tuple[int, float, Gaussian]]:
    """Number, share of the largest one's root count, and component; the largest first, so that none is hidden."""
    most = max((component.count for component in components.values()), default=1.0)
    rows = [(number, math.sqrt(one.count / most), one) for number, one in components.items()]
    return sorted(rows, key=lambda row: -row[1])
