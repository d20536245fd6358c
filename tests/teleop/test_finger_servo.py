"""Fingers stop before what they may not touch, wherever the arm carries them, and go on when there is room."""

import numpy as np
import pytest

from robots import CollisionModel, load_robot
from robots.obstacle import Obstacle
from robots.pose import FloatArray, Pose
from teleop.drive_command import ArmWish, DriveCommand
from teleop.gamepad_mapping import GripperWish
from teleop.robot_servo import RobotServo
from teleop.servo_result import RobotServoResult, ServoView

DT = 1.0 / 240.0
FINGER_SPEED = 0.05
"""How fast gaps follow what fingers are told here [m/s]."""
MICO = load_robot("mico_segway")
WIDEST = MICO.arms["arm"].gripper.max_opening
AROUND = {
    "mast": [-0.038, 4.886, 4.339, 0.585, -2.744, 2.974],
    "camera": [-2.202, 3.755, 4.812, 2.528, 0.782, -0.555],
    "shoulder": [1.279, 2.255, 4.988, 1.806, 2.774, 1.666],
}
"""Postures in which the open fingers stand on both sides of a part of the robot; closed they would be inside it."""


class _Hand:
    """The Mico, moved by what its servo says."""

    def __init__(self, q: list[float], opening: float = WIDEST, things: tuple[Obstacle, ...] = ()) -> None:
        self.servo = RobotServo(MICO, things)
        self.q: FloatArray = np.array(q)
        self.opening = opening
        links = ("proximal_1", "distal_1", "proximal_2", "distal_2")
        self._judge = CollisionModel(MICO, things, may_touch=[(link, thing.name) for link in links for thing in things])

    def step(self, gripper: GripperWish = "keep", up: float = 0.0) -> RobotServoResult:
        wish = ArmWish((0.0, 0.0, up, 0.0, 0.0, 0.0), gripper=gripper)
        view = ServoView(self.q, np.zeros(len(self.q)), {"arm": self.opening})
        result = self.servo.step(DriveCommand({"arm": wish}), view, DT)
        self.q = self.q + result.joint_velocity * DT
        most = FINGER_SPEED * DT
        self.opening += float(np.clip(result.openings["arm"] - self.opening, -most, most))
        return result

    @property
    def distance(self) -> float:
        """Least distance of anything from what it may not touch [m]."""
        return self._judge.nearest(self.q, {"arm": self.opening}).distance


@pytest.mark.parametrize("up", [0.0, 0.05, -0.05], ids=["at rest", "on the way up", "on the way down"])
@pytest.mark.parametrize("part", AROUND)
def test_fingers_around_a_part_of_the_robot_do_not_close_on_it(part: str, up: float) -> None:
    hand = _Hand(AROUND[part])
    distances, details = [], set()
    for number in range(480):
        result = hand.step("close" if number == 0 else "keep", up)
        details.add(result.arms["arm"].detail)
        distances.append(hand.distance)
    assert min(distances) > 0.005  # the servo's promise; it stops at 5.5 mm and its fingers move 0.2 mm a period
    if up == 0.0:
        assert hand.opening > 0.05
        assert "no room for the fingers to close" in details  # said although the arm itself does what it was asked


def test_fingers_that_had_no_room_go_on_when_there_is_some() -> None:
    hand = _Hand(AROUND["mast"])
    for number in range(240):
        hand.step("close" if number == 0 else "keep")
    stopped = hand.opening
    assert stopped > 0.05
    hand.q = MICO.home.copy()  # carried away from the mast
    hand.servo.reset()
    hand.step("close")
    for _ in range(600):
        result = hand.step()
    assert result.openings == {"arm": 0.0}
    assert hand.opening == pytest.approx(0.0, abs=1e-9)


def test_fingers_that_are_not_free_to_close_can_open_again() -> None:
    hand = _Hand(AROUND["mast"])
    for number in range(240):
        hand.step("close" if number == 0 else "keep")
    stopped = hand.opening
    for number in range(240):
        hand.step("open" if number == 0 else "keep")
    assert hand.opening > stopped
    assert hand.distance > 0.005


def test_fingers_close_on_a_thing_between_them() -> None:
    tool = MICO.arms["arm"].forward_kinematics(MICO.home)
    thing = Obstacle("thing", "box", (0.015, 0.015, 0.015), Pose(tool.position, tool.orientation_xyzw))
    hand = _Hand(MICO.home.tolist(), things=(thing,))
    for number in range(60):
        result = hand.step("close" if number == 0 else "keep")
    assert result.openings == {"arm": 0.0}  # told to press, whatever is between
    assert result.arms["arm"].detail == ""
