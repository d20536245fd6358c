"""What we read from a URDF ourselves: movable joints with limits and mimicking, and the names of the links."""

import math
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

from .errors import RobotError


@dataclass(frozen=True, slots=True)
class Mimic:
    """A passive joint that follows a driven one: position = ratio * source position + offset [rad or m]."""

    joint: str
    source: str
    ratio: float
    offset: float


@dataclass(frozen=True, slots=True)
class UrdfJoint:
    """Limits of one movable joint: [rad] or [m], and per second; infinite where the URDF sets none."""

    name: str
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
    joints = {}
    for element in root.iter("joint"):
        if element.get("type") in ("revolute", "prismatic", "continuous"):
            joint = _read_joint(element, path)
            joints[joint.name] = joint
    return Urdf(joints, tuple(link.get("name", "") for link in root.iter("link")))


def _read_joint(element: ElementTree.Element, path: Path) -> UrdfJoint:
    """Read one movable joint."""
    name = element.get("name", "")

    def number(of: ElementTree.Element | None, key: str, default: float) -> float:
        text = None if of is None else of.get(key)
        if text is None:
            return default
        try:
            return float(text)
        except ValueError as error:
            raise RobotError(f"{path}: joint {name}: {key} must be a number, got {text!r}") from error

    limit = element.find("limit")
    bounded = element.get("type") != "continuous"
    mimic = element.find("mimic")
    return UrdfJoint(
        name=name,
        lower=number(limit, "lower", 0.0) if bounded else -math.inf,
        upper=number(limit, "upper", 0.0) if bounded else math.inf,
        velocity=number(limit, "velocity", math.inf),
        mimic=None
        if mimic is None
        else Mimic(name, mimic.get("joint", ""), number(mimic, "multiplier", 1.0), number(mimic, "offset", 0.0)),
    )
