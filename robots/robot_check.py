"""Whether `robot.toml` and the URDF agree."""

from pathlib import Path

from .errors import RobotError
from .robot_file import ArmSection, RobotFile
from .urdf import Urdf


def check_against_urdf(spec: RobotFile, urdf: Urdf, toml: Path) -> None:
    """Check what robot.toml says against the URDF.

    Raises:
        RobotError: A joint or frame is not in the URDF, a posture leaves the limits, or a limit is above the URDF's.
    """
    for number, arm in enumerate(spec.arms):
        _check_arm(arm, f"{toml}: arms[{number}]", spec.urdf, urdf)
    where = f"{toml}: "
    if spec.drive is not None:
        _check_joints(spec.drive.wheels, f"{where}drive.wheels", spec.urdf, urdf)
        _check_links(spec.drive.rollers, f"{where}drive.rollers", spec.urdf, urdf)
    _check_joints(tuple(spec.locked), f"{where}locked", spec.urdf, urdf)
    driven = {name for arm in spec.arms for name in (*arm.joints, *arm.gripper.joints)}
    for name, position in spec.locked.items():
        joint = urdf.joints[name]
        if name in driven:
            raise RobotError(f"{where}locked: {name!r} is driven by an arm; leave it out")
        if not joint.lower <= position <= joint.upper:
            raise RobotError(f"{where}locked: {name} must be in {joint.lower}..{joint.upper}, got {position}")
    for pair in spec.collision.ignore:
        _check_links(pair, f"{where}collision.ignore", spec.urdf, urdf)
    for name, camera in spec.cameras.items():
        _check_links((camera.link,), f"{where}cameras.{name}.link", spec.urdf, urdf)


def _check_arm(arm: ArmSection, where: str, file: str, urdf: Urdf) -> None:
    _check_joints((*arm.joints, *arm.gripper.joints), f"{where}.joints", file, urdf)
    for name in arm.joints:
        if urdf.joints[name].mimic is not None:
            raise RobotError(f"{where}.joints: {name!r} mimics another joint and cannot be driven")
    _check_links((arm.tool_frame,), f"{where}.tool_frame", file, urdf)
    _check_links(arm.gripper.pads or (), f"{where}.gripper.pads", file, urdf)
    for index, name in enumerate(arm.joints):
        joint = urdf.joints[name]
        home, velocity = arm.home[index], arm.velocity[index]
        if not joint.lower <= home <= joint.upper:
            raise RobotError(f"{where}.home: {name} must be in {joint.lower}..{joint.upper} rad, got {home}")
        if velocity > joint.velocity:
            raise RobotError(f"{where}.velocity: {name} may be at most {joint.velocity} rad/s, got {velocity}")
    gripper = arm.gripper
    closed = gripper.closed or (0.0, 0.0)
    if gripper.open is None and gripper.max_opening is not None:
        least = gripper.closed_gap + 2.0 * gripper.mounting
        if gripper.max_opening <= least:
            raise RobotError(
                f"{where}.gripper.max_opening: must be above the gap of the closed fingers, {least:g} m, "
                f"got {gripper.max_opening}"
            )
        reach, name = min(
            (urdf.joints[name].upper - start, name) for name, start in zip(gripper.joints, closed, strict=True)
        )
        if 0.5 * (gripper.max_opening - least) > reach + 1e-9:
            raise RobotError(
                f"{where}.gripper.max_opening: {name} opens to {urdf.joints[name].upper:g} m, so at most "
                f"{least + 2.0 * reach:g}, got {gripper.max_opening}"
            )
    for key, positions in (("closed", closed), ("open", gripper.open or closed)):
        for name, value in zip(gripper.joints, positions, strict=True):
            joint = urdf.joints[name]
            if not joint.lower - 1e-9 <= value <= joint.upper + 1e-9:
                raise RobotError(f"{where}.gripper.{key}: {name} must be in {joint.lower}..{joint.upper}, got {value}")


def _check_joints(names: tuple[str, ...], where: str, file: str, urdf: Urdf) -> None:
    for name in names:
        if name not in urdf.joints:
            raise RobotError(f"{where}: no movable joint {name!r} in {file}; it has {', '.join(urdf.joints)}")


def _check_links(names: tuple[str, ...], where: str, file: str, urdf: Urdf) -> None:
    for name in names:
        if name not in urdf.links:
            raise RobotError(f"{where}: no link {name!r} in {file}; it has {', '.join(urdf.links)}")
