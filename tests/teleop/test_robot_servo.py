"""Whole robots under the servo, moved by what it says: lines, limits, distances, stops, and what is said of them."""

import math
import re
from collections.abc import Callable

import numpy as np
import pytest

from robots import CollisionModel, Obstacle, Pose, RobotModel, load_robot
from robots.kinematics import rotation_matrix
from robots.manipulability import condition_number
from teleop.base_servo import rolled
from teleop.drive_command import ArmWish, DriveCommand
from teleop.errors import ServoError
from teleop.robot_servo import RobotServo
from teleop.servo_guard import PRESS_MOST
from teleop.servo_reason import DriveReason
from teleop.servo_result import RobotServoResult, ServoView

DT = 1.0 / 240.0
LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
THREE_DOF, BAXTER, MICO = (load_robot(name) for name in ("three_dof", "baxter", "mico_segway"))


class Driven:
    """A robot that does exactly what its servo says."""

    def __init__(self, robot: RobotModel, things: tuple[Obstacle, ...] = (), q: np.ndarray | None = None) -> None:
        self.robot, self.servo = robot, RobotServo(robot, things)
        self.q = robot.home.copy() if q is None else q
        self.base = robot.pose_base_in_world
        self.openings: dict[str, float] = {}
        self.speeds: list[np.ndarray] = []

    def view(self) -> ServoView:
        return ServoView(self.q, np.zeros(len(self.q)), self.openings, self.base)

    def go(
        self, command: DriveCommand, seconds: float, until: Callable[[RobotServoResult], bool] = lambda _: False
    ) -> RobotServoResult:
        for _ in range(round(seconds / DT)):
            result = self.servo.step(command, self.view(), DT)
            self.q = self.q + result.joint_velocity * DT
            if result.base_twist.any():
                self.base = rolled(self.base, result.base_twist[None] * DT)[0]
            self.speeds.append(np.concatenate((result.joint_velocity, result.base_twist)))
            if until(result):
                break
        return result

    def tool(self, arm: str) -> Pose:
        return self.robot.arms[arm].forward_kinematics(self.q[self.robot.slice_of(arm)])

    def check_limits(self) -> None:
        robot, drive = self.robot, self.robot.drive
        base = np.zeros((3, 2)) if drive is None else np.array(
            [[drive.speed, drive.yaw_rate], [drive.acceleration, drive.yaw_acceleration], [drive.jerk, drive.yaw_jerk]]
        )  # fmt: skip
        speeds = np.vstack((np.zeros((2, len(self.q) + 2)), self.speeds))
        rates = np.diff(speeds, axis=0) / DT
        jerks = np.diff(rates, axis=0) / DT
        # Rounding, divided by the period once and twice.
        for values, limits, own, slack in (
            (speeds, robot.velocity, base[0], 1e-9),
            (rates, robot.acceleration, base[1], 1e-6),
            (jerks, robot.jerk, base[2], 1e-3),
        ):
            assert np.all(np.abs(values).max(axis=0) <= np.append(limits, own) + slack)


def move(arm: str, *twist: float, **more: object) -> DriveCommand:
    return DriveCommand({arm: ArmWish((*twist, *[0.0] * (6 - len(twist))), **more)})  # type: ignore[arg-type]


def box(name: str, centre: tuple[float, ...], *size: float) -> Obstacle:
    return Obstacle(name, "box", size, Pose(np.array(centre), LEVEL))


@pytest.mark.parametrize(
    ("robot", "arm", "twist", "way"),
    [
        (BAXTER, "left", (0.0, -0.15, 0.0), 0.5),
        (BAXTER, "left", (0.0, 0.0, -0.1), 0.1),
        (MICO, "arm", (0.0, 0.05, 0.0), 0.3),
        (MICO, "arm", (0.0, -0.05, 0.0), 0.3),
        (MICO, "arm", (0.0, -0.3, 0.0), 0.3),  # slowed by velocity limits
        (THREE_DOF, "arm", (0.0, 0.15, 0.0), 0.4),
        (THREE_DOF, "arm", (0.3, 0.0, 0.0), 0.3),  # slowed by the elbow's end
    ],
)
def test_axes_that_are_not_commanded_do_not_drift(
    robot: RobotModel, arm: str, twist: tuple[float, ...], way: float
) -> None:
    driven = Driven(robot)
    start = driven.tool(arm)
    along = np.array(twist) / np.linalg.norm(twist)

    def off(_: RobotServoResult) -> bool:
        now = driven.tool(arm)
        moved = now.position - start.position
        gone = float(moved @ along)
        across = float(np.linalg.norm(moved - gone * along))
        turned = rotation_matrix(start.orientation_xyzw).T @ rotation_matrix(now.orientation_xyzw)
        angle = math.degrees(math.acos(min((float(np.trace(turned)) - 1.0) / 2.0, 1.0)))
        # Of 0.5 m: 1 mm and 0.2 degrees are what the project promises.
        assert across < 1e-3 and angle < 0.2
        return gone >= way

    driven.go(move(arm, *twist), 10.0, off)
    driven.go(DriveCommand(), 1.0, lambda result: bool(off(result) and driven.servo.at_rest))
    assert np.linalg.norm(driven.tool(arm).position - start.position) >= way
    assert driven.servo.at_rest
    driven.check_limits()


def test_steady_motion_executes_what_was_asked_and_says_nothing() -> None:
    driven = Driven(BAXTER)
    result = driven.go(move("left", 0.0, -0.05, 0.0), 0.7)
    assert (result.state, result.reason, result.arms["left"].reason) == ("ok", "", DriveReason.NONE)
    # Between two postures a step apart the Jacobian changes by that much.
    np.testing.assert_allclose(result.arms["left"].executed, [0, -0.05, 0, 0, 0, 0], atol=5e-4)
    np.testing.assert_array_equal(result.arms["right"].executed, np.zeros(6))


def test_both_arms_move_at_once_each_in_its_own_frame() -> None:
    driven = Driven(BAXTER)
    wishes = {
        "left": ArmWish((0.0, -0.04, 0.0, 0.0, 0.0, 0.0), "base"),
        "right": ArmWish((0.0, 0.0, 0.0, 0.0, 0.0, 0.3), "tool"),
    }
    axes = rotation_matrix(driven.tool("right").orientation_xyzw)
    result = driven.go(DriveCommand(wishes, speed_ratio=0.5), 0.8)
    np.testing.assert_allclose(result.arms["left"].executed[:3], [0.0, -0.02, 0.0], atol=1e-3)
    np.testing.assert_allclose(result.arms["right"].executed[3:], 0.15 * axes[:, 2], atol=2e-3)
    driven.check_limits()


def test_camera_axes_are_forward_left_and_up_in_the_picture() -> None:
    looking_down = np.array([1.0, 0.0, 0.0, 0.0])  # x right is the world's, y down and z forward are turned over
    view = ServoView(BAXTER.home, np.zeros(14), {}, camera_xyzw=looking_down)
    command = DriveCommand({"left": ArmWish((0.01, 0.02, 0.03, 0.0, 0.0, 0.0), "camera")})
    result = RobotServo(BAXTER).step(command, view, DT)
    np.testing.assert_allclose(result.arms["left"].asked[:3], [-0.02, 0.03, -0.01], atol=1e-12)


def test_the_picture_that_the_person_sees_goes_before_the_robots_camera() -> None:
    from_the_front = (0.5, 0.5, -0.5, -0.5)  # x right is the world's y, y down is -z, z forward is -x
    view = ServoView(BAXTER.home, np.zeros(14), {}, camera_xyzw=np.array([1.0, 0.0, 0.0, 0.0]))
    wish = ArmWish((0.01, 0.02, 0.03, 0.0, 0.0, 0.0), "camera")
    result = RobotServo(BAXTER).step(DriveCommand({"left": wish}, camera_xyzw=from_the_front), view, DT)
    np.testing.assert_allclose(result.arms["left"].asked[:3], [-0.01, -0.02, 0.03], atol=1e-12)
    crooked = DriveCommand({"left": wish}, camera_xyzw=(0.5, 0.5, 0.5, 0.6))
    refused = RobotServo(BAXTER).step(crooked, view, DT)
    assert refused.arms["left"].reason is DriveReason.BAD_INPUT
    assert "orientation of the picture is (0.5, 0.5, 0.5, 0.6)" in refused.arms["left"].detail


def test_a_single_joint_is_jogged_alone_to_its_end_and_back() -> None:
    driven = Driven(BAXTER)
    joint = 5
    driven.go(DriveCommand({"left": ArmWish(jog=(joint, 1.0))}), 1.5)
    last = driven.go(DriveCommand({"left": ArmWish(jog=(joint, 1.0))}), 0.5)
    assert (last.arms["left"].reason, last.arms["left"].detail) == (DriveReason.POSITION_LIMIT, "left_w1")
    assert BAXTER.upper[joint] - 0.02 < driven.q[joint] < BAXTER.upper[joint]
    others = np.delete(driven.q, joint) - np.delete(BAXTER.home, joint)
    np.testing.assert_array_equal(others, np.zeros(13))
    back = driven.go(DriveCommand({"left": ArmWish(jog=(joint, -1.0))}), 0.3)
    assert back.joint_velocity[joint] == pytest.approx(-1.0)
    driven.check_limits()


def test_what_an_arm_of_three_joints_cannot_do_is_named() -> None:
    driven = Driven(THREE_DOF)
    result = driven.go(move("arm", 0.0, 0.1, 0.0, 0.0, 0.0, 0.5), 0.5)
    assert result.arms["arm"].reason is DriveReason.UNREACHABLE
    assert result.state == "slowed" and "cannot turn its tool" in result.reason
    np.testing.assert_allclose(result.arms["arm"].executed, [0.0, 0.1, 0.0, 0.0, 0.0, 0.0], atol=5e-3)
    np.testing.assert_allclose(result.arms["arm"].asked, [0.0, 0.1, 0.0, 0.0, 0.0, 0.5])
    base = driven.go(DriveCommand(base=(0.2, 0.0)), 0.1)
    assert base.base_reason is DriveReason.UNREACHABLE and "no wheels" in base.base_detail


@pytest.mark.parametrize(
    ("command", "reason", "detail"),
    [
        (DriveCommand(stop=True), DriveReason.STOPPED, "release"),
        (DriveCommand(enabled=False), DriveReason.DISABLED, "enabling button"),
        (DriveCommand(age=0.12), DriveReason.LOST_INPUT, "0.12 s old, allowed 0.1"),
        (DriveCommand(fault="gamepad was unplugged"), DriveReason.BAD_INPUT, "unplugged"),
        (DriveCommand(speed_ratio=math.nan), DriveReason.BAD_INPUT, "speed ratio is nan"),
        (DriveCommand(base=(9.0, 0.0)), DriveReason.BAD_INPUT, "speed of the base is 9.0"),
        (move("arm", math.nan), DriveReason.BAD_INPUT, "x speed of arm arm is nan"),
        (move("head", 0.1), DriveReason.BAD_INPUT, "no arm 'head', use one of arm"),
        (DriveCommand({"arm": ArmWish(jog=(6, 0.1))}), DriveReason.BAD_INPUT, "jogged joint .* is 6, allowed 0..5"),
    ],
)
def test_everything_brakes_smoothly_with_its_reason_and_goes_on_when_released(
    command: DriveCommand, reason: DriveReason, detail: str
) -> None:
    driven = Driven(MICO)
    moving = DriveCommand({"arm": ArmWish((0.0, 0.05, 0.0, 0.0, 0.0, 0.0))}, base=(0.2, 0.3))
    driven.go(moving, 0.8)
    before = np.abs(driven.speeds[-1])
    assert before[:6].max() > 0.05 and before[6] > 0.15
    # Braking takes v / a and a / j more where the change is long enough, for the slowest: the base.
    assert MICO.drive is not None
    longest = before[6] / MICO.drive.acceleration + MICO.drive.acceleration / MICO.drive.jerk
    result = driven.go(command, longest + 2 * DT)
    assert driven.servo.at_rest
    assert result.state == "stopped" and result.arms["arm"].reason is reason and result.base_reason is reason
    assert pytest.approx(0.0) == np.abs(result.arms["arm"].asked).max()
    assert re.search(detail, result.arms["arm"].detail)
    again = driven.go(moving, 1.0)
    assert again.base_twist[0] == pytest.approx(0.2) and again.arms["arm"].executed[1] == pytest.approx(0.05, abs=2e-3)
    driven.check_limits()


def test_singular_postures_are_approached_slowly_and_left_at_once() -> None:
    # The makers' neutral posture has its arms nearly stretched.
    driven = Driven(BAXTER, q=np.tile([0, -0.55, 0, 0.75, 0, 1.26, 0], 2).astype(float))
    where = BAXTER.slice_of("left")
    seen = driven.go(move("left", 0.0, 0.1, 0.0), 2.0)
    assert seen.arms["left"].reason is DriveReason.SINGULARITY
    condition = condition_number(BAXTER.arms["left"].jacobian(driven.q[where]), 0.3)
    assert 17.0 < condition < 30.5
    assert np.abs(seen.arms["left"].executed).max() < 0.02
    back = driven.go(move("left", 0.0, -0.1, 0.0), 1.0)
    assert back.arms["left"].executed[1] == pytest.approx(-0.1, abs=2e-3)
    driven.check_limits()


@pytest.mark.parametrize(
    ("robot", "arm", "twist", "reason"),
    [
        (BAXTER, "left", (0.4, 0.0, 0.0), DriveReason.SINGULARITY),
        (MICO, "arm", (0.0, 0.0, 0.4), DriveReason.SINGULARITY),
        (MICO, "arm", (0.4, 0.0, 0.0), DriveReason.SINGULARITY),
        (THREE_DOF, "arm", (0.4, 0.0, 0.0), DriveReason.POSITION_LIMIT),
    ],
)
def test_a_fast_motion_stops_on_its_line_before_a_singular_posture_or_a_joints_end(
    robot: RobotModel, arm: str, twist: tuple[float, ...], reason: DriveReason
) -> None:
    driven = Driven(robot)
    start, along, where = driven.tool(arm).position, np.array(twist) / 0.4, robot.slice_of(arm)
    rows = 3 if robot is THREE_DOF else 6
    conditions = []

    def look(result: RobotServoResult) -> bool:
        moved = driven.tool(arm).position - start
        assert np.linalg.norm(moved - (moved @ along) * along) < 1e-3  # as promised of straight lines
        conditions.append(condition_number(robot.arms[arm].jacobian(driven.q[where])[:rows], 0.3))
        return result.arms[arm].reason is reason and bool(np.abs(result.arms[arm].executed).max() < 1e-3)

    last = driven.go(move(arm, *twist), 8.0, look)
    assert last.arms[arm].reason is reason
    assert max(conditions) < 30.1  # the estimate of the condition number is right to a thousandth
    back = driven.go(move(arm, *(-np.array(twist) / 8.0).tolist()), 1.0)
    np.testing.assert_allclose(back.arms[arm].executed[:3], -along * 0.05, atol=2e-3)
    driven.check_limits()


def test_an_arm_keeps_its_distance_and_leaves_freely() -> None:
    tool = BAXTER.arms["left"].forward_kinematics(BAXTER.home[BAXTER.slice_of("left")]).position
    wall = box("wall", (float(tool[0]), float(tool[1]) - 0.25, float(tool[2])), 0.3, 0.02, 0.3)
    driven = Driven(BAXTER, (wall,))
    judge = CollisionModel(BAXTER, [wall], may_touch=[(f"l_gripper_{side}_finger", "wall") for side in "lr"]
                           + [(f"l_gripper_{side}_finger_tip", "wall") for side in "lr"])  # fmt: skip
    nearest: list[float] = []
    seen = set()

    def look(result: RobotServoResult) -> bool:
        if len(driven.speeds) % 8 == 0:
            nearest.append(judge.nearest(driven.q).distance)
        seen.add(result.arms["left"].reason)
        return False

    driven.go(move("left", 0.0, -0.3, 0.0), 3.0, look)
    assert min(nearest) > 0.005
    assert DriveReason.COLLISION in seen or DriveReason.CONTACT in seen
    assert np.abs(driven.speeds[-1]).max() < 0.1
    back = driven.go(move("left", 0.0, 0.1, 0.0), 0.8, look)
    assert back.arms["left"].executed[1] == pytest.approx(0.1, abs=5e-3)
    driven.check_limits()


def test_fingers_may_press_slowly_and_not_deep() -> None:
    tool = THREE_DOF.forward_kinematics(THREE_DOF.home).position
    table = box("table", (float(tool[0]), float(tool[1]), float(tool[2]) - 0.25), 0.5, 0.5, 0.3)
    driven = Driven(THREE_DOF, (table,))
    everything = CollisionModel(THREE_DOF, [table])
    track = []

    def look(_: RobotServoResult) -> bool:
        track.append(everything.nearest(driven.q).distance)
        return False

    driven.go(move("arm", 0.0, 0.0, -0.3), 2.0, look)
    distances = np.array(track)
    touching = distances[:-1] < 1e-4
    assert touching.any() and distances.min() > -0.0051
    assert np.all(np.diff(distances)[touching] / DT > -0.05)
    up = driven.go(move("arm", 0.0, 0.0, 0.1), 0.5)
    assert up.arms["arm"].executed[2] == pytest.approx(0.1, abs=2e-3)


@pytest.mark.parametrize("left", [1e-6, 1.9e-6, 1e-5])
def test_fingers_that_press_as_deep_as_they_may_come_free(left: float) -> None:
    q = np.array([0.7327, -0.3, 1.1267])
    tool = THREE_DOF.forward_kinematics(q).position
    table = box("table", (float(tool[0]), float(tool[1]), float(tool[2]) - 0.25), 0.5, 0.5, 0.3)
    everything = CollisionModel(THREE_DOF, [table])
    closed = {"arm": 0.0}
    out, deep = q.copy(), q + (0.0, 0.4, 0.0)
    for _ in range(60):  # to the last digit: what is left is all they may go on
        middle = 0.5 * (out + deep)
        if everything.nearest(middle, closed).distance > PRESS_MOST + left:
            out = middle
        else:
            deep = middle
    driven = Driven(THREE_DOF, (table,), out)
    driven.openings = closed
    up = driven.go(move("arm", 0.0, 0.0, 0.1), 0.3)
    assert up.arms["arm"].executed[2] > 0.05
    assert everything.nearest(driven.q, closed).distance > PRESS_MOST + 0.002


def test_a_base_stops_before_a_pillar_and_drives_back() -> None:
    base = MICO.pose_base_in_world.position
    pillar = box("pillar", (float(base[0]) + 1.0, float(base[1]), float(base[2]) + 0.3), 0.1, 0.1, 0.6)
    driven = Driven(MICO, (pillar,))
    judge = CollisionModel(MICO, [pillar])
    result = driven.go(DriveCommand(base=(0.5, 0.0)), 4.0)
    judge.place_base(driven.base)
    assert 0.005 < judge.nearest(driven.q).distance < 0.02
    assert driven.base.position[0] > base[0] + 0.2
    assert result.base_reason is DriveReason.COLLISION and "pillar" in result.base_detail
    back = driven.go(DriveCommand(base=(-0.3, 0.0)), 1.5)
    assert back.base_twist[0] == pytest.approx(-0.3)
    driven.check_limits()


def test_a_base_that_is_hemmed_in_has_a_way_out() -> None:
    base = MICO.pose_base_in_world.position
    x, y, z = (float(value) for value in base)
    walls = (box("before", (x + 0.95, y, z + 0.3), 0.1, 2.0, 0.6), box("left", (x, y + 0.55, z + 0.3), 1.6, 0.1, 0.6))
    driven = Driven(MICO, walls)
    for into in ((0.5, 0.0), (0.0, 1.0), (0.5, 1.0), (0.5, -1.0)):  # until each stands against something
        last = driven.go(DriveCommand(base=into), 4.0)
    assert last.base_reason is DriveReason.COLLISION
    assert np.abs(last.base_twist).max() < 0.1
    stand, q = driven.base, driven.q
    freed = []
    for out in ((-0.3, 0.0), (0.0, 0.5), (0.0, -0.5), (0.3, 0.0)):
        driven.servo.reset()
        driven.base, driven.q = stand, q
        driven.go(DriveCommand(base=out), 0.5)
        if np.linalg.norm(driven.base.position - stand.position) > 0.02:
            freed.append(out)
    assert (-0.3, 0.0) in freed  # backing off leads away from the wall before it


def test_things_may_be_moved_and_held_while_it_drives() -> None:
    driven = Driven(BAXTER)
    cup = Obstacle("1", "cylinder", (0.03, 0.1), Pose(np.array([0.7, 0.3, 0.05]), LEVEL))
    driven.servo.watch([cup])
    driven.go(move("left", 0.0, -0.05, 0.0), 0.2)
    driven.servo.watch([Obstacle("1", "cylinder", (0.03, 0.1), Pose(np.array([0.7, 0.2, 0.05]), LEVEL))])
    driven.go(move("left", 0.0, -0.05, 0.0), 0.2)
    driven.servo.watch([], {"left": [Obstacle("1", "cylinder", (0.03, 0.1), Pose(np.zeros(3), LEVEL))]})
    result = driven.go(move("left", 0.0, -0.05, 0.0), 0.2)
    assert result.arms["left"].executed[1] == pytest.approx(-0.05, abs=2e-3)


def test_grippers_keep_what_was_last_wished() -> None:
    driven = Driven(BAXTER)
    driven.go(DriveCommand({"left": ArmWish(gripper="close")}), 0.02)
    result = driven.go(DriveCommand({"right": ArmWish(gripper="open")}), 0.02)
    assert result.openings == {"left": 0.0, "right": BAXTER.arms["right"].gripper.max_opening}
    stopped = driven.go(DriveCommand({"left": ArmWish(gripper="open")}, stop=True), 0.02)
    assert stopped.openings["left"] == 0.0


@pytest.mark.parametrize(
    ("q", "dt", "message"),
    [
        (np.zeros(3), DT, "q must be 14 finite values for baxter"),
        (np.full(14, np.nan), DT, "q must be 14 finite values"),
        (BAXTER.home, 0.0, "dt is 0.0, allowed above 0"),
    ],
)
def test_wrong_views_are_refused(q: np.ndarray, dt: float, message: str) -> None:
    with pytest.raises(ServoError, match=message):
        RobotServo(BAXTER).step(DriveCommand(), ServoView(q, np.zeros(14)), dt)
