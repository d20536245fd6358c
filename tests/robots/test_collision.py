"""Distances that can be worked out by hand, PyBullet's opinion, and answers that depend on nothing asked before."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from robots import CollisionModel, Obstacle, Pose, RobotError, RobotModel, load_robot
from robots.collision import FLOOR
from robots.kinematics import quaternion_xyzw, rotation_matrix

from .bullet_robot import BulletRobot

LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
FINGER = np.array([0.0, 0.0255, -0.014])
"""Middle of the lower end of the board arm's left finger, open, from the tool [m]; it is 18 x 3 mm."""
BOX = np.array([[x, y, z] for x in (-0.04, 0.04) for y in (-0.03, 0.03) for z in (-0.01, 0.01)])


@pytest.fixture(scope="module")
def baxter() -> RobotModel:
    return load_robot("baxter")


def thing(kind: str, position: np.ndarray, *size: float, name: str = "thing") -> Obstacle:
    corners = BOX if kind == "hull" else None
    return Obstacle(name, kind, size, Pose(position, LEVEL), corners)  # type: ignore[arg-type]


def below(arm: RobotModel, depth: float) -> np.ndarray:
    """A place straight below the left finger at home."""
    return arm.forward_kinematics(arm.home).position + FINGER - [0, 0, depth]


@pytest.mark.parametrize(
    ("kind", "size", "height"),
    [
        ("sphere", (0.02,), 0.02),
        ("box", (0.08, 0.06, 0.02), 0.01),
        ("cylinder", (0.05, 0.02), 0.01),
        ("hull", (), 0.01),
    ],
)
def test_distances_are_those_worked_out_by_hand(
    arm: RobotModel, kind: str, size: tuple[float, ...], height: float
) -> None:
    for distance in (0.016, 0.001, -0.004):
        model = CollisionModel(arm, [thing(kind, below(arm, distance + height), *size)])
        nearest = model.nearest(arm.home)
        # coal ends its search when it gains less than a micrometre.
        assert nearest.distance == pytest.approx(distance, abs=2e-6)
        assert (nearest.first, nearest.second) == ("left_finger", "thing")
        assert model.free(arm.home) is (distance > 0)


def test_obstacles_stay_where_they_are_when_the_robot_stands_elsewhere(arm: RobotModel) -> None:
    turned = arm.placed_at(Pose(np.array([0.3, -0.2, 0.1]), np.array([0.0, 0.0, 0.6, 0.8])))
    tool = turned.forward_kinematics(turned.home)
    centre = tool.position + rotation_matrix(tool.orientation_xyzw) @ FINGER - [0, 0, 0.03]
    model = CollisionModel(turned, [thing("sphere", centre, 0.02)])
    assert model.nearest(turned.home).distance == pytest.approx(0.01, abs=2e-6)


def test_a_margin_is_the_least_distance_allowed_whatever_was_asked_before(arm: RobotModel) -> None:
    model = CollisionModel(arm, [thing("sphere", below(arm, 0.036), 0.02)])
    asked = [0.0, 0.015, 0.017, 0.0, 0.017, 0.015, 0.1, 0.0]
    assert [model.free(arm.home, margin=margin) for margin in asked] == [margin < 0.016 for margin in asked]


def test_fingers_are_open_unless_told_otherwise(arm: RobotModel) -> None:
    beside = arm.forward_kinematics(arm.home).position + [0, 0.027 + 0.01 + 0.02, 0.017]
    model = CollisionModel(arm, [thing("sphere", beside, 0.02)])
    assert model.nearest(arm.home).distance == pytest.approx(0.010, abs=2e-6)
    assert not model.free(arm.home, margin=0.02)
    assert model.free(arm.home, {"arm": 0.0}, margin=0.02)  # the finger's outer face is then 3 mm from the axis


def test_answers_do_not_depend_on_what_was_asked_before(baxter: RobotModel) -> None:
    """The torso, which is not convex, was once given to coal as if it were: each search then ended where it began."""
    rng = np.random.default_rng(3)
    postures = rng.uniform(baxter.lower, baxter.upper, (80, 14))
    postures[::2] = (postures[::2] + baxter.home) / 2
    margins = (0.0, 0.02)
    one, other = CollisionModel(baxter), CollisionModel(baxter)
    first = [(one.nearest(q), [one.free(q, margin=margin) for margin in margins]) for q in postures]
    for index in rng.permutation(len(postures)):
        q, (nearest, free) = postures[index], first[index]
        other.free(rng.uniform(baxter.lower, baxter.upper), margin=0.05)
        # coal starts its search where the last one ended, and ends it within a micrometre of the distance.
        assert other.nearest(q).distance == pytest.approx(nearest.distance, abs=2e-6)
        for margin, answer in zip(margins, free, strict=True):
            if abs(nearest.distance - margin) > 2e-6:
                assert other.free(q, margin=margin) is answer is (nearest.distance > margin)
    assert 20 < sum(free[0] for _, free in first) < 75


def test_what_is_held_moves_with_the_tool_and_may_touch_the_hand(arm: RobotModel) -> None:
    cube = thing("box", np.zeros(3), 0.038, 0.038, 0.038, name="cube")
    tool = arm.forward_kinematics(arm.home).position
    table = thing("box", tool - [0, 0, 0.019 + 0.008 + 0.05], 1.0, 1.0, 0.1, name="table")
    model = CollisionModel(arm, [table], {"arm": [cube]})
    nearest = model.nearest(arm.home, {"arm": 0.038})
    assert nearest.distance == pytest.approx(0.008, abs=2e-6)
    assert (nearest.first, nearest.second) == ("cube", "table")
    rod = thing("box", np.array([0.0, 0.0, 0.4]), 0.02, 0.02, 0.8, name="rod held")
    assert not CollisionModel(arm, (), {"arm": [rod]}).free(arm.home)  # it goes up through the forearm


def test_things_held_by_two_arms_may_not_touch_each_other(baxter: RobotModel) -> None:
    def in_tool(arm: str, position: np.ndarray) -> Obstacle:
        tool = baxter.arms[arm].forward_kinematics(baxter.home[baxter.slice_of(arm)])
        turn = rotation_matrix(tool.orientation_xyzw).T
        pose = Pose(turn @ (position - tool.position), quaternion_xyzw(turn))
        return Obstacle("ball", "sphere", (0.02,), pose)  # both have one name

    middle = np.array([0.9, 0.0, 0.3])
    for gap in (0.010, -0.010):
        aside = np.array([0.0, 0.02 + gap / 2, 0.0])
        held = {"left": [in_tool("left", middle + aside)], "right": [in_tool("right", middle - aside)]}
        nearest = CollisionModel(baxter, (), held).nearest(baxter.home)
        assert nearest.distance == pytest.approx(gap, abs=2e-6)
        assert (nearest.first, nearest.second) == ("ball", "ball")


def test_contact_that_is_intended_does_not_count(arm: RobotModel) -> None:
    block = thing("box", below(arm, 0.005), 0.08, 0.08, 0.02, name="block")
    assert not CollisionModel(arm, [block]).free(arm.home)
    one = CollisionModel(arm, [block], may_touch=[("left_finger", "block")])
    # At home both fingers are in it; only one may be.
    assert one.nearest(arm.home).first == "right_finger"
    pairs = [("left_finger", "block"), ("block", "right_finger")]
    assert CollisionModel(arm, [block], may_touch=pairs).free(arm.home)


def test_what_the_base_is_bolted_to_is_not_hit_by_it(arm: RobotModel) -> None:
    table = thing("box", np.array([0.0, 0.2, -0.05]), 1.0, 1.0, 0.1, name="table")
    assert CollisionModel(arm, [table]).free(arm.home, margin=0.01)


def test_wheels_and_rollers_may_touch_the_floor_and_nothing_else() -> None:
    robot = load_robot("mico_segway")
    assert robot.floor is not None and robot.drive is not None
    top = robot.pose_base_in_world.position[2] + robot.floor
    floor = thing("box", np.array([0.0, 0.0, top - 0.05 + 0.001]), 4.0, 4.0, 0.1, name=FLOOR)
    assert CollisionModel(robot, [floor]).free(robot.home)
    ground = thing("box", floor.pose_obstacle_in_world.position, 4.0, 4.0, 0.1, name="ground")
    nearest = CollisionModel(robot, [ground]).nearest(robot.home)
    assert nearest.distance < 0
    assert nearest.first in robot.drive.on_floor and nearest.second == "ground"


def test_a_base_can_be_placed_elsewhere_among_the_same_obstacles() -> None:
    robot = load_robot("mico_segway")
    base = robot.pose_base_in_world
    pillar = thing("cylinder", base.position + [1.2, 0.0, 0.5], 0.1, 1.0, name="pillar")
    held = {"arm": [thing("sphere", np.zeros(3), 0.03, name="cup")]}
    moved = Pose(base.position + [0.5, 0.1, 0.0], np.array([0.0, 0.0, 0.2, np.sqrt(0.96)]))
    model = CollisionModel(robot, [pillar], held)
    model.place_base(moved)
    wanted = CollisionModel(robot.placed_at(moved), [pillar], held).nearest(robot.home)
    assert model.nearest(robot.home).distance == pytest.approx(wanted.distance, abs=1e-6)
    assert model.nearest(robot.home).second == wanted.second


def test_leaving_out_what_stands_still_changes_no_answer_of_the_moving_arm(baxter: RobotModel) -> None:
    shelf = thing("box", np.array([0.8, 0.2, 0.3]), 0.3, 0.6, 0.02, name="shelf")
    whole, left = CollisionModel(baxter, [shelf]), CollisionModel(baxter, [shelf], moving=["left"])
    rng, q = np.random.default_rng(5), baxter.home.copy()
    of_left = baxter.slice_of("left")
    seen = set()
    for _ in range(40):
        q[of_left] = rng.uniform(baxter.lower[of_left], baxter.upper[of_left])
        all_of_it, moved = whole.nearest(q), left.nearest(q)
        assert moved.distance >= all_of_it.distance
        moves = any(name.startswith(("left", "l_")) for name in (all_of_it.first, all_of_it.second))
        if moves:
            assert moved == all_of_it
            assert left.free(q) is whole.free(q)
        seen.add(moves)
    assert True in seen
    # What the right arm does is not looked at.
    q[of_left] = baxter.home[of_left]
    away = [*q[:7], 0.8, 0.9, 0.0, 0.0, 0.0, 0.0, 0.0]
    assert left.nearest(np.array(away)).first.startswith(("left", "l_"))


def test_pybullet_agrees_on_random_postures_beside_a_box(baxter: RobotModel) -> None:
    size, centre = np.array([0.4, 0.6, 0.1]), np.array([0.7, 0.1, 0.1])
    model = CollisionModel(baxter, [thing("box", centre, *size, name="box")])
    rng, compared = np.random.default_rng(0), 0
    with BulletRobot(baxter) as bullet:
        box = bullet.add_box(size, centre)
        for _ in range(1000):
            # Arms stretched forwards, near the box more often than near each other.
            q = baxter.home + rng.uniform(-0.6, 0.6, 14)
            q[[0, 7]] += -0.7, 0.7
            q[[1, 8]] += 0.4
            q = np.clip(q, baxter.lower, baxter.upper)
            nearest = model.nearest(q)
            if nearest.second != "box" or nearest.distance < 0:
                continue  # deep in each other, both find a way out, not always the shortest
            compared += 1
            bullet.place(baxter.expand(q, {}))
            # Bullet rounds the edges of boxes and cylinders: it finds up to 1.2 mm more than there is. (Of a finger tip
            # and the box, coal's distance is that of the nearest corner to the last digit.)
            assert -1e-4 < bullet.distances(box)[nearest.first] - nearest.distance < 0.0015
            if compared == 60:
                break
    assert compared == 60


def test_two_files_on_one_urdf_have_pairs_of_their_own(arm: RobotModel, spoiled: Callable[..., Path]) -> None:
    crossed = np.array([1.16364829, 0.5511071, 2.78446748])  # the finger is in the base: built so, if this is home
    text = f"home = {crossed.tolist()}"
    folder = spoiled("home = [0.0, -1.2123, 2.0093]", text)
    file = folder / "robot.toml"
    urdf = f'urdf = "{arm.folder / "three_dof.urdf"}"'
    file.write_text(file.read_text(encoding="utf-8").replace('urdf = "three_dof.urdf"', urdf), encoding="utf-8")
    other = load_robot(folder)
    assert other.urdf_path == arm.urdf_path
    for _ in range(2):
        assert not CollisionModel(arm).free(crossed)
        assert CollisionModel(other).free(crossed)


@pytest.mark.parametrize(
    ("kind", "size", "corners", "message"),
    [
        ("cone", (0.1,), None, r"kind must be one of box, sphere, cylinder, hull, got 'cone'"),
        ("box", (0.1, 0.1), None, r"a box needs 3 positive sizes \[m\], got \(0.1, 0.1\)"),
        ("box", (0.1, 0.1, 0.0), None, r"a box needs 3 positive sizes \[m\], got \(0.1, 0.1, 0.0\)"),
        ("sphere", (float("nan"),), None, r"a sphere needs 1 positive sizes \[m\], got \(nan,\)"),
        ("cylinder", (0.1, -1.0), None, r"a cylinder needs 2 positive sizes"),
        ("hull", (1.0,), BOX, r"a hull needs 0 positive sizes \[m\], got \(1.0,\)"),
        ("hull", (), None, "a hull needs finite corners"),
        ("hull", (), BOX[:3], "a hull needs finite corners .* at least four and not all in a plane"),
        ("hull", (), BOX * [1, 1, 0], "a hull needs finite corners .* not all in a plane"),
        ("hull", (), BOX + [[np.nan, 0, 0]], "a hull needs finite corners"),
    ],
)
def test_obstacles_that_cannot_be_are_refused(
    kind: str, size: tuple[float, ...], corners: np.ndarray | None, message: str
) -> None:
    with pytest.raises(RobotError, match=f"obstacle 'thing': {message}"):
        Obstacle("thing", kind, size, Pose(np.zeros(3), LEVEL), corners)  # type: ignore[arg-type]


def test_obstacles_that_are_nowhere_are_refused() -> None:
    with pytest.raises(RobotError, match=r"obstacle 'thing': its pose must be finite, got \[ 0. nan  0.\]"):
        thing("sphere", np.array([0.0, np.nan, 0.0]), 0.1)


def test_unknown_arms_and_postures_of_another_length_are_refused(arm: RobotModel) -> None:
    ball = thing("sphere", np.zeros(3), 0.01)
    with pytest.raises(RobotError, match="three_dof has no arm 'left': use one of arm"):
        CollisionModel(arm, (), {"left": [ball]})
    with pytest.raises(RobotError, match="three_dof has no arm 'left': use one of arm"):
        CollisionModel(arm, moving=["left"])
    with pytest.raises(RobotError, match=r"three_dof has 3 driven joints, got values of shape \(4,\)"):
        CollisionModel(arm).free(np.zeros(4))
