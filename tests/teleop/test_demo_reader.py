import random
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.writer import Writer

from teleop import Demo, DemoError, IncompleteDemoWarning, is_whole, load_demo, load_demos

SHARED_FILES = [HealthCheck.function_scoped_fixture]
"""The files that examples share are written anew by each of them."""


def load_quietly(path: Path) -> Demo:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", IncompleteDemoWarning)
        return load_demo(path)


@settings(deadline=None, max_examples=60, suppress_health_check=SHARED_FILES)
@given(where=st.floats(0.0, 1.0, exclude_max=True))
def test_a_file_cut_anywhere_is_recovered_or_refused(
    where: float, demo_bytes: bytes, small_demo: Demo, tmp_path: Path
) -> None:
    path = tmp_path / "cut.mcap"
    path.write_bytes(demo_bytes[: int(where * len(demo_bytes))])
    try:
        cut = load_quietly(path)
    except DemoError as error:
        assert str(error).startswith(f"{path}: ")
        assert "\n" not in str(error)
        return
    assert not cut.complete
    count, moments = len(cut.inputs), len(cut.times)
    assert cut.scene == small_demo.scene
    np.testing.assert_array_equal(cut.inputs.axes, small_demo.inputs.axes[:count])
    np.testing.assert_array_equal(cut.states.object_positions, small_demo.states.object_positions[:moments])


def test_a_cut_loses_no_whole_chunk(demo_bytes: bytes, small_demo: Demo, tmp_path: Path) -> None:
    path = tmp_path / "nearly.mcap"
    path.write_bytes(demo_bytes[:-1])
    with pytest.warns(IncompleteDemoWarning, match=r"nearly\.mcap: ends early; recovered"):
        demo = load_demo(path)
    assert (is_whole(small_demo.path), is_whole(path), is_whole(tmp_path)) == (True, False, False)
    assert len(demo.inputs) == len(small_demo.inputs)
    assert demo.utterances == small_demo.utterances


@settings(deadline=None, max_examples=40, suppress_health_check=SHARED_FILES)
@given(seed=st.integers(0, 2**32 - 1))
def test_damage_anywhere_never_ends_in_a_traceback(seed: int, demo_bytes: bytes, tmp_path: Path) -> None:
    draw = random.Random(seed)
    damaged = bytearray(demo_bytes)
    for _ in range(draw.randint(1, 20)):
        damaged[draw.randrange(len(damaged))] = draw.randrange(256)
    path = tmp_path / "damaged.mcap"
    path.write_bytes(bytes(damaged))
    try:
        demo = load_quietly(path)
    except DemoError as error:
        assert str(path) in str(error)
        assert "\n" not in str(error)
    else:
        assert len(demo.times) > 0


def test_arrays_are_read_only(small_demo: Demo) -> None:
    for track in (small_demo.states, small_demo.inputs, small_demo.commands):
        for name in track.__slots__:
            values = getattr(track, name)
            if isinstance(values, np.ndarray):
                with pytest.raises(ValueError, match="read-only"):
                    values[...] = 0


def test_what_is_not_a_demo_is_refused_with_its_name(tmp_path: Path) -> None:
    empty, text, other = tmp_path / "empty.mcap", tmp_path / "text.mcap", tmp_path / "other.mcap"
    empty.write_bytes(b"")
    text.write_text("hello")
    with other.open("wb") as file:
        writer = Writer(file)
        writer.start()
        writer.finish()
    for path, why in ((empty, "it is empty"), (text, "not an MCAP file"), (other, "Showtell did not record")):
        with pytest.raises(DemoError, match=rf"^.*{path.name}: not a demo: .*{why}"):
            load_demo(path)
    with pytest.raises(DemoError, match=r"missing\.mcap: cannot be read: No such file"):
        load_demo(tmp_path / "missing.mcap")


def test_another_format_is_named(tmp_path: Path) -> None:
    path = tmp_path / "future.mcap"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        writer.add_metadata("showtell", {"format": "99"})
        writer.finish()
    with pytest.raises(DemoError, match=r"recorded in demo format '99', this version reads '1'"):
        load_demo(path)


def test_a_directory_is_read_in_order_of_names(demo_bytes: bytes, tmp_path: Path) -> None:
    for name in ("b.mcap", "a.mcap", "a.truth.json", "c.partial"):
        (tmp_path / name).write_bytes(demo_bytes)
    assert [demo.path.name for demo in load_demos(tmp_path)] == ["a.mcap", "b.mcap"]


def test_a_directory_without_demos_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DemoError, match="holds no demo"):
        load_demos(tmp_path)
    with pytest.raises(DemoError, match="not a directory of demos"):
        load_demos(tmp_path / "nowhere")
