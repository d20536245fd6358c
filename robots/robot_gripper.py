"""From what `robot.toml` says of a gripper to a `Gripper`, with the gaps measured on the URDF."""

from pathlib import Path

import numpy as np

from .errors import RobotError
from .gripper import Gripper, unit_axis
from .kinematics import frame_positions
from .pose import FloatArray
from .robot_file import ArmSection, GripperSection
from .urdf import Urdf

_SAMPLES = 201
"""Positions of revolute fingers at which the gap is measured: it is then known to some micrometres in between."""


def make_gripper(arm: ArmSection, urdf: Urdf, urdf_path: Path, toml: Path) -> Gripper:
    """Build the gripper of an arm.

    Raises:
        RobotError: The fingers do not open steadily, or less than `max_opening`; names file and key.
    """
    spec = arm.gripper
    closed = np.array(spec.closed or (0.0, 0.0))
    opened = _open_positions(spec, closed)
    if np.any(opened == closed):
        way = f"{tuple(opened.tolist())} from {tuple(closed.tolist())}"
        raise RobotError(f"{toml}: arms.gripper.open: each finger must move, got {way}")
    if spec.pads is None:
        ways = np.array([0.0, 1.0])
        closed_gap = spec.closed_gap + 2.0 * spec.mounting
        gaps = np.array([closed_gap, closed_gap + float(np.abs(opened - closed).sum())])
    else:
        ways = np.linspace(0.0, 1.0, _SAMPLES)
        gaps = _measured(spec, spec.pads, urdf, urdf_path, closed, opened, ways)
    if spec.pads is None and gaps[0] < -1e-9:
        raise RobotError(
            f"{toml}: arms.gripper.mounting: fingers would overlap by {-1000 * gaps[0]:.1f} mm when closed; "
            f"mount them at least {-spec.closed_gap / 2:g} m outwards, got {spec.mounting:g}"
        )
    # Revolute fingers cross before they are fully closed: what is left of the way closes no gap.
    first = int(np.argmax(gaps > 0)) if spec.pads is not None else 0
    ways, gaps = ways[first:], gaps[first:]
    if not np.all(np.diff(gaps) > 0):
        raise RobotError(f"{toml}: arms.gripper: the gap between the pads must grow from closed to open")
    largest = float(gaps[-1]) if spec.max_opening is None else spec.max_opening
    if largest > gaps[-1] + 1e-9:
        raise RobotError(
            f"{toml}: arms.gripper.max_opening: the fingers open to {gaps[-1]:g} m, so at most that, got {largest}"
        )
    return Gripper(
        joints=(spec.joints[0], spec.joints[1]),
        min_opening=0.0 if first else float(gaps[0]),
        max_opening=largest,
        force=spec.force,
        closing_speed=spec.closing_speed,
        spinning=spec.spinning,
        closed=closed,
        open=opened,
        approach=unit_axis(spec.approach),
        closing=unit_axis(spec.closing),
        ways=ways,
        gaps=gaps,
        touching=_touching(spec, urdf),
    )


def _touching(spec: GripperSection, urdf: Urdf) -> frozenset[str]:
    """The links that carry the pads; where no pads are named, all of the fingers."""
    carried = {joint.child for joint in urdf.joints.values()}
    if spec.pads is not None:
        links = set(spec.pads)
        for link in spec.pads:
            while link not in carried:
                link = urdf.parents[link]
                links.add(link)
        return frozenset(links)
    links = {urdf.joints[name].child for name in spec.joints}
    for link in urdf.links:
        above = link
        while above in urdf.parents and above not in links:
            above = urdf.parents[above]
        if above in links:
            links.add(link)
    return frozenset(links)


def _open_positions(spec: GripperSection, closed: FloatArray) -> FloatArray:
    """Joint positions (2,) when open."""
    if spec.open is not None:
        return np.array(spec.open)
    assert spec.max_opening is not None  # the file's check
    return closed + 0.5 * (spec.max_opening - spec.closed_gap - 2.0 * spec.mounting)


def _measured(
    spec: GripperSection,
    pads: tuple[str, ...],
    urdf: Urdf,
    urdf_path: Path,
    closed: FloatArray,
    opened: FloatArray,
    ways: FloatArray,
) -> FloatArray:
    """Gaps (k,) [m] between the pads; negative where the fingers have crossed."""
    followers = [joint.mimic for joint in urdf.joints.values() if joint.mimic and joint.mimic.source in spec.joints]
    across = []
    for way in ways:
        joints = dict(zip(spec.joints, (closed + way * (opened - closed)).tolist(), strict=True))
        joints |= {each.joint: each.follow(joints[each.source]) for each in followers}
        first, second = frame_positions(urdf_path, joints, pads)
        across.append(second - first)
    widest = float(np.linalg.norm(across[-1]))
    return np.array(across) @ (across[-1] / widest) if widest else np.zeros(len(across))
