"""The meshes that a URDF names: finding the files, reading them, and light copies that draw fast.

The Baxter of example-robot-data has 410,000 triangles; at 700 a mesh it has 18,000 and stays within a few
millimetres of itself. Decimated copies are kept in the user's cache directory, named after the content they were made
from.
"""

import hashlib
import os
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray

from .cache import own_folder, user_folder, write_whole
from .errors import RobotError
from .pose import FloatArray
from .triangle_mesh import FEWEST_TRIANGLES, TriangleMesh, decimate

DEFAULT_TRIANGLES = 700
"""Triangles that a decimated mesh may have: enough for a link that is seen from half a metre."""

_FORMAT = 2
"""Part of the cache's file names; another number when the files are made differently."""


def share_directories() -> tuple[Path, ...]:
    """Directories in which installed packages of robot data may lie, such as that of example-robot-data."""
    prefixes = [Path(entry) / "cmeel.prefix" for entry in sys.path if entry]
    found = [prefix / "share" for prefix in (*prefixes, Path(sys.prefix))]
    for variable in ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"):
        for entry in filter(None, os.environ.get(variable, "").split(os.pathsep)):
            found += [Path(entry), Path(entry) / "share"]
    return tuple(path for path in dict.fromkeys(found) if path.is_dir())


def resolve(filename: str, urdf: Path, link: str) -> Path:
    """Find the file that a URDF's `<mesh filename=...>` means; see `find`.

    Args:
        filename: What the URDF says.
        urdf: The URDF.
        link: The link that has the mesh, for the message.

    Raises:
        RobotError: There is no such file; names URDF, link, file and where it was looked for.
    """
    return find(filename, urdf, f"link {link!r}: mesh")


def find(filename: str, beside: Path, what: str) -> Path:
    """Find the file that another one names.

    `package://name/rest` is looked for in the installed packages' share directories, those of ROS where its environment
    is set, and the folders above the naming file; other names are absolute or relative to it.

    Args:
        filename: The name.
        beside: The file that names it.
        what: What is named, for the message.

    Raises:
        RobotError: There is no such file; names both files and where it was looked for.
    """
    if filename.startswith("package://"):
        rest = filename.removeprefix("package://")
        name = rest.partition("/")[0]
        above = beside.resolve().parents
        candidates = [directory / rest for directory in (*share_directories(), *above)]
        candidates += [folder.parent / rest for folder in above if folder.name == name]
        advice = f"install the package {name!r} (robots of the field: pip install example-robot-data) or put its folder"
        advice += f" beside this file; looked in {', '.join(map(str, share_directories()))} and the folders above it"
    else:
        candidates = [beside.parent / filename.removeprefix("file://")]
        advice = "put the file there or correct the name"
    for candidate in candidates:
        if candidate.is_file():
            return candidate
    raise RobotError(f"{beside}: {what} {filename} is missing: {advice}")


def load(path: Path) -> TriangleMesh:
    """Read a mesh file (DAE, STL, OBJ, PLY …) with its node transforms, unit and material colours.

    The up axis that a COLLADA file names is ignored, as ROS does: Baxter's torso says y and means z.

    Raises:
        RobotError: The file cannot be read as a mesh, or has no triangles.
    """
    try:
        scene = trimesh.load_scene(path, process=False, maintain_order=True)
    except OSError as error:
        raise RobotError(f"{path}: cannot be read: {error.strerror}") from error
    except Exception as error:  # Each reader under trimesh raises what it likes.
        raise RobotError(f"{path}: cannot be read as a mesh: {error or type(error).__name__}") from error
    vertices: list[FloatArray] = []
    faces: list[NDArray[np.int64]] = []
    colours: list[FloatArray | None] = []
    count = 0
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        part = scene.geometry[name]
        if not isinstance(part, trimesh.Trimesh) or not len(part.faces):
            continue
        vertices.append(trimesh.transform_points(part.vertices, transform))
        faces.append(np.asarray(part.faces) + count)
        colours.append(_part_colours(part))
        count += len(part.vertices)
    if not faces:
        raise RobotError(f"{path}: has no triangles; export it as a triangle mesh")
    points = np.concatenate(vertices)
    if path.suffix.lower() == ".dae" and scene.units is not None:
        points *= trimesh.units.unit_conversion(scene.units, "meters")
    if not np.isfinite(points).all():
        raise RobotError(f"{path}: a corner is not a finite number; export the mesh again")
    known = [colour for colour in colours if colour is not None]
    # A part without a material among parts with one is drawn light grey, as viewers do.
    grey = [np.full((len(v), 3), 0.8) if c is None else c for v, c in zip(vertices, colours, strict=True)]
    return TriangleMesh(points, np.concatenate(faces).astype(np.int32), np.concatenate(grey) if known else None)


def _part_colours(part: trimesh.Trimesh) -> FloatArray | None:
    """Colours (n, 3) of one part's corners, None where it has neither a material nor colours."""
    visual = part.visual
    if visual is None or not visual.defined:
        return None
    if isinstance(visual, trimesh.visual.TextureVisuals):
        return np.tile(np.asarray(visual.material.main_color[:3]) / 255.0, (len(part.vertices), 1))
    return np.asarray(visual.vertex_colors)[:, :3] / 255.0


def decimated(path: Path, triangles: int = DEFAULT_TRIANGLES) -> Path:
    """A copy of a mesh with at most about `triangles` triangles, as an OBJ file with colours at the corners.

    Made once and kept in `$XDG_CACHE_HOME/showtell/meshes` (`~/.cache` without the variable), or in a directory of this
    process where that cannot be written. Safe with several processes: each file appears whole.

    Args:
        path: Mesh file.
        triangles: Triangles to keep, shared out among the colours of the mesh.

    Returns:
        The OBJ file.

    Raises:
        RobotError: The mesh cannot be read, or fewer than 12 triangles are asked for.
    """
    if triangles < FEWEST_TRIANGLES:
        raise RobotError(f"{path}: a decimated mesh needs at least {FEWEST_TRIANGLES} triangles, got {triangles}")
    if path.parent in _cache_directories() and path.stem.endswith(f"-{triangles}"):
        return path  # one of ours already
    return kept(path, str(triangles), lambda: decimate(load(path), triangles))


def kept(path: Path, what: str, make: Callable[[], TriangleMesh]) -> Path:
    """What was made of a mesh file, from the cache, or made now and kept there as an OBJ file.

    Args:
        path: The mesh file.
        what: Name of what is made of it, and all that it depends on besides the file.
        make: Makes it.

    Raises:
        RobotError: The file cannot be read.
    """
    digest = hashlib.sha256(f"{_FORMAT}|{what}|{path.suffix.lower()}|".encode())
    for part in (path, path.with_suffix(".mtl")):
        try:
            digest.update(part.read_bytes())
        except OSError as error:
            if part == path:
                raise RobotError(f"{path}: cannot be read: {error.strerror}") from error
    name = f"{digest.hexdigest()[:32]}-{what}.obj"
    for directory in _cache_directories():
        if (directory / name).is_file():
            return directory / name
    mesh = make()
    try:
        return _write(mesh, _cache_directories()[0] / name)
    except OSError:
        return _write(mesh, own_folder("meshes") / name)


def _cache_directories() -> tuple[Path, ...]:
    """Where decimated meshes are kept: the user's cache, and this process's own directory if it already has one."""
    own = (own_folder("meshes"),) if own_folder.cache_info().currsize else ()
    return (user_folder("meshes"), *own)


def _write(mesh: TriangleMesh, path: Path) -> Path:
    """Write an OBJ file that appears whole or not at all, and return its path."""
    rows = mesh.vertices if mesh.colours is None else np.hstack((mesh.vertices, mesh.colours))
    lines = ["v " + " ".join(f"{value:.7g}" for value in row) for row in rows.tolist()]
    lines += ["f {} {} {}".format(*face) for face in (mesh.faces + 1).tolist()]
    return write_whole(path, "\n".join(lines) + "\n")
