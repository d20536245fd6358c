"""What we read from a URDF ourselves: movable joints and links."""

import math
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

from .errors import RobotError
from .urdf_check import MOVABLE, check_urdf, end_of


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
    """Movable joints by name in file order, all link names, and the link that carries each but the root."""

    joints: dict[str, UrdfJoint]
    links: tuple[str, ...]
    parents: dict[str, str]


def read_urdf(path: Path) -> Urdf:
    """Read joints and links of a URDF.

    Raises:
        RobotError: The file is missing, is not XML, or is wrong; names file, joint or link, and value.
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
    check_urdf(root, path)
    joints = {
        joint.name: joint
        for joint in (_read_joint(each, path) for each in root.findall("joint") if each.get("type") in MOVABLE)
    }
    for joint in joints.values():
        if joint.mimic is not None and joint.mimic.source not in joints:
            raise RobotError(f"{path}: joint {joint.name}: mimics {joint.mimic.source!r}, which is no movable joint")
    parents = {end_of(each, "child"): end_of(each, "parent") for each in root.findall("joint")}
    return Urdf(joints, links, parents)


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
    return UrdfJoint(name, end_of(element, "child"), lower, upper, number(limit, "velocity", math.inf), followed)
