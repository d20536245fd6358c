"""What we read from a URDF ourselves: movable joints, links, and whether physics can work with it."""

import math
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .errors import RobotError


@dataclass(frozen=True, slots=True)
class Mimic:
    """A passive joint that follows a driven one: position = ratio * source position + offset [rad or m].

    It stops at its own limits: the tips of a hand whose fingers press on a palm follow only part of the way.
    """

    joint: str
    source: str
    ratio: float
    offset: float
    lower: float = -math.inf
    upper: float = math.inf

    def follow(self, source_position: float) -> float:
        """Position when the driven joint is at a position."""
        return min(max(self.ratio * source_position + self.offset, self.lower), self.upper)


@dataclass(frozen=True, slots=True)
class UrdfJoint:
    """The link that a movable joint carries, and its limits [rad or m, and per s]; infinite where there is none."""

    name: str
    child: str
    lower: float
    upper: float
    velocity: float
    mimic: Mimic | None


@dataclass(frozen=True, slots=True)
class Urdf:
    """Movable joints by name in file order, and all link names."""

    joints: dict[str, UrdfJoint]
    links: tuple[str, ...]


def read_urdf(path: Path) -> Urdf:
    """Read joints and links of a URDF.

    Raises:
        RobotError: The file is missing, is not XML, or a number is not one; names file and joint.
    """
    try:
        root = ElementTree.parse(path).getroot()
    except OSError as error:
        raise RobotError(f"{path}: cannot be read: {error.strerror}") from error
    except ElementTree.ParseError as error:
        raise RobotError(f"{path}: not valid XML: {error}") from error
    if root.tag != "robot":
        raise RobotError(f"{path}: the outermost element must be <robot>, got <{root.tag}>")
    links = tuple(link.get("name", "") for link in root.findall("link"))
    joints = {}
    carried = set()
    for element in root.findall("joint"):
        for end in ("parent", "child"):
            if (link := _child_text(element, end)) not in links:
                raise RobotError(
                    f"{path}: joint {element.get('name')}: {end} link {link!r} is not in the file; "
                    f"it has {', '.join(links)}"
                )
        if element.get("type") in ("revolute", "prismatic", "continuous"):
            joint = _read_joint(element, path)
            joints[joint.name] = joint
            carried.add(_child_text(element, "child"))
    for joint in joints.values():
        if joint.mimic is not None and joint.mimic.source not in joints:
            raise RobotError(f"{path}: joint {joint.name}: mimics {joint.mimic.source!r}, which is no movable joint")
    for body in root.findall("link"):
        _check_inertia(body, path, body.get("name", "") in carried)
    return Urdf(joints, links)


def _child_text(joint: ElementTree.Element, end: str) -> str:
    """Name of the link at one end of a joint."""
    found = joint.find(end)
    return "" if found is None else found.get("link", "")


def _check_inertia(link: ElementTree.Element, path: Path, moves: bool) -> None:
    """Check that physics can work with a link's mass and inertia.

    A frame that is fixed to another link may weigh nothing; what a joint carries may not, and nothing weighs less.

    Raises:
        RobotError: Names file, link and value.
    """
    name = link.get("name", "")
    inertial = link.find("inertial")
    if inertial is None:
        return
    values = {}
    for tag, keys in (("mass", ("value",)), ("inertia", ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))):
        element = inertial.find(tag)
        for key in keys:
            text = "0" if element is None else element.get(key, "0")
            try:
                values[key] = float(text)
            except ValueError as error:
                raise RobotError(f"{path}: link {name}: {key} must be a number, got {text!r}") from error
            if not math.isfinite(values[key]):
                raise RobotError(f"{path}: link {name}: {key} must be finite, got {text!r}")
    if values["value"] < 0 or (moves and values["value"] == 0):
        raise RobotError(f"{path}: link {name}: mass must be positive, got {values['value']:g} kg")
    xx, yy, zz, xy, xz, yz = (values[key] for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
    moments = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    if moments[0] < -1e-12 or (moves and moments[0] <= 0):
        raise RobotError(
            f"{path}: link {name}: the inertia's principal moments must be positive, "
            f"got {', '.join(f'{moment:.3g}' for moment in moments)} kg m²"
        )


def _read_joint(element: ElementTree.Element, path: Path) -> UrdfJoint:
    """Read one movable joint."""
    name = element.get("name", "")

    def number(of: ElementTree.Element | None, key: str, default: float) -> float:
        text = None if of is None else of.get(key)
        if text is None:
            return default
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if math.isnan(value):
            raise RobotError(f"{path}: joint {name}: {key} must be a number, got {text!r}")
        return value

    limit = element.find("limit")
    bounded = element.get("type") != "continuous"
    lower = number(limit, "lower", 0.0) if bounded else -math.inf
    upper = number(limit, "upper", 0.0) if bounded else math.inf
    if lower > upper:
        raise RobotError(f"{path}: joint {name}: lower limit {lower:g} is above the upper one {upper:g}")
    mimic = element.find("mimic")
    followed = None
    if mimic is not None:
        ratio, offset = number(mimic, "multiplier", 1.0), number(mimic, "offset", 0.0)
        followed = Mimic(name, mimic.get("joint", ""), ratio, offset, lower, upper)
    return UrdfJoint(name, _child_text(element, "child"), lower, upper, number(limit, "velocity", math.inf), followed)
