"""Bounds that hold, distances as the collision model says, gradients as differences say."""

import numpy as np
import pytest

from robots import CollisionModel, Obstacle, Pose, load_robot
from robots.kinematics import quaternion_xyzw, rotation_matrix
from robots.near_pairs import NearPairs

LEVEL = np.array([0.0, 0.0, 0.0, 1.0])


def things(height: float) -> list[Obstacle]:
    return [
        Obstacle("table", "box", (0.8, 1.2, 0.04), Pose(np.array([0.7, 0.0, height - 0.02]), LEVEL)),
        Obstacle("ball", "sphere", (0.04,), Pose(np.array([0.5, 0.2, height + 0.04]), LEVEL)),
    ]


@pytest.mark.parametrize("name", ["three_dof", "baxter", "mico_segway"])
def test_bounds_hold_and_distances_are_those_of_the_collision_model(name: str) -> None:
    robot = load_robot(name)
    collision, around = CollisionModel(robot, things(-0.1)), things(-0.1)
    pairs = NearPairs(robot, around)
    track, rng = pairs.track(), np.random.default_rng(3)
    everything, q, base = np.arange(len(pairs.names)), robot.home, robot.pose_base_in_world
    for step in range(60):
        q = np.clip(q + rng.normal(0.0, 0.02, len(q)), robot.lower, robot.upper)
        openings = {arm: float(rng.uniform(0.0, 0.04)) for arm in robot.arms}
        if robot.drive is not None:
            turn = np.array([0.0, 0.0, np.sin(0.01 * step), np.cos(0.01 * step)])
            base = Pose(base.position + np.array([0.004, 0.001, 0.0]), turn)
        elif step % 10 == 5:
            around[1] = things(0.1 * rng.uniform())[1]
            track.shrink(pairs.place(around, {}))
            collision = CollisionModel(robot, around)
        collision.place_base(base)
        track.move(pairs.positions(q, openings), base)
        bounds = track.bounds.copy()
        distances = track.refine(everything)
        # The solver ends its search within a micrometre.
        assert np.all(bounds <= distances + 2e-6)
        assert distances.min() == pytest.approx(collision.nearest(q, openings).distance, abs=2e-6)


@pytest.mark.parametrize("name", ["three_dof", "baxter", "mico_segway"])
def test_gradients_are_those_of_differences(name: str) -> None:
    robot = load_robot(name)
    pairs = NearPairs(robot, things(0.0)[1:])
    base, rng = robot.pose_base_in_world, np.random.default_rng(0)
    q = np.clip(robot.home + rng.normal(0.0, 0.1, len(robot.home)), robot.lower + 0.01, robot.upper - 0.01)
    track = pairs.track()

    def distances(at: np.ndarray, where: Pose) -> np.ndarray:
        track.move(pairs.positions(at, {}), where)
        return track.refine(near).copy()

    track.move(pairs.positions(q, {}), base)
    near = track.below(np.full(len(pairs.names), 0.4))
    near = near[track.bounds[near] > 0.005]
    gradients = track.gradients(near)
    step, columns = 1e-4, []
    for joint in np.eye(len(q)):
        columns.append((distances(q + step * joint, base) - distances(q - step * joint, base)) / (2 * step))
    if robot.drive is not None:
        ahead = rotation_matrix(base.orientation_xyzw) @ [step, 0.0, 0.0]
        turn = rotation_matrix(base.orientation_xyzw) @ rotation_matrix(np.array([0.0, 0.0, step / 2, 1.0]))
        here = distances(q, base)
        columns.append((distances(q, Pose(base.position + ahead, base.orientation_xyzw)) - here) / step)
        columns.append((distances(q, Pose(base.position, quaternion_xyzw(turn))) - here) / step)
        columns = columns[-2:] if not len(near) else columns
    wrong = np.abs(np.array(columns).T - gradients[:, : len(columns)]).max(axis=1)
    assert len(near) >= 3
    # Where two faces are parallel the nearest points jump, and there is no gradient: few pairs are so.
    assert np.median(wrong) < 5e-3
    assert np.mean(wrong < 2e-2) > 0.8


def test_which_pairs_may_touch() -> None:
    robot = load_robot("baxter")
    cup = Obstacle("cup", "cylinder", (0.03, 0.1), Pose(np.zeros(3), LEVEL))
    pairs = NearPairs(robot, things(0.0), {"right": [cup]})
    allowed = {frozenset(names) for names, may in zip(pairs.names, pairs.contacts, strict=True) if may}
    assert frozenset(("l_gripper_l_finger", "ball")) in allowed
    assert frozenset(("cup", "table")) in allowed
    assert frozenset(("l_gripper_l_finger", "cup")) in allowed  # handed over
    assert frozenset(("left_hand", "ball")) not in allowed
    assert frozenset(("cup", "torso")) not in allowed


def test_near_pairs_of_a_collision_model_come_with_their_points() -> None:
    robot = load_robot("three_dof")
    tool = robot.forward_kinematics(robot.home).position
    ball = Obstacle("ball", "sphere", (0.02,), Pose(tool + [0.0, 0.0255, -0.014 - 0.036], LEVEL))
    found = CollisionModel(robot, [ball]).near(robot.home, 0.02)
    assert (found[0].first, found[0].second) == ("left_finger", "ball")
    assert found[0].distance == pytest.approx(0.016, abs=2e-6)
    np.testing.assert_allclose(found[0].point_on_first - found[0].point_on_second, [0, 0, 0.016], atol=1e-4)
    assert all(one.distance <= other.distance for one, other in zip(found, found[1:], strict=False))


def many_things() -> list[Obstacle]:
    """One of each kind, turned, where arms get to."""
    turned = quaternion_xyzw(rotation_matrix(np.array([0.2, -0.4, 0.1, 0.9])))
    corners = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.12, 0.0], [0.02, 0.03, 0.15], [0.08, 0.09, 0.05]])
    return [
        *things(-0.1),
        Obstacle("can", "cylinder", (0.04, 0.2), Pose(np.array([0.6, -0.2, 0.1]), turned)),
        Obstacle("brick", "box", (0.1, 0.2, 0.06), Pose(np.array([0.45, 0.35, 0.15]), turned)),
        Obstacle("rock", "hull", (), Pose(np.array([0.3, 0.1, 0.3]), turned), corners),
    ]


@pytest.mark.parametrize("name", ["three_dof", "baxter", "mico_segway"])
def test_planes_and_levers_are_never_above_the_distance(name: str) -> None:
    """Whatever was asked before, for small and for large motions, and whatever is in the hand."""
    robot, rng = load_robot(name), np.random.default_rng(11)
    cup = Obstacle("cup", "cylinder", (0.03, 0.1), Pose(np.array([0.0, 0.01, 0.04]), LEVEL))
    pairs = NearPairs(robot, many_things(), {next(iter(robot.arms)): [cup]})
    track, judge = pairs.track(), pairs.track()
    everything, base = np.arange(len(pairs.names)), robot.pose_base_in_world
    lower, upper = np.maximum(robot.lower, -np.pi), np.minimum(robot.upper, np.pi)
    q = robot.home
    for step in range(60):
        size = (1e-3, 0.05, 0.5)[step % 3]
        q = np.clip(q + rng.normal(0.0, size, len(q)), lower, upper)
        openings = {arm: float(rng.uniform(0.0, 0.04)) for arm in robot.arms}
        if robot.drive is not None:
            turn = rng.normal(0.0, size)
            shift = np.array([*rng.normal(0.0, size, 2), 0.0])
            base = Pose(base.position + shift, np.array([0.0, 0.0, np.sin(turn), np.cos(turn)]))
        positions = pairs.positions(q, openings)
        track.move(positions, base)
        judge.jump(positions, base)
        distances = judge.refine(everything)
        # The solver ends its search within two micrometres above the distance; bounds stay as far below it.
        assert np.all(track.bounds <= distances + 1e-9)
        near = track.below(rng.uniform(-0.01, 0.4, len(everything)))
        assert np.all(track.bounds <= distances + 1e-9)
        np.testing.assert_array_equal(track.bounds[near], distances[near])


def test_planes_are_as_good_as_the_solver() -> None:
    """Else nearly all would be left to the solver, which takes ten times as long."""
    robot = load_robot("baxter")
    pairs = NearPairs(robot, many_things())
    track, judge = pairs.track(), pairs.track()
    positions = pairs.positions(robot.home, {})
    track.move(positions, robot.pose_base_in_world)
    judge.jump(positions, robot.pose_base_in_world)
    distances = judge.refine(np.arange(len(pairs.names)))
    # A bound may end a hundredth of a per cent short; and 2 um below, as said above.
    assert not len(track.below(distances * 0.9999 - 5e-6))
    assert not track.exact[distances > 0.0].any()


@pytest.mark.parametrize("name", ["three_dof", "baxter", "mico_segway"])
def test_pairs_are_those_of_the_collision_model(name: str) -> None:
    robot = load_robot(name)
    held = {arm: [Obstacle(f"cup {arm}", "sphere", (0.03,), Pose(np.zeros(3), LEVEL))] for arm in robot.arms}
    for things_held in ({}, held):
        collision = CollisionModel(robot, many_things(), things_held)
        numbers = [(int(each.first), int(each.second)) for each in collision._geometry.collisionPairs]
        pairs = NearPairs(robot, many_things(), things_held)
        assert list(zip(pairs.firsts, pairs.seconds, strict=True)) == numbers
        assert list(pairs.names) == [(collision._names[a], collision._names[b]) for a, b in numbers]


def test_what_is_held_may_be_moved_in_the_hand() -> None:
    robot, arm = load_robot("baxter"), "left"
    stick = [Obstacle("stick", "box", (0.02, 0.02, 0.3), Pose(np.array([0.0, 0.0, 0.1]), LEVEL))]
    moved = [Obstacle("stick", "box", (0.02, 0.02, 0.3), Pose(np.array([0.0, 0.05, 0.3]), LEVEL))]
    pairs, wanted = NearPairs(robot, things(-0.1), {arm: stick}), NearPairs(robot, things(-0.1), {arm: moved})
    track, judge = pairs.track(), wanted.track()
    positions, base = pairs.positions(robot.home, {}), robot.pose_base_in_world
    everything = np.arange(len(pairs.names))
    for each in (track, judge):
        each.move(positions, base)
    before = track.refine(everything)
    track.shrink(pairs.place(things(-0.1), {arm: moved}))
    distances = judge.refine(everything)
    assert np.all(track.bounds <= distances + 2e-6)  # the solver's own
    assert np.abs(distances - before).max() > 0.05
    np.testing.assert_allclose(track.refine(everything), distances, atol=2e-6)
    np.testing.assert_allclose(pairs.scene.reach, wanted.scene.reach, atol=1e-12)  # rounding
