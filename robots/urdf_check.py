"""Whether a URDF is a tree of links that physics and kinematics can work with: numbers, names, masses."""

import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from .errors import RobotError

MOVABLE = ("revolute", "prismatic", "continuous")
"""Kinds of joints that move."""
_SIZES = {"box": {"size": 3}, "cylinder": {"radius": 1, "length": 1}, "sphere": {"radius": 1}, "mesh": {}}
"""What each shape that can be collided with needs, and how many numbers of each."""


def check_urdf(root: ElementTree.Element, path: Path) -> None:
    """Check a URDF's links and joints, which readers drop or repair in silence.

    Raises:
        RobotError: Names file, link or joint, and value.
    """
    _check_tree(root, path)
    moved = set()
    for joint in root.findall("joint"):
        where = f"{path}: joint {joint.get('name')}"
        _check_origin(joint, where)
        if joint.get("type") not in (*MOVABLE, "fixed"):
            raise RobotError(f"{where}: type must be one of {', '.join(MOVABLE)}, fixed, got {joint.get('type')!r}")
        if joint.get("type") in MOVABLE:
            moved.add(end_of(joint, "child"))
            axis = joint.find("axis")
            if axis is not None and not any(_numbers(axis, "xyz", 3, where)):
                raise RobotError(f"{where}: axis must have a direction, got {axis.get('xyz')!r}")
    for link in root.findall("link"):
        where = f"{path}: link {link.get('name')}"
        _check_inertia(link, where, link.get("name", "") in moved)
        for element in link.findall("collision"):  # what is drawn, `visuals` checks
            _check_origin(element, f"{where}: collision")
            _check_shape(element.find("geometry"), f"{where}: collision")


def end_of(joint: ElementTree.Element, end: str) -> str:
    """Name of the link at one end of a joint, `parent` or `child`."""
    found = joint.find(end)
    return "" if found is None else found.get("link", "")


def _check_tree(root: ElementTree.Element, path: Path) -> None:
    """Names differ, joints join links that are there, and all links hang on one."""
    for kind in ("link", "joint"):
        names = [each.get("name", "") for each in root.findall(kind)]
        for name in names:
            if not name:
                raise RobotError(f"{path}: a {kind} has no name")
            if names.count(name) > 1:
                raise RobotError(f"{path}: {kind} {name}: there are {names.count(name)} of this name")
    links = [link.get("name", "") for link in root.findall("link")]
    carriers: dict[str, tuple[str, str]] = {}
    for joint in root.findall("joint"):
        for end in ("parent", "child"):
            if (link := end_of(joint, end)) not in links:
                name, known = joint.get("name", ""), ", ".join(links)
                raise RobotError(f"{path}: joint {name}: {end} link {link!r} is not in the file; it has {known}")
        child = end_of(joint, "child")
        if child in carriers:
            raise RobotError(f"{path}: link {child}: both {carriers[child][1]} and {joint.get('name')} carry it")
        carriers[child] = end_of(joint, "parent"), joint.get("name", "")
    roots = [link for link in links if link not in carriers]
    if len(roots) > 1:
        raise RobotError(f"{path}: all links must hang on one, but nothing carries {', '.join(roots)}")
    for link in links:
        above, seen = link, {link}
        while above in carriers:
            above = carriers[above][0]
            if above in seen:
                raise RobotError(f"{path}: link {link}: carries itself, through {', '.join(sorted(seen))}")
            seen.add(above)
    if not links:
        raise RobotError(f"{path}: it has no link")


def _check_origin(element: ElementTree.Element, where: str) -> None:
    origin = element.find("origin")
    for key in ("xyz", "rpy"):
        if origin is not None and origin.get(key) is not None:
            _numbers(origin, key, 3, where)


def _check_shape(geometry: ElementTree.Element | None, where: str) -> None:
    shapes = [] if geometry is None else list(_known(geometry))
    if len(shapes) != 1:
        raise RobotError(f"{where}: geometry must be one of {', '.join(_SIZES)}, got {len(shapes)} of them")
    shape = shapes[0]
    for key, count in _SIZES[shape.tag].items():
        if min(_numbers(shape, key, count, f"{where}: {shape.tag}")) <= 0:
            raise RobotError(f"{where}: {shape.tag}: {key} must be positive [m], got {shape.get(key)!r}")
    if shape.get("scale") is not None and not all(_numbers(shape, "scale", 3, f"{where}: {shape.tag}")):
        raise RobotError(f"{where}: {shape.tag}: scale may not be 0, got {shape.get('scale')!r}")


def _known(geometry: ElementTree.Element) -> Iterator[ElementTree.Element]:
    return (shape for shape in geometry if shape.tag in _SIZES)


def _numbers(element: ElementTree.Element, key: str, count: int, where: str) -> list[float]:
    """An attribute of finite numbers."""
    text = element.get(key, "")
    try:
        numbers = [float(part) for part in text.split()]
    except ValueError:
        numbers = []
    if len(numbers) != count or not all(map(math.isfinite, numbers)):
        many = "a finite number" if count == 1 else f"{count} finite numbers"
        raise RobotError(f"{where}: {key} must be {many}, got {text!r}")
    return numbers


def _check_inertia(link: ElementTree.Element, where: str, moves: bool) -> None:
    """Check that physics can work with a link's mass and inertia.

    A frame that is fixed to another link may weigh nothing; what a joint carries may not, and nothing weighs less.
    """
    inertial = link.find("inertial")
    if inertial is None:
        return
    _check_origin(inertial, where)
    values = {}
    for tag, keys in (("mass", ("value",)), ("inertia", ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))):
        element = inertial.find(tag)
        for key in keys:
            text = "0" if element is None else element.get(key, "0")
            try:
                values[key] = float(text)
            except ValueError as error:
                raise RobotError(f"{where}: {tag} {key} must be a number, got {text!r}") from error
            if not math.isfinite(values[key]):
                raise RobotError(f"{where}: {tag} {key} must be finite, got {text!r}")
    if values["value"] < 0 or (moves and values["value"] == 0):
        raise RobotError(f"{where}: mass must be positive, got {values['value']:g} kg")
    xx, yy, zz, xy, xz, yz = (values[key] for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
    moments = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    if moments[0] < -1e-12 or (moves and moments[0] <= 0):
        raise RobotError(
            f"{where}: the inertia's principal moments must be positive, "
            f"got {', '.join(f'{moment:.3g}' for moment in moments)} kg m²"
        )
