"""Robots in physics: they hold their posture, follow commands, keep limits, roll, and feel what they carry."""

from collections.abc import Iterator

import numpy as np
import pinocchio as pin
import pybullet
import pytest

from robots import Pose, RobotModel, load_robot
from robots.kinematics import configuration, rotation_matrix, whole_model
from robots.pose import FloatArray
from twin import JointCommand, SceneSpec, World, WorldState
from twin.ground import table_ground
from twin.physics import GRAVITY, Physics
from twin.robot_body import PARK_AFTER, RobotBody
from twin.world import TABLE_X, TABLE_Y

KINDS = {"three_dof": "board", "baxter": "table", "mico_segway": "table"}
ROBOTS = tuple(KINDS)
DT = World.DT


def alone(robot: str) -> World:
    """A robot without objects."""
    return World(SceneSpec.model_validate({"name": "alone", "kind": KINDS[robot], "robot": robot}))


def wide_open(world: World) -> list[float]:
    return [arm.gripper.max_opening for arm in world.robot.arms.values()]


def stand(world: World, seconds: float, openings: list[float] | None = None) -> None:
    still = JointCommand(np.zeros(len(world.robot.joint_names)), openings or wide_open(world))
    for _ in range(round(seconds / DT)):
        world.step(still)


def weight_behind_wrist(robot: RobotModel, arm: str) -> float:
    """Of everything behind the last movable joint before the tool, by the URDF [N]."""
    model = whole_model(robot.urdf_path)
    wrist = model.frames[model.getFrameId(robot.arms[arm].tool_frame)].parentJoint
    behind = [j for j in range(1, model.njoints) if wrist in list(model.supports[j])]
    return GRAVITY * float(sum(model.inertias[j].mass for j in behind))


def gravity_efforts(robot: RobotModel, state: WorldState) -> FloatArray:
    """What Pinocchio says that the driven joints need to hold still, (n,)."""
    model = whole_model(robot.urdf_path).copy()
    base = state.pose_base_in_world
    assert base is not None
    model.gravity.linear = rotation_matrix(base.orientation_xyzw).T @ [0.0, 0.0, -GRAVITY]
    gaps = {name: arm.gripper_opening for name, arm in zip(robot.arms, state.arms, strict=True)}
    joints = robot.expand(state.q, gaps)
    needed = pin.computeGeneralizedGravity(model, model.createData(), configuration(model, joints))
    return np.array([needed[model.joints[model.getJointId(name)].idx_v] for name in robot.joint_names])


@pytest.mark.parametrize("name", ROBOTS)
def test_the_home_posture_is_held_and_needs_what_gravity_asks(name: str) -> None:
    with alone(name) as world:
        for _ in range(20):
            stand(world, 0.1)
            # Issue: no more than 2 mrad. Measured: 2 microrad; sagging drives would show at once, S1 needs 50 Nm.
            np.testing.assert_allclose(world.joint_positions, world.robot.home, atol=1e-4)
        state = world.state()
        needed = gravity_efforts(world.robot, state)
        assert np.abs(needed).max() > 1.5
        assert state.effort is not None
        np.testing.assert_allclose(state.effort, needed, rtol=0.02, atol=1e-3)  # measured: 1e-6


@pytest.mark.parametrize("name", ROBOTS)
def test_joints_follow_commanded_velocities(name: str) -> None:
    with alone(name) as world:
        count, q, farthest = len(world.robot.joint_names), world.joint_positions.copy(), 0.0
        for step in range(240):
            velocity = 0.4 * world.robot.velocity * np.sin(np.pi * step / 120 + 0.5 * np.arange(count))
            velocity *= min(1.0, step / 24)  # drives have no infinite force: begin as a controller would
            world.step(JointCommand(velocity, wide_open(world)))
            q += velocity * DT
            np.testing.assert_allclose(world.joint_positions, q, atol=1e-4)  # measured: 5e-5 at Baxter's wrists
            np.testing.assert_allclose(world.joint_velocities, velocity, atol=0.02)  # what 1e-4 rad in a step is
            farthest = max(farthest, float(np.abs(q - world.robot.home).max()))
        assert farthest > 0.05


@pytest.mark.parametrize(("name", "sign", "seconds"), [("baxter", 1.0, 1.0), ("mico_segway", -1.0, 2.0)])
def test_limits_are_kept_whatever_is_commanded(name: str, sign: float, seconds: float) -> None:
    with alone(name) as world:
        robot = world.robot
        start = world.joint_positions
        wildly = sign * np.where(np.arange(len(robot.joint_names)) % 2, 50.0, -50.0)
        for step in range(1, round(seconds / DT)):
            world.step(JointCommand(wildly, wide_open(world)))
            q = world.joint_positions
            # Stopping dead from full speed overshoots by 3.5 mrad; starting so, joints drag each other along as much.
            assert np.all(q <= robot.upper + 5e-3) and np.all(q >= robot.lower - 5e-3)
            assert np.all(np.abs(q - start) <= robot.velocity * DT * step + 5e-3)
        at_stop = (np.abs(q - robot.upper) < 1e-3) | (np.abs(q - robot.lower) < 1e-3)
        assert at_stop.any()
        assert np.any(np.abs(q - start) > 0.9 * robot.velocity * seconds)


@pytest.mark.parametrize("name", ROBOTS)
def test_a_wrist_at_rest_feels_the_weight_of_the_hand_downwards(name: str) -> None:
    with alone(name) as world:
        stand(world, 0.5)
        for arm, state in zip(world.robot.arms, world.state().arms, strict=True):
            weight = weight_behind_wrist(world.robot, arm)
            # Bullet's own sensor gives 4% sideways here, because it leaves out the force that couples the fingers.
            np.testing.assert_allclose(state.wrist_wrench[:3], [0.0, 0.0, -weight], atol=1e-3 * weight)


@pytest.mark.parametrize("name", ROBOTS)
def test_a_moving_wrist_feels_the_change_of_the_hands_momentum(name: str) -> None:
    with alone(name) as world:
        body, client = world._robot.body, world._physics._client
        links = sorted(world._robot._hands[0].links)
        masses = np.array([pybullet.getDynamicsInfo(body, link, physicsClientId=client)[0] for link in links])
        count = len(world.robot.joint_names)
        before: FloatArray | None = None
        for step in range(240):
            velocity = 0.4 * world.robot.velocity * np.sin(3 * step * DT + np.arange(count)) * min(1.0, step / 120)
            twist = (-0.2 * np.sin(2 * step * DT), 0.4 * np.sin(step * DT)) if world.robot.drive else (0.0, 0.0)
            world.step(JointCommand(velocity, wide_open(world), twist))
            speeds = [
                pybullet.getLinkState(body, link, 1, 1, physicsClientId=client)[6] for link in links
            ]  # of their centres of mass
            momentum = masses @ np.array(speeds)
            if before is not None:
                change = (momentum - before) / DT
                expected = np.array([0.0, 0.0, -GRAVITY * masses.sum()]) - change
                # 1% of the weight: passive joints follow in the twin, but not to the last digit.
                felt = world.state().arms[0].wrist_wrench[:3]
                np.testing.assert_allclose(felt, expected, atol=0.01 * GRAVITY * masses.sum())
            before = momentum


def held_block(robot: str, shape: str) -> SceneSpec:
    block = {"id": 3, "shape": shape, "colour": "red", "position": (0.6, 0.3, 0.3)}
    return SceneSpec.model_validate(
        {"name": "held", "kind": KINDS[robot], "robot": robot, "objects": [block], "held": 3, "gripper_closed": True}
    )


@pytest.mark.parametrize(
    ("name", "shape"),  # a cube would stand with its edges in the Mico's hand, which is not along the axes at home
    [("three_dof", "cube"), ("baxter", "cube"), ("baxter", "cylinder"), ("mico_segway", "cylinder")],
)
def test_a_wrist_feels_the_weight_of_what_is_gripped_where_it_is(name: str, shape: str) -> None:
    with World(held_block(name, shape)) as world:
        stand(world, 1.0, [0.0] * len(world.robot.arms))
        state = world.state()
        assert state.arms[0].held == 3
        first = next(iter(world.robot.arms))
        weight = GRAVITY * world.model_of(3).mass
        felt = state.arms[0].wrist_wrench
        # Issue: 5%. It hangs still, so that nothing but its weight can be felt: 1%.
        np.testing.assert_allclose(
            felt[:3], [0.0, 0.0, -weight_behind_wrist(world.robot, first) - weight], atol=0.01 * weight
        )


def test_what_a_wrist_feels_is_what_the_joints_carry() -> None:
    """A hand presses on the table: the efforts beyond gravity's hold against what the wrist feels beyond its weight."""
    spec = {"name": "press", "kind": "table", "robot": "baxter", "gripper_position": (0.65, 0.25, 0.012)}
    with World(SceneSpec.model_validate(spec)) as world:
        robot, joints = world.robot, world.robot.slice_of("left")
        arm = robot.arms["left"]
        free = world.state().arms[0].wrist_wrench
        velocity = np.zeros(len(robot.joint_names))
        for _ in range(600):
            if world.touches():
                break
            jacobian = arm.jacobian(world.joint_positions[joints])
            velocity[joints] = np.linalg.pinv(jacobian) @ [0.0, 0.0, -0.02, 0.0, 0.0, 0.0]
            world.step(JointCommand(velocity, [0.0, 0.0]))
        stand(world, 0.5, [0.0, 0.0])
        assert world.touches() == {"ground"}
        state = world.state()
        pushed = state.arms[0].wrist_wrench - free
        assert pushed[2] > 5.0
        assert state.effort is not None
        model = whole_model(robot.urdf_path)
        q = configuration(model, robot.expand(state.q, {}))
        rows = [model.joints[model.getJointId(name)].idx_v for name in arm.joint_names]
        wrist = model.getJointId(arm.joint_names[-1])
        data = model.createData()
        pin.computeJointJacobians(model, data, q)
        jacobian = pin.getJointJacobian(model, data, wrist, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)[:, rows]
        extra = state.effort - gravity_efforts(robot, state)
        # The table also holds the tips against turning about the vertical, which contacts do not tell.
        missing = extra[joints] + jacobian.T @ pushed
        twisting = float(jacobian[5] @ missing / (jacobian[5] @ jacobian[5]))
        assert abs(twisting) <= 1.05 * arm.gripper.spinning * pushed[2]
        # 1% of the largest: the hand is not turned quite as before, and the efforts are the solver's.
        expected = -jacobian.T @ pushed + jacobian[5] * twisting
        np.testing.assert_allclose(extra[joints], expected, atol=0.01 * np.abs(expected).max())
        np.testing.assert_allclose(extra[joints.stop :], 0.0, atol=1e-3)


@pytest.fixture(scope="module")
def mico() -> Iterator[World]:
    with alone("mico_segway") as world:
        yield world


def place_and_yaw(world: World) -> tuple[FloatArray, float]:
    base = world.state().pose_base_in_world
    assert base is not None
    turn = rotation_matrix(base.orientation_xyzw)
    return base.position.copy(), float(np.arctan2(turn[1, 0], turn[0, 0]))


def roll(world: World, speed: float, rate: float, seconds: float, ramp: float = 0.5) -> tuple[float, float]:
    """Drive with ramps [s] at both ends; returns the integral of the command [m, rad]."""
    way = turned = 0.0
    count = round(seconds / DT)
    still = np.zeros(len(world.robot.joint_names))
    for step in range(count):
        part = min(1.0, step * DT / ramp, (count - step) * DT / ramp)
        world.step(JointCommand(still, wide_open(world), (part * speed, part * rate)))
        way, turned = way + part * speed * DT, turned + part * rate * DT
    return way, turned


def test_the_base_rolls_straight_and_turns_as_commanded_then_parks(mico: World) -> None:
    start, heading = place_and_yaw(mico)
    assert mico._robot.parked
    way, _ = roll(mico, -0.4, 0.0, 3.0)
    assert not mico._robot.parked
    assert way == pytest.approx(-1.0, abs=1e-9)
    stand(mico, PARK_AFTER - 2 * DT)
    assert not mico._robot.parked
    stand(mico, 3 * DT)
    assert mico._robot.parked
    end, yaw = place_and_yaw(mico)
    assert end[0] - start[0] == pytest.approx(way, rel=0.02)  # measured: 0.01%
    assert abs(end[1] - start[1]) < 0.002 and abs(yaw - heading) < 0.002
    _, turned = roll(mico, 0.0, 0.8, np.pi / 2 / 0.8 + 0.5)
    assert turned == pytest.approx(np.pi / 2, abs=1e-3)
    stand(mico, 1.0)
    after, now = place_and_yaw(mico)
    assert now - yaw == pytest.approx(turned, rel=0.02)  # measured: 0.15%
    assert np.linalg.norm(after - end) < 0.01
    # Along a circle: its radius is speed over rate.
    _, turned = roll(mico, -0.2, 0.4, 3.0)
    stand(mico, 1.0)
    there, last = place_and_yaw(mico)
    chord = 2 * (0.2 / 0.4) * np.sin(turned / 2)
    assert last - now == pytest.approx(turned, rel=0.02)
    assert np.linalg.norm(there - after) == pytest.approx(chord, rel=0.02)


def test_speeds_beyond_the_bases_limits_are_cut(mico: World) -> None:
    still = np.zeros(len(mico.robot.joint_names))
    start, heading = place_and_yaw(mico)
    for _ in range(120):
        mico.step(JointCommand(still, wide_open(mico), (0.0, 50.0)))
    _, yaw = place_and_yaw(mico)
    assert mico.robot.drive is not None
    assert 0.0 < yaw - heading <= mico.robot.drive.yaw_rate * 120 * DT + 1e-3
    stand(mico, 1.0)


def test_a_parked_base_stays_where_it_is_while_the_arm_moves_at_full_speed(mico: World) -> None:
    stand(mico, 1.0)
    assert mico._robot.parked
    start, heading = place_and_yaw(mico)
    farthest = turned = 0.0
    for step in range(1200):
        phase = np.arange(len(mico.robot.joint_names))
        swing = mico.robot.velocity * np.sign(np.sin(2 * np.pi * step * DT + phase))
        mico.step(JointCommand(swing, wide_open(mico)))
        if step % 10 == 0:
            now, yaw = place_and_yaw(mico)
            farthest = max(farthest, float(np.linalg.norm(now - start)))
            turned = max(turned, abs(yaw - heading))
    assert farthest < 1e-4 and turned < 1e-4  # measured: 0.1 micrometre; without the brake 0.1 mm


@pytest.mark.parametrize("name", ["baxter", "mico_segway"])
def test_a_robot_may_stand_elsewhere(name: str) -> None:
    """Its tools are where the model says, and its hands weigh what they weigh."""
    robot = load_robot(name)
    half = 0.6
    base = robot.pose_base_in_world
    moved = robot.placed_at(Pose(base.position + [-1.5, 0.8, 0.0], np.array([0, 0, np.sin(half), np.cos(half)])))
    physics = Physics(DT, 50)
    try:
        table_ground(robot, TABLE_X, TABLE_Y).build(physics)
        body = RobotBody(physics, moved)
        gaps = [arm.gripper.max_opening for arm in moved.arms.values()]
        body.place(moved.home, gaps, gaps)
        body.park()
        for _ in range(240):
            physics.step()
            body.sense()
        for number, (arm_name, arm) in enumerate(moved.arms.items()):
            expected = arm.forward_kinematics(moved.home[moved.slice_of(arm_name)])
            tool = body.tool(number)
            np.testing.assert_allclose(tool.position, expected.position, atol=5e-5)  # wheels sink in by 10 micrometres
            turn = rotation_matrix(tool.orientation_xyzw).T @ rotation_matrix(expected.orientation_xyzw)
            np.testing.assert_allclose(turn, np.eye(3), atol=1e-4)
            weight = weight_behind_wrist(moved, arm_name)
            np.testing.assert_allclose(body.wrist_wrench(number)[:3], [0, 0, -weight], atol=1e-3 * weight)
    finally:
        physics.close()
