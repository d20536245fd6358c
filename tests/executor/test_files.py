from pathlib import Path

import pytest

from executor.errors import InputError
from executor.files import check_place, existing, new_folder, written_whole


def test_a_failed_run_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "k.json"
    path.write_text("old")
    with pytest.raises(RuntimeError, match="half way"), written_whole(path) as temporary:
        temporary.write_text("ne")
        raise RuntimeError("half way")
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_good_run_replaces_it_and_keeps_the_suffix(tmp_path: Path) -> None:
    path = tmp_path / "k.json"
    path.write_text("old")
    with written_whole(path) as temporary:
        assert temporary.suffix == ".json"
        temporary.write_text("new")
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"the folder .*nowhere for k\.json does not exist"):
        check_place(tmp_path / "nowhere" / "k.json")
    with pytest.raises(InputError, match="is a folder; name a file"):
        check_place(tmp_path)


def test_existing_and_new_folder(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"x\.mcap: no such demo"):
        existing(tmp_path / "x.mcap", "demo")
    assert new_folder(tmp_path / "a" / "b").is_dir()
    (tmp_path / "f").touch()
    with pytest.raises(InputError, match="is a file; name a folder"):
        new_folder(tmp_path / "f")
