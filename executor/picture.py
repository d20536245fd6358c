"""Pictures of what was done: a strip of views with a title each and the sentence below."""

import textwrap
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from executor.errors import InputError
from executor.files import written_whole

Picture = NDArray[np.uint8]
MARGIN = 12
"""Free space around views and text [pixels]."""
TEXT = 18
"""Height of letters [pixels]."""
SUFFIXES = (".png", ".jpg", ".jpeg", ".gif")
_INK = (35, 38, 44)
_PAPER = (250, 250, 248)


def check_suffix(path: Path) -> Path:
    """Return `path` if a picture can be written in its format.

    Raises:
        InputError: The suffix is none of `SUFFIXES`.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise InputError(f"{path}: a picture's name ends in one of {', '.join(SUFFIXES)}")
    return path


def strip(views: Sequence[Picture], titles: Sequence[str], caption: str) -> Image.Image:
    """Lay views side by side, each under its title, above a caption.

    Args:
        views: Pictures of equal size, (H, W, 3) uint8 each.
        titles: One for each view.
        caption: Text below, wrapped to the width.
    """
    height, width, _ = views[0].shape
    font = ImageFont.load_default(TEXT)
    total = len(views) * (width + MARGIN) + MARGIN
    lines = textwrap.wrap(caption, width=max(20, int((total - 2 * MARGIN) / (0.52 * TEXT)))) or [""]
    line_height = TEXT + 6
    below = MARGIN + line_height + height + MARGIN
    image = Image.new("RGB", (total, below + len(lines) * line_height + MARGIN), _PAPER)
    draw = ImageDraw.Draw(image)
    for index, (view, title) in enumerate(zip(views, titles, strict=True)):
        left = MARGIN + index * (width + MARGIN)
        draw.text((left, MARGIN), title, fill=_INK, font=font)
        image.paste(Image.fromarray(view), (left, MARGIN + line_height))
    for index, line in enumerate(lines):
        draw.text((MARGIN, below + index * line_height), line, fill=_INK, font=font)
    return image


def save_strip(path: Path, views: Sequence[Picture], titles: Sequence[str], caption: str) -> None:
    """Write a strip as a picture file."""
    with written_whole(check_suffix(path)) as temporary:
        strip(views, titles, caption).save(temporary)


def save_film(path: Path, views: Sequence[Picture], caption: str, seconds_each: float) -> None:
    """Write views as an animated GIF with a caption, the last one held for two seconds.

    Args:
        path: A `.gif` file.
        views: Pictures of equal size, (H, W, 3) uint8 each.
        caption: Text below.
        seconds_each: Time each view is shown [s].
    """
    frames = [strip([view], [""], caption).quantize(128) for view in views]
    times = [round(1000 * seconds_each)] * (len(frames) - 1) + [2000]
    with written_whole(path) as temporary:
        frames[0].save(temporary, save_all=True, append_images=frames[1:], duration=times, loop=0)
