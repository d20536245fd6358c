"""Meshes as convex hulls: one where that is true to the mesh, slices where it is not."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from robots import RobotError
from robots.hulls import CUTS, convex_pieces
from robots.meshes import resolve


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


def saved(mesh: trimesh.Trimesh, path: Path) -> Path:
    mesh.export(path)
    return path


def pieces_of(path: Path) -> list[trimesh.Trimesh]:
    return [trimesh.load_mesh(piece) for piece in convex_pieces(path)]


def outside(points: np.ndarray, hulls: list[trimesh.Trimesh]) -> float:
    """How far the worst of some points (n, 3) is outside of the hull nearest to it [m]; negative inside."""
    found = []
    for hull in hulls:
        offsets = np.einsum("ij,ij->i", hull.face_normals, hull.triangles[:, 0])
        found.append((np.atleast_2d(points) @ hull.face_normals.T - offsets).max(axis=1))
    return float(np.min(found, axis=0).max())


def u_shape() -> trimesh.Trimesh:
    """A floor of 0.6 m with a wall at each end: two thirds of its hull are empty."""
    parts = [trimesh.creation.box((0.6, 0.2, 0.05))]
    for x in (-0.275, 0.275):
        wall = trimesh.creation.box((0.05, 0.2, 0.3))
        wall.apply_translation((x, 0.0, 0.175))
        parts.append(wall)
    return trimesh.util.concatenate(parts)


@pytest.mark.parametrize(
    "mesh",
    [trimesh.creation.box((0.3, 0.1, 0.2)), trimesh.creation.icosphere(2, 0.1), trimesh.creation.cylinder(0.05, 0.3)],
    ids=["box", "sphere", "cylinder"],
)
def test_a_convex_mesh_is_one_hull_of_its_own_size(mesh: trimesh.Trimesh, tmp_path: Path) -> None:
    (hull,) = pieces_of(saved(mesh, tmp_path / "part.stl"))
    # STL files hold single precision.
    assert hull.volume == pytest.approx(mesh.volume, rel=1e-5)
    np.testing.assert_allclose(hull.bounds, mesh.bounds, atol=1e-6)


def test_a_hollow_mesh_is_sliced_into_hulls_that_cover_it_and_not_much_more(tmp_path: Path) -> None:
    mesh = u_shape()
    hulls = pieces_of(saved(mesh, tmp_path / "part.stl"))
    assert 1 < len(hulls) <= CUTS
    assert all(hull.is_convex for hull in hulls)
    # Files hold seven digits.
    assert outside(mesh.vertices, hulls) < 1e-6
    assert sum(hull.volume for hull in hulls) < 0.75 * mesh.convex_hull.volume
    # Between the walls there is room now, where the one hull is full.
    assert outside(np.array([0.0, 0.0, 0.2]), hulls) > 0.1
    assert outside(np.array([0.0, 0.0, 0.2]), [mesh.convex_hull]) < 0


def test_baxters_torso_is_sliced() -> None:
    name = "package://example-robot-data/robots/baxter_description/meshes/torso/base_link_collision.DAE"
    path = resolve(name, Path("baxter.urdf"), "torso")
    hulls = pieces_of(path)
    torso = trimesh.load_mesh(path)
    assert len(hulls) == CUTS
    assert outside(torso.vertices, hulls) < 1e-6
    assert sum(hull.volume for hull in hulls) < 0.8 * torso.convex_hull.volume


def test_pieces_are_made_once_and_anew_when_the_mesh_changes(tmp_path: Path) -> None:
    path = saved(u_shape(), tmp_path / "part.stl")
    pieces = convex_pieces(path)
    times = [piece.stat().st_mtime_ns for piece in pieces]
    assert convex_pieces(path) == pieces
    assert [piece.stat().st_mtime_ns for piece in pieces] == times
    saved(trimesh.creation.box((0.1, 0.1, 0.1)), path)
    (box,) = pieces_of(path)
    assert box.volume == pytest.approx(0.001, rel=1e-5)


def test_a_thin_plate_keeps_its_hull(tmp_path: Path) -> None:
    (plate,) = pieces_of(saved(trimesh.creation.box((0.3, 0.2, 0.00005)), tmp_path / "plate.stl"))
    assert plate.volume == pytest.approx(0.3 * 0.2 * 0.00005, rel=1e-3)


def test_flat_and_missing_meshes_are_refused(tmp_path: Path) -> None:
    flat = trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], [[0, 1, 2], [1, 3, 2]])
    with pytest.raises(RobotError, match=r"flat.stl: is flat: only a mesh with a volume can be collided with"):
        convex_pieces(saved(flat, tmp_path / "flat.stl"))
    with pytest.raises(RobotError, match=r"none.stl: cannot be read: No such file"):
        convex_pieces(tmp_path / "none.stl")
