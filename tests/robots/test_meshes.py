"""Meshes: found, read as they are, thinned without changing their look, cached whole."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh

from robots import RobotError
from robots.meshes import decimated, load, resolve, share_directories

BAXTER = "package://example-robot-data/robots/baxter_description"


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache of the test's own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache" / "showtell" / "meshes"


def baxter_mesh(name: str) -> Path:
    return resolve(f"{BAXTER}/meshes/{name}", Path("any.urdf"), "link")


@pytest.fixture
def ball(tmp_path: Path) -> Path:
    path = tmp_path / "ball.stl"
    trimesh.creation.icosphere(subdivisions=4, radius=0.1).export(path)
    return path


class TestResolve:
    def test_packages_are_found_where_pip_puts_them(self) -> None:
        assert baxter_mesh("head/H0.DAE").is_file()
        assert all(path.is_dir() for path in share_directories())

    def test_names_are_relative_to_the_urdf_or_absolute(self, tmp_path: Path, ball: Path) -> None:
        urdf = tmp_path / "robot.urdf"
        assert resolve("ball.stl", urdf, "arm") == ball
        assert resolve(str(ball), Path("/elsewhere/robot.urdf"), "arm") == ball
        assert resolve(f"file://{ball}", Path("/elsewhere/robot.urdf"), "arm") == ball

    def test_a_package_may_be_a_folder_above_the_urdf(self, tmp_path: Path) -> None:
        mesh = tmp_path / "my_robot" / "meshes" / "arm.stl"
        mesh.parent.mkdir(parents=True)
        mesh.touch()
        urdf = tmp_path / "my_robot" / "urdf" / "my_robot.urdf"
        assert resolve("package://my_robot/meshes/arm.stl", urdf, "arm").samefile(mesh)

    def test_ros_paths_count(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        mesh = tmp_path / "ws" / "share" / "their_robot" / "arm.stl"
        mesh.parent.mkdir(parents=True)
        mesh.touch()
        monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "ws"))
        assert resolve("package://their_robot/arm.stl", Path("/elsewhere/robot.urdf"), "arm") == mesh

    @pytest.mark.parametrize("name", ["package://nobody/arm.stl", "arm.stl", "/nowhere/arm.stl"])
    def test_a_missing_mesh_names_urdf_link_file_and_what_to_do(self, tmp_path: Path, name: str) -> None:
        urdf = tmp_path / "robot.urdf"
        with pytest.raises(RobotError, match=rf"robot\.urdf: link 'arm': mesh {name} is missing: .*(install|put)"):
            resolve(name, urdf, "arm")


class TestLoad:
    def test_a_collada_file_keeps_node_transforms_and_colours(self) -> None:
        import coal

        path = baxter_mesh("electric_gripper/fingers/half_round_tip.DAE")
        mesh = load(path)
        # Assimp, through coal, reads the same file in its own way; it keeps single precision.
        theirs = coal.MeshLoader().load(str(path), np.ones(3)).vertices()
        np.testing.assert_allclose(mesh.vertices.min(axis=0), theirs.min(axis=0), atol=1e-7)
        np.testing.assert_allclose(mesh.vertices.max(axis=0), theirs.max(axis=0), atol=1e-7)
        head = load(baxter_mesh("head/H1.DAE"))
        assert head.colours is not None
        # Red frame and black screen: diffuse 0.64 0 0 and 0 0 0 in the file, kept to one part in 255.
        np.testing.assert_allclose(np.unique(head.colours, axis=0), [[0, 0, 0], [0.64, 0, 0]], atol=1 / 255)

    def test_the_unit_of_a_collada_file_counts(self, tmp_path: Path) -> None:
        text = baxter_mesh("head/H1.DAE").read_text(encoding="utf-8")
        assert '<unit name="meter" meter="1"/>' in text
        small = tmp_path / "small.dae"
        small.write_text(text.replace('<unit name="meter" meter="1"/>', '<unit name="millimeter" meter="0.001"/>'))
        whole = load(baxter_mesh("head/H1.DAE"))
        # Trimesh goes through inches, rounded to eight digits.
        np.testing.assert_allclose(load(small).vertices, 0.001 * whole.vertices, rtol=1e-6)

    def test_arrays_are_read_only(self, ball: Path) -> None:
        mesh = load(ball)
        assert mesh.colours is None
        for array in (mesh.vertices, mesh.faces):
            with pytest.raises(ValueError, match="read-only"):
                array[0] = 0

    def test_what_is_no_mesh_is_refused(self, tmp_path: Path) -> None:
        for name, content, message in (
            ("broken.dae", "<COLLADA", "cannot be read as a mesh"),
            ("empty.obj", "v 0 0 0\n", "broken|cannot be read|no triangles"),
            ("strange.xyzzy", "hello", "cannot be read as a mesh"),
            ("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "not a finite number"),
        ):
            path = tmp_path / name
            path.write_text(content)
            with pytest.raises(RobotError, match=message) as caught:
                load(path)
            assert str(caught.value).startswith(str(path))
        with pytest.raises(RobotError, match="cannot be read"):
            load(tmp_path / "missing.obj")


class TestDecimated:
    def test_a_ball_stays_a_ball(self, ball: Path, cache: Path) -> None:
        path = decimated(ball, 700)
        mesh = load(path)
        assert path.parent == cache
        assert 600 <= len(mesh.faces) <= 700
        radius = np.linalg.norm(mesh.vertices, axis=1)
        # A sphere of 0.1 m in 700 triangles: the flat faces lie 0.7 mm inside, and corners make up for it.
        assert radius.min() > 0.099
        assert radius.max() < 0.101

    def test_colours_and_size_of_a_real_link_stay(self) -> None:
        path = baxter_mesh("upper_forearm/W0.DAE")
        original, thin = load(path), load(decimated(path))
        assert len(original.faces) > 20_000
        assert 600 <= len(thin.faces) <= 770
        assert original.colours is not None
        assert thin.colours is not None
        np.testing.assert_allclose(np.unique(thin.colours, axis=0), np.unique(original.colours, axis=0), atol=1e-6)
        # The link is 0.3 m long; 700 triangles keep its outline within 3 mm.
        np.testing.assert_allclose(thin.vertices.min(axis=0), original.vertices.min(axis=0), atol=3e-3)
        np.testing.assert_allclose(thin.vertices.max(axis=0), original.vertices.max(axis=0), atol=3e-3)

    def test_a_mesh_that_crosses_itself_is_thinned_too(self) -> None:
        thin = load(decimated(baxter_mesh("electric_gripper/fingers/basic_hard_tip.DAE"), 700))
        assert len(thin.faces) <= 770

    def test_a_mesh_of_many_colours_is_thinned_as_one(self) -> None:
        path = baxter_mesh("electric_gripper/electric_gripper_w_fingers.DAE")
        original, thin = load(path), load(decimated(path, 700))
        assert len(thin.faces) <= 770
        assert original.colours is not None
        assert thin.colours is not None
        # Seven digits are written.
        ours = {tuple(row) for row in np.round(thin.colours, 5)}
        assert ours <= {tuple(row) for row in np.round(original.colours, 5)}

    def test_it_is_made_once_and_named_after_its_content(self, ball: Path, cache: Path) -> None:
        first = decimated(ball, 100)
        written = first.stat().st_mtime_ns
        assert decimated(ball, 100) == first
        assert first.stat().st_mtime_ns == written
        assert decimated(first, 100) == first, "one of ours is not thinned again"
        assert decimated(ball, 120) != first
        trimesh.creation.icosphere(subdivisions=3, radius=0.1).export(ball)
        assert decimated(ball, 100) != first
        assert not list(cache.glob("tmp*")), "a temporary file was left"

    def test_a_cache_that_cannot_be_written_is_done_without(
        self, ball: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        (tmp_path / "file").touch()
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
        path = decimated(ball, 100)
        assert path.is_file()
        assert decimated(ball, 100) == path

    def test_processes_make_the_same_file_at_once(self, ball: Path, cache: Path) -> None:
        code = (
            f"from robots.meshes import decimated; from pathlib import Path; print(decimated(Path({str(ball)!r}), 90))"
        )
        environment = {**os.environ, "PYTHONPATH": str(Path(__file__).resolve().parents[2])}
        running = [
            subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, env=environment)
            for _ in range(2)
        ]
        paths = {process.communicate(timeout=60)[0].strip() for process in running}
        assert [process.returncode for process in running] == [0, 0]
        assert paths == {str(path) for path in cache.iterdir()}

    def test_too_few_triangles_are_refused(self, ball: Path) -> None:
        with pytest.raises(RobotError, match="at least 12 triangles, got 11"):
            decimated(ball, 11)
        with pytest.raises(RobotError, match="cannot be read"):
            decimated(ball.with_name("missing.stl"))
