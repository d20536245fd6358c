"""The few shapes that the drawings of a page are made of, as SVG text."""

import math
from html import escape

import numpy as np

from robots.pose import FloatArray


def drawing(width: float, height: float, parts: list[str], label: str) -> str:
    """A whole drawing; `label` is what a screen reader says."""
    return (
        f'<svg viewBox="0 0 {width:g} {height:g}" width="{width:g}" height="{height:g}" role="img" '
        f'aria-label="{escape(label)}">{"".join(parts)}</svg>'
    )


def line(x1: float, y1: float, x2: float, y2: float, kind: str = "thin") -> str:
    """A line; `kind` is a class of the page's style."""
    return f'<line class="{kind}" x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}"/>'


def circle(x: float, y: float, radius: float, kind: str = "thin") -> str:
    """A circle."""
    return f'<circle class="{kind}" cx="{x:.1f}" cy="{y:.1f}" r="{radius:.1f}"/>'


def box(x: float, y: float, width: float, height: float, kind: str, fill: str = "") -> str:
    """A rectangle; a `fill` of its own counts where the page's style gives its kind none."""
    own = f' fill="{fill}"' if fill else ""  # an attribute: pages that allow no inline styles show it too
    return f'<rect class="{kind}" x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}"{own}/>'


def text(x: float, y: float, words: str, kind: str = "", anchor: str = "middle") -> str:
    """A line of text whose baseline is at y."""
    return f'<text class="{kind}" x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(words)}</text>'


def ellipse(x: float, y: float, covariance: FloatArray, scale: float, kind: str = "blob") -> str:
    """Two standard deviations of a covariance (2, 2) around a point; `scale` turns its unit into the drawing's.

    The covariance is along the drawing's own axes: to the right and downwards.
    """
    values, vectors = np.linalg.eigh(covariance)
    small, large = (max(1.5, 2.0 * scale * math.sqrt(max(float(value), 0.0))) for value in values)
    angle = math.degrees(math.atan2(vectors[1, 1], vectors[0, 1]))
    return (
        f'<ellipse class="{kind}" cx="{x:.1f}" cy="{y:.1f}" rx="{large:.1f}" ry="{small:.1f}" '
        f'transform="rotate({angle:.1f} {x:.1f} {y:.1f})"/>'
    )


def path(points: FloatArray, kind: str) -> str:
    """A line through points (n, 2)."""
    steps = " ".join(f"{'L' if index else 'M'}{x:.1f} {y:.1f}" for index, (x, y) in enumerate(points))
    return f'<path class="{kind}" d="{steps}"/>'
