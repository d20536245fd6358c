"""The questions of `showtell bench kinematics`: reachable targets of an arm, and who judges the answers."""

import copy
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from executor.errors import InputError
from robots.arm_model import ArmModel
from robots.kinematics import Kinematics, quaternion_xyzw, rotation_matrix
from robots.model import RobotModel
from robots.pose import FloatArray, Pose

POSITION_TOLERANCE = 1e-4
ORIENTATION_TOLERANCE = 1e-3
MAX_RESTARTS = 20
_LIMIT_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True)
class ArmQuestion:
    """An arm and what all solvers are told about it.

    Attributes:
        arm: The arm.
        kinematics: Its forward kinematics in the base frame: the judge.
        whole_pose: Whether orientation is asked for: the arm has six joints or more.
        lower: Lower joint limits, (n,) [rad or m], -π where a joint turns for ever.
        upper: Upper joint limits, (n,).
        endless: Whether each joint turns for ever, (n,).
        chain_urdf: A URDF with nothing but the arm's driven joints between the base and `chain_tip`: other solvers are
            faster with it, and know no joints that mimic others.
        chain_tip: The link whose pose they are asked for.
        offset_in_base: From that link to the tool, (3,) [m]; not zero only where passive joints keep the tool upright,
            which makes it constant.
    """

    arm: ArmModel
    kinematics: Kinematics
    whole_pose: bool
    lower: FloatArray
    upper: FloatArray
    endless: tuple[bool, ...]
    chain_urdf: Path
    chain_tip: str
    offset_in_base: FloatArray

    def postures(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Random postures inside the limits, (count, n)."""
        return np.asarray(self.lower + rng.random((count, self.lower.size)) * (self.upper - self.lower))

    def targets(self, rng: np.random.Generator, count: int) -> list[Pose]:
        """Tool poses in the base frame of random postures."""
        found = []
        for q in self.postures(rng, count):
            rotation, position = self.kinematics.placement(q)
            found.append(Pose(position, quaternion_xyzw(rotation)))
        return found

    def solved(self, q: FloatArray | None, target: Pose) -> bool:
        """Whether a posture (n,) is inside the limits and brings the tool to the target within the tolerances."""
        if q is None or np.any(q < self.arm.lower - _LIMIT_ROUNDING) or np.any(q > self.arm.upper + _LIMIT_ROUNDING):
            return False
        rotation, position = self.kinematics.placement(q)
        if np.linalg.norm(position - target.position) > POSITION_TOLERANCE:
            return False
        cosine = 0.5 * (np.trace(rotation_matrix(target.orientation_xyzw) @ rotation.T) - 1.0)
        return not self.whole_pose or bool(np.arccos(np.clip(cosine, -1.0, 1.0)) <= ORIENTATION_TOLERANCE)


def arm_question(robot: RobotModel, arm: ArmModel, folder: Path) -> ArmQuestion:
    """Prepare an arm of a robot; the chain's URDF is written into a folder.

    Raises:
        InputError: The arm's passive joints do not keep the tool upright, so that its chain cannot be given to others.
    """
    kinematics = Kinematics(robot.urdf_path, arm.joint_names, arm.mimic, arm.tool_frame)
    endless = ~np.isfinite(arm.lower) & ~np.isfinite(arm.upper)
    root = ElementTree.parse(robot.urdf_path).getroot()
    carriers = {_link(joint, "child"): joint for joint in root.findall("joint")}
    path: list[ElementTree.Element] = []
    link = arm.tool_frame
    while link in carriers:
        path.insert(0, carriers[link])
        link = _link(carriers[link], "parent")
    passive = {each.joint for each in arm.mimic}
    # The first passive joint is kept, fixed: its origin is where the offset to the upright tool begins.
    first = next((index for index, joint in enumerate(path) if joint.get("name") in passive), len(path))
    shortened = path[: first + 1]
    tip = _link(shortened[-1], "child")
    urdf = folder / f"{robot.name}_{arm.name}.urdf"
    urdf.write_text(_chain_text(link, shortened, arm.joint_names), encoding="utf-8")
    lower, upper = np.where(endless, -np.pi, arm.lower), np.where(endless, np.pi, arm.upper)
    offset = np.zeros(3)
    if tip != arm.tool_frame:
        shorter = Kinematics(urdf, arm.joint_names, (), tip)
        draws = lower + np.random.default_rng(0).random((20, lower.size)) * (upper - lower)
        offsets = np.array([kinematics.placement(q)[1] - shorter.placement(q)[1] for q in draws])
        offset = offsets[0]
        if np.abs(offsets - offset).max() > 1e-9:
            raise InputError(
                f"{robot.name}: the passive joints of {arm.name} do not keep {arm.tool_frame} upright over {tip}; "
                "PyBullet and pink cannot be asked the same: leave this robot out with --robot"
            )
    whole = len(arm.joint_names) >= 6
    return ArmQuestion(arm, kinematics, whole, lower, upper, tuple(endless.tolist()), urdf, tip, offset)


def _link(joint: ElementTree.Element, end: str) -> str:
    """Name of the link at one end of a joint."""
    found = joint.find(end)
    return "" if found is None else found.get("link", "")


def _chain_text(base: str, path: list[ElementTree.Element], driven: tuple[str, ...]) -> str:
    """A URDF with the joints of a path; those that are not driven are fixed."""
    root = ElementTree.Element("robot", name="chain")
    for name in [base, *(_link(joint, "child") for joint in path)]:
        inertial = ElementTree.SubElement(ElementTree.SubElement(root, "link", name=name), "inertial")
        ElementTree.SubElement(inertial, "mass", value="1")
        moments = {"ixx": "0.01", "iyy": "0.01", "izz": "0.01", "ixy": "0", "ixz": "0", "iyz": "0"}
        ElementTree.SubElement(inertial, "inertia", moments)
    for joint in path:
        name = joint.get("name", "")
        kind = joint.get("type", "fixed") if name in driven else "fixed"
        element = ElementTree.SubElement(root, "joint", name=name, type=kind)
        for tag in ("parent", "child", "origin", "axis", "limit"):
            if (part := joint.find(tag)) is not None:
                element.append(copy.deepcopy(part))
    return ElementTree.tostring(root, encoding="unicode")
