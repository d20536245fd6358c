"""The colour of a thing, whatever its shades: the well-lit pixels of its main colour."""

import numpy as np

from learning.perception.height_slices import height_weights
from robots.pose import FloatArray

MAIN_COLOUR = 0.08
"""Distance in chromaticity from the median that is still the main colour: caps and labels are not."""
CHROMA_NOISE = 8.0
"""How much farther in the dark, over the sum of a pixel's channels."""
SHADED = 3.0
"""Factor of brightness that light and shade explain; a white cap on a black body is more."""
DARK = 24.0
"""Added to the sum of a pixel's channels before brightness is compared: noise of three channels."""
WELL_LIT = 0.9
"""Part of the pixels of the main colour that are darker than the well-lit ones: of a mug only the rim is in light."""
BY_HEIGHT = 0.5
"""How much of a pixel's weight is that of its height where nothing is hidden: a lid seen from above has half of the
pixels and few of the heights, and the base of a stapler the other way round."""
MOST_PIXELS = 200
"""About so many pixels are looked at."""


def surface_colour(colours: FloatArray, heights: FloatArray | None = None, *, hidden: bool = False) -> FloatArray:
    """Red, green, blue, (3,) of 255.

    The main colour is that of most pixels and heights. Of what a hand hides a part of, it is that of most heights: a
    hand hides the body and leaves the lid.

    Args:
        colours: Pixels of one thing, at least one, (n, 3) of 255.
        heights: Their heights, (n,) [m]; None where they are not known: pixels count alike.
        hidden: Whether a part of the thing is hidden.
    """
    step = max(len(colours) // MOST_PIXELS, 1)
    colours = colours[::step]
    weights = np.ones(len(colours))
    if heights is not None:
        share = 1.0 if hidden else BY_HEIGHT
        weights = (1.0 - share) * weights + share * height_weights(heights[::step])
    total = colours.sum(axis=1) + 1.0
    chroma = colours[:, :2] / total[:, None]
    typical = np.array([_median(chroma[:, 0], weights), _median(chroma[:, 1], weights)])
    off = np.abs(chroma - typical).sum(axis=1)
    bright = np.log((total + DARK) / (_median(total, weights) + DARK))
    main = (off < MAIN_COLOUR + CHROMA_NOISE / total) & (np.abs(bright) < np.log(SHADED))
    if weights[main].sum() < 0.2 * len(colours):
        main = np.ones(len(colours), dtype=bool)
    order = np.argsort(total[main])
    well_lit = colours[main][order[int(WELL_LIT * len(order)) :]]
    return np.asarray(np.sort(well_lit, axis=0)[len(well_lit) // 2])


def _median(values: FloatArray, weights: FloatArray) -> float:
    """Weighted median of values (n,)."""
    order = np.argsort(values)
    summed = np.cumsum(weights[order])
    return float(values[order[int(np.searchsorted(summed, 0.5 * summed[-1]))]])


def hsl_of(rgb: FloatArray) -> FloatArray:
    """Hue, saturation, lightness in 0..1 of colours (..., 3) of 255; grey has hue 0."""
    values = np.clip(np.asarray(rgb, dtype=float) / 255.0, 0.0, 1.0)
    high, low = values.max(axis=-1), values.min(axis=-1)
    span = high - low
    lightness = (high + low) / 2
    safe = np.where(span > 0, span, 1.0)
    room = 1.0 - np.abs(2 * lightness - 1.0)
    saturation = np.where(room > 0, span / np.where(room > 0, room, 1.0), 0.0)
    red, green, blue = np.moveaxis(values, -1, 0)
    hue = np.where(
        high == red,
        (green - blue) / safe % 6.0,
        np.where(high == green, (blue - red) / safe + 2.0, (red - green) / safe + 4.0),
    )
    hue = np.where(span > 0, hue / 6.0 % 1.0, 0.0)
    return np.stack((hue, np.clip(saturation, 0.0, 1.0), lightness), axis=-1)
