"""The URDF as it is used: meshes found and decimated, fingers mounted as `robot.toml` says.

PyBullet reads neither `package://` in a file that was moved nor 400,000 triangles quickly. What is prepared lies in the
user's cache and is made once; a URDF that needs nothing is used where it is.
"""

import hashlib
import xml.etree.ElementTree as ElementTree
from copy import deepcopy
from pathlib import Path

import numpy as np

from .cache import own_folder, user_folder, write_whole
from .errors import RobotError
from .hulls import convex_pieces
from .kinematics import rpy_matrix
from .meshes import DEFAULT_TRIANGLES, decimated, find, resolve
from .robot_file import RobotFile
from .urdf import read_urdf

BYTES_A_TRIANGLE = 2500
"""Size of a mesh file for which one triangle is kept."""


def prepare_urdf(folder: Path, spec: RobotFile) -> Path:
    """Give the URDF to use for a robot file.

    Raises:
        RobotError: The URDF is missing or wrong, or one of its meshes is; names file, link and mesh.
    """
    named = folder / spec.urdf
    source = find(spec.urdf, folder / "robot.toml", "urdf:") if spec.urdf.startswith("package://") else named
    read_urdf(source)  # what is wrong is told of the user's file, not of our copy
    root = ElementTree.parse(source).getroot()
    # Every one is asked: `or` would stop at the first that changed something.
    changed = [_find_meshes(root, source), _mount_fingers(root, source, spec)]
    if not any(changed):
        return source
    for link in root.findall("link"):
        if link.find("inertial") is None:
            # PyBullet would give it 1 kg.
            inertial = ElementTree.SubElement(link, "inertial")
            ElementTree.SubElement(inertial, "mass", value="1e-6")
            moments = {"ixx": "1e-9", "iyy": "1e-9", "izz": "1e-9", "ixy": "0", "ixz": "0", "iyz": "0"}
            ElementTree.SubElement(inertial, "inertia", moments)
    text = ElementTree.tostring(root, encoding="unicode")
    name = f"{spec.name}-{hashlib.sha256(text.encode()).hexdigest()[:16]}.urdf"
    for kept_in in (user_folder, own_folder):
        try:
            path = kept_in("robots") / name
            return path if path.is_file() else write_whole(path, text)
        except OSError:
            continue
    raise RobotError(f"{source}: no folder can be written to keep the prepared URDF in: set XDG_CACHE_HOME to one")


def _find_meshes(root: ElementTree.Element, source: Path) -> bool:
    """Point every drawn mesh at its decimated copy and put convex hulls in the place of those that are collided with.

    Returns whether there is any.
    """
    found = False
    for link in root.findall("link"):
        name = link.get("name", "")
        for kind in ("visual", "collision"):
            for element in link.findall(kind):
                mesh = element.find("geometry/mesh")
                if mesh is None:
                    continue
                found = True
                file = resolve(mesh.get("filename", ""), source, name)
                if kind == "visual":
                    mesh.set("filename", str(decimated(file, _triangles(file))))
                    continue
                for piece in convex_pieces(file):
                    mesh.set("filename", str(piece))
                    link.append(deepcopy(element))
                link.remove(element)
    return found


def _triangles(mesh: Path) -> int:
    """Triangles worth drawing of a mesh: more of a large file, such as Baxter's pedestal with all its castors."""
    return max(DEFAULT_TRIANGLES, min(3000, mesh.stat().st_size // BYTES_A_TRIANGLE))


def _mount_fingers(root: ElementTree.Element, source: Path, spec: RobotFile) -> bool:
    """Shift each finger's carriage outwards. Returns whether any is."""
    joints = {joint.get("name"): joint for joint in root.findall("joint")}
    shifted = False
    for arm in spec.arms:
        gripper = arm.gripper
        if gripper.mounting == 0.0:
            continue
        closed = gripper.closed or (0.0, 0.0)
        opened = gripper.open or (1.0, 1.0)
        for index, name in enumerate(gripper.joints):
            joint = joints.get(name)
            if joint is None:
                continue  # told by the check against the URDF
            if joint.get("type") != "prismatic":
                raise RobotError(f"{source}: joint {name}: only fingers that slide can be mounted elsewhere")
            origin = joint.find("origin")
            if origin is None:
                origin = ElementTree.SubElement(joint, "origin")
            axis = joint.find("axis")
            along = np.array(_numbers("1 0 0" if axis is None else axis.get("xyz", "1 0 0")))
            outwards = np.sign(opened[index] - closed[index]) * along / np.linalg.norm(along)
            turned = rpy_matrix(_numbers(origin.get("rpy", "0 0 0"))) @ outwards
            place = np.array(_numbers(origin.get("xyz", "0 0 0"))) + gripper.mounting * turned
            origin.set("xyz", " ".join(f"{value:.9g}" for value in place))
            shifted = True
    return shifted


def _numbers(text: str) -> list[float]:
    return [float(part) for part in text.split()]
