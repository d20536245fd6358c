from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from executor.errors import InputError
from executor.picture import check_suffix, save_film, save_strip, strip

VIEWS = [np.full((60, 80, 3), shade, dtype=np.uint8) for shade in (40, 200)]


def test_strip_keeps_the_views_as_they_are() -> None:
    image = np.asarray(strip(VIEWS, ["before", "after"], "put it there"))
    for shade in (40, 200):
        assert (image == shade).all(axis=2).sum() >= 60 * 80


def test_a_long_caption_wraps_instead_of_being_cut() -> None:
    short = strip(VIEWS, ["a", "b"], "one")
    long = strip(VIEWS, ["a", "b"], "one two three four five six seven eight nine ten eleven twelve thirteen")
    assert long.width == short.width
    assert long.height > short.height


def test_files_open_again(tmp_path: Path) -> None:
    save_strip(tmp_path / "a.png", VIEWS, ["before", "after"], "put it there")
    save_film(tmp_path / "a.gif", VIEWS * 2, "put it there", 0.1)
    assert Image.open(tmp_path / "a.png").size == strip(VIEWS, ["a", "b"], "put it there").size
    film = Image.open(tmp_path / "a.gif")
    assert getattr(film, "n_frames", 1) >= 2
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.gif", "a.png"]


def test_unknown_format_is_refused() -> None:
    with pytest.raises(InputError, match=r"a\.bmp: a picture's name ends in one of \.png"):
        check_suffix(Path("a.bmp"))
