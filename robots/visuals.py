"""What a robot looks like: the triangles of its URDF's visuals, and where they are for given joint positions."""

import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin
import trimesh

from .errors import RobotError
from .kinematics import rotation_matrix, rpy_matrix, whole_model
from .meshes import DEFAULT_TRIANGLES, decimated, load, resolve
from .pose import FloatArray, Pose
from .triangle_mesh import TriangleMesh
from .urdf import read_urdf

_GREY = (0.8, 0.8, 0.8)
"""Colour of a visual for which neither the URDF nor the mesh names one."""


@dataclass(frozen=True, slots=True)
class Visual:
    """One visual of a link.

    Attributes:
        link: Name of the link.
        mesh: Triangles in the link's frame, every corner with its colour.
    """

    link: str
    mesh: TriangleMesh


class RobotVisuals:
    """The visuals of a URDF and their places. Not safe to share between threads.

    Meshes are decimated, with the colours of their own materials; the URDF's material colours primitives and meshes
    that have none, as RViz does. Visuals that are fully transparent are left out.

    Attributes:
        visuals: The visuals, N of them, in the order of the file.
        joint_names: The movable joints that `placements` knows.
    """

    def __init__(self, urdf_path: Path, triangles: int | None = DEFAULT_TRIANGLES) -> None:
        """Read the visuals.

        Args:
            urdf_path: The URDF.
            triangles: Triangles a mesh is thinned to; None draws meshes as they are.

        Raises:
            RobotError: The URDF cannot be read, or a mesh is missing or wrong; names file, link and what to do.
        """
        self._path = urdf_path
        self._urdf = read_urdf(urdf_path)
        self._model = whole_model(urdf_path)
        self._data = self._model.createData()
        self._neutral = pin.neutral(self._model)
        self.joint_names = tuple(self._urdf.joints)
        self.visuals = _read_visuals(urdf_path, triangles)
        self._frames = [self._model.getFrameId(visual.link, pin.FrameType.BODY) for visual in self.visuals]

    def placements(self, joint_positions: Mapping[str, float], pose_base_in_world: Pose) -> FloatArray:
        """Where every visual is.

        Args:
            joint_positions: Positions by joint name [rad or m]. A joint that is not named stands at its neutral
                position, or follows the named joint that it mimics.
            pose_base_in_world: Pose of the URDF's first link.

        Returns:
            Homogeneous transforms from the frame of each visual's link to the world, (N, 4, 4).

        Raises:
            RobotError: A joint is unknown or a position is not a finite number.
        """
        q = self._configuration(joint_positions)
        pin.framesForwardKinematics(self._model, self._data, q)
        base = np.eye(4)
        base[:3, :3] = rotation_matrix(pose_base_in_world.orientation_xyzw)
        base[:3, 3] = pose_base_in_world.position
        if not self._frames:
            return np.zeros((0, 4, 4))
        return np.asarray(base @ np.stack([self._data.oMf[frame].homogeneous for frame in self._frames]))

    def _configuration(self, positions: Mapping[str, float]) -> FloatArray:
        """Pinocchio's configuration (nq,) of joint positions by name."""
        named = dict(positions)
        for name, position in positions.items():
            if name not in self._urdf.joints:
                raise RobotError(f"{self._path}: no movable joint {name!r}; it has {', '.join(self.joint_names)}")
            if not np.isfinite(position):
                raise RobotError(f"{self._path}: joint {name}: position must be a finite number, got {position}")
        for joint in self._urdf.joints.values():
            if joint.mimic is not None and joint.name not in named and joint.mimic.source in named:
                named[joint.name] = joint.mimic.follow(named[joint.mimic.source])
        q = self._neutral.copy()
        for name, position in named.items():
            joint = self._model.joints[self._model.getJointId(name)]
            # A continuous joint is (cos, sin) in Pinocchio.
            q[joint.idx_q : joint.idx_q + joint.nq] = (
                (np.cos(position), np.sin(position)) if joint.nq == 2 else position
            )
        return np.asarray(q)


def _read_visuals(path: Path, triangles: int | None) -> tuple[Visual, ...]:
    """Read all visuals of a URDF, whose XML is known to be sound."""
    root = ElementTree.parse(path).getroot()
    palette = {
        material.get("name", ""): material.find("color")
        for material in root.iter("material")
        if material.find("color") is not None
    }
    found = []
    for link in root.findall("link"):
        name = link.get("name", "")
        where = f"{path}: link {name!r}: visual"
        for element in link.findall("visual"):
            material = element.find("material")
            colour = None
            if material is not None:
                own = material.find("color")
                colour = own if own is not None else palette.get(material.get("name", ""))
            rgba = None if colour is None else _numbers(colour, "rgba", 4, where)
            if rgba is not None and rgba[3] == 0.0:
                continue
            mesh = _shape(element, path, name, where, triangles)
            vertices = mesh.vertices
            origin = element.find("origin")
            if origin is not None:
                turn = rpy_matrix(_numbers(origin, "rpy", 3, where, (0.0, 0.0, 0.0)))
                vertices = vertices @ turn.T + _numbers(origin, "xyz", 3, where, (0.0, 0.0, 0.0))
            shade = np.tile(_GREY if rgba is None else rgba[:3], (len(vertices), 1))
            found.append(
                Visual(name, TriangleMesh(vertices, mesh.faces, shade if mesh.colours is None else mesh.colours))
            )
    return tuple(found)


def _shape(element: ElementTree.Element, path: Path, link: str, where: str, triangles: int | None) -> TriangleMesh:
    """Triangles of a visual's geometry, in the frame of the visual."""
    geometry = element.find("geometry")
    shape = None if geometry is None or len(geometry) == 0 else geometry[0]
    kind = "nothing" if shape is None else shape.tag
    if shape is not None and kind == "mesh":
        file = resolve(shape.get("filename", ""), path, link)
        mesh = load(file if triangles is None else decimated(file, triangles))
        return TriangleMesh(
            mesh.vertices * _numbers(shape, "scale", 3, where, (1.0, 1.0, 1.0)), mesh.faces, mesh.colours
        )
    if shape is not None and kind == "box":
        solid = trimesh.creation.box(_numbers(shape, "size", 3, where))
    elif shape is not None and kind in ("cylinder", "capsule"):
        radius, length = _numbers(shape, "radius", 1, where)[0], _numbers(shape, "length", 1, where)[0]
        around = 12 if radius < 0.01 else 32
        if kind == "cylinder":
            solid = trimesh.creation.cylinder(radius=radius, height=length, sections=around)
        else:
            solid = trimesh.creation.capsule(height=length, radius=radius, count=(around, around // 2))
    elif shape is not None and kind == "sphere":
        radius = _numbers(shape, "radius", 1, where)[0]
        solid = trimesh.creation.icosphere(subdivisions=1 if radius < 0.005 else 3, radius=radius)
    else:
        raise RobotError(f"{where}: geometry must be one of box, capsule, cylinder, mesh, sphere; got {kind}")
    return TriangleMesh(np.asarray(solid.vertices), np.asarray(solid.faces), None)


def _numbers(
    element: ElementTree.Element, key: str, count: int, where: str, default: tuple[float, ...] | None = None
) -> list[float]:
    """Read an attribute of `count` finite numbers.

    Raises:
        RobotError: It is missing without a default, or is something else.
    """
    text = element.get(key)
    if text is None and default is not None:
        return list(default)
    try:
        numbers = [float(part) for part in (text or "").split()]
    except ValueError:
        numbers = []
    if len(numbers) != count or not np.isfinite(numbers).all():
        raise RobotError(f"{where}: <{element.tag}> {key} must be {count} finite number(s), got {text!r}")
    return numbers
