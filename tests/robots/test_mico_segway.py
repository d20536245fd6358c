"""The Mico on its Segway: published numbers, kinematics, a hand that holds, wheels that go where they turn."""

import math
import runpy
import sysconfig
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pinocchio as pin
import pybullet
import pytest

from robots.urdf import read_urdf

REPOSITORY = Path(__file__).resolve().parents[2]
URDF = REPOSITORY / "robots" / "mico_segway" / "mico_segway.urdf"
SHARE = Path(sysconfig.get_paths()["purelib"]) / "cmeel.prefix" / "share"
ARM = [f"joint_{number}" for number in range(1, 7)]
WHEELS, FINGERS, TIPS = ("wheel_left", "wheel_right"), ("finger_1", "finger_2"), ("finger_tip_1", "finger_tip_2")
PARALLEL = read_urdf(URDF).joints["finger_tip_1"].mimic.offset  # type: ignore[union-attr]
HOME = np.array([0.2256, 2.8153, 4.7343, 0.2382, -1.1348, 0.5665])
SIDE = np.array([0.26164, 1.86219, 5.33741, -0.35134, 1.87292, -0.51203])
"""The tool 0.45 m before and 80 mm over the arm's base, 20 degrees down."""
TOP = np.array([0.13549, 2.06114, 3.96071, 0.42581, -1.47348, 0.56131])
"""The same place and 15 mm higher, straight down."""
STEP = 1 / 240
RADIUS, TRACK = 0.46228 / 2, 0.48122
MODEL = pin.buildModelFromUrdf(str(URDF))
DATA = MODEL.createData()


def configuration(positions: dict[str, float]) -> np.ndarray:
    """Pinocchio's (nq,), in which a continuous joint is a cosine and a sine."""
    full: np.ndarray = pin.neutral(MODEL)
    for name, value in positions.items():
        joint = MODEL.joints[MODEL.getJointId(name)]
        full[joint.idx_q : joint.idx_q + joint.nq] = (math.cos(value), math.sin(value)) if joint.nq == 2 else value
    return full


def placement(frame: str, positions: dict[str, float]) -> pin.SE3:
    pin.framesForwardKinematics(MODEL, DATA, configuration(positions))
    placed: pin.SE3 = DATA.oMf[MODEL.getFrameId(frame)].copy()
    return placed


def hand_at(q: np.ndarray, finger: float) -> dict[str, float]:
    """A posture of the arm with both fingers at one angle and the tips where they follow to."""
    fingers = dict.fromkeys(FINGERS, finger) | dict.fromkeys(TIPS, max(0.0, PARALLEL - finger))
    return dict(zip(ARM, q, strict=True)) | fingers


def pads_in_tool(finger: float) -> tuple[pin.SE3, pin.SE3]:
    tool = placement("tool", hand_at(HOME, finger)).inverse()
    first, second = (placement(f"pad_{number}", hand_at(HOME, finger)) for number in (1, 2))
    return tool * first, tool * second


class Twin:
    """The robot in a PyBullet client of its own, shapes of contact only."""

    def __init__(self, urdf: Path, *, fixed: bool) -> None:
        self.client = pybullet.connect(pybullet.DIRECT)
        pybullet.setGravity(0, 0, -9.81, physicsClientId=self.client)
        pybullet.setPhysicsEngineParameter(
            fixedTimeStep=STEP, contactERP=0.8, contactBreakingThreshold=0.002, physicsClientId=self.client
        )
        flags = pybullet.URDF_USE_INERTIA_FROM_FILE | pybullet.URDF_USE_IMPLICIT_CYLINDER
        self.body = pybullet.loadURDF(str(urdf), useFixedBase=fixed, flags=flags, physicsClientId=self.client)
        count = pybullet.getNumJoints(self.body, physicsClientId=self.client)
        infos = [pybullet.getJointInfo(self.body, joint, physicsClientId=self.client) for joint in range(count)]
        self.joints = {info[1].decode(): info[0] for info in infos}
        self.links = {info[12].decode(): info[0] for info in infos}
        self.force = {info[1].decode(): info[10] for info in infos}

    def friction(self, body: int, link: int, lateral: float, spinning: float = 0.0) -> None:
        pybullet.changeDynamics(
            body,
            link,
            lateralFriction=lateral,
            spinningFriction=spinning,
            frictionAnchor=True,
            physicsClientId=self.client,
        )

    def place(self, positions: dict[str, float]) -> None:
        for name, value in positions.items():
            pybullet.resetJointState(self.body, self.joints[name], value, physicsClientId=self.client)

    def at(self, name: str) -> float:
        return float(pybullet.getJointState(self.body, self.joints[name], physicsClientId=self.client)[0])

    def hold(self, name: str, target: float, force: float, speed: float = 10.0) -> None:
        mode = {"controlMode": pybullet.POSITION_CONTROL, "positionGain": 1, "velocityGain": 1, "maxVelocity": speed}
        pybullet.setJointMotorControl2(
            self.body,
            self.joints[name],
            targetPosition=target,
            force=force,
            **mode,
            physicsClientId=self.client,
        )

    def frame(self, link: str) -> pin.SE3:
        state = pybullet.getLinkState(
            self.body, self.links[link], computeForwardKinematics=True, physicsClientId=self.client
        )
        return pin.XYZQUATToSE3(np.array([*state[4], *state[5]]))

    def add(self, shape: int, position: list[float], mass: float, **sizes: object) -> int:
        felt = pybullet.createCollisionShape(shape, **sizes, physicsClientId=self.client)
        return int(pybullet.createMultiBody(mass, felt, -1, position, physicsClientId=self.client))

    def pose(self, body: int) -> pin.SE3:
        position, turn = pybullet.getBasePositionAndOrientation(body, physicsClientId=self.client)
        return pin.XYZQUATToSE3(np.array([*position, *turn]))

    def step(self, q: np.ndarray) -> None:
        for name, target in zip(ARM, q, strict=True):
            self.hold(name, target, self.force[name])
        for finger, tip in zip(FINGERS, TIPS, strict=True):
            self.hold(tip, max(0.0, PARALLEL - self.at(finger)), 1.5)
        pybullet.stepSimulation(physicsClientId=self.client)


@pytest.fixture(scope="module")
def bare_urdf(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The URDF without what is drawn."""
    tree = ElementTree.parse(URDF)
    for link in tree.getroot().iter("link"):
        for visual in link.findall("visual"):
            link.remove(visual)
    path = tmp_path_factory.mktemp("mico") / "mico.urdf"
    tree.write(path)
    return path


@pytest.fixture(params=[True])
def twin(bare_urdf: Path, request: pytest.FixtureRequest) -> Iterator[Twin]:
    made = Twin(bare_urdf, fixed=request.param)
    yield made
    pybullet.disconnect(made.client)


def test_the_file_is_what_its_script_writes() -> None:
    script = runpy.run_path(str(REPOSITORY / "tools" / "write_mico_segway.py"))
    assert URDF.read_text(encoding="utf-8") == script["robot"]()


def test_limits_and_masses_are_the_published_ones() -> None:
    joints = read_urdf(URDF).joints
    degrees = np.degrees([[joints[name].lower, joints[name].upper] for name in ("joint_2", "joint_3")])
    np.testing.assert_allclose(degrees, [[50, 310], [35, 325]], atol=1e-9)
    np.testing.assert_allclose(np.degrees([joints[name].velocity for name in ARM]), [36] * 3 + [48] * 3, atol=1e-9)
    assert all(math.isinf(joints[name].upper) for name in ("joint_1", "joint_4", "joint_5", "joint_6", *WHEELS))
    assert [(joints[name].lower, joints[name].upper) for name in (*FINGERS, *TIPS)] == [(0, 1.51)] * 2 + [(0, 2)] * 2
    mass = {link.get("name"): link.find("inertial/mass") for link in ElementTree.parse(URDF).getroot().iter("link")}
    names = ("chassis", "left_wheel", "arm_base", "shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "hand")
    told = [float(element.get("value", "")) for name in names if (element := mass[name]) is not None]
    assert told == [29.76, 4.20, 0.468, 0.748, 0.860, 0.606, 0.426, 0.426, 0.78]


def test_every_mesh_is_in_the_installed_package() -> None:
    names = {element.get("filename", "") for element in ElementTree.parse(URDF).getroot().iter("mesh")}
    assert len(names) == 7
    assert all((SHARE / name.removeprefix("package://")).is_file() for name in names)


def published_tip(q: np.ndarray) -> np.ndarray:
    """The published DH parameters of the m1n6s200: the tip in the frame of the arm's base, (3,) [m]."""
    a = (0, 0.29, 0, 0, 0, 0)
    d = (0.2755, 0, -0.007, -0.16608, -0.08556, -0.20278)
    alpha = (math.pi / 2, math.pi, math.pi / 2, math.pi / 3, math.pi / 3, math.pi)
    theta = q * (-1, 1, 1, 1, 1, 1) + (0, -math.pi / 2, math.pi / 2, 0, -math.pi, math.pi / 2)
    reached = np.eye(4)
    for turn, along, out, twist in zip(theta, d, a, alpha, strict=True):
        ct, st, ca, sa = math.cos(turn), math.sin(turn), math.cos(twist), math.sin(twist)
        row = [[ct, -st * ca, st * sa, out * ct], [st, ct * ca, -ct * sa, out * st], [0, sa, ca, along], [0, 0, 0, 1]]
        reached = reached @ np.array(row)
    return reached[:3, 3]


def test_the_end_effector_is_where_the_published_parameters_put_it() -> None:
    def tip(q: np.ndarray) -> np.ndarray:
        positions = dict(zip(ARM, q, strict=True))
        position: np.ndarray = (placement("arm_base", {}).actInv(placement("end_effector", positions))).translation
        return position

    check = np.array([0, math.pi, math.pi, 0, 0, 0])
    # The two descriptions are rounded to 0.1 mm in several places each, and differ by up to 0.3 mm.
    np.testing.assert_allclose(tip(check), [0, 0.0671, 0.9771], atol=0.0005)
    for q in np.random.default_rng(0).uniform(0, 2 * math.pi, (2000, 6)):
        assert np.linalg.norm(tip(q) - published_tip(q)) < 0.0005


def test_pinocchio_and_pybullet_agree_on_every_frame(twin: Twin) -> None:
    random = np.random.default_rng(1)
    for _ in range(50):
        positions = {name: random.uniform(0, 1.5) for name in MODEL.names[1:]}
        twin.place(positions)
        for link in twin.links:
            # PyBullet reads the URDF's numbers in single precision.
            np.testing.assert_allclose(twin.frame(link).np, placement(link, positions).np, atol=1e-6)


@pytest.mark.parametrize(("finger", "gap"), [(0.0, 0.1180), (0.6, 0.0778), (0.8, 0.0609), (1.0, 0.0434)])
def test_the_pads_face_each_other_squarely_over_the_whole_range(finger: float, gap: float) -> None:
    first, second = pads_in_tool(finger)
    across = second.translation - first.translation
    # Gaps are tabulated to 0.1 mm.
    assert np.linalg.norm(across) == pytest.approx(gap, abs=1e-4)
    np.testing.assert_allclose(first.rotation[:, 1], across / np.linalg.norm(across), atol=1e-9)
    np.testing.assert_allclose(second.rotation[:, 1], -first.rotation[:, 1], atol=1e-9)
    np.testing.assert_allclose(np.abs(first.rotation[:, 1]), [0, 1, 0], atol=1e-9)


def test_the_tool_is_between_the_pads_that_hold_a_cup() -> None:
    for finger in (0.81, 0.9, 1.04):  # gaps of 60, 52 and 40 mm
        first, second = pads_in_tool(finger)
        # On their arcs the pads move by a millimetre along the hand.
        np.testing.assert_allclose((first.translation + second.translation) / 2, 0, atol=0.0011)


def test_home_and_grasp_postures_touch_only_neighbours() -> None:
    geometry = pin.buildGeomFromUrdf(MODEL, str(URDF), pin.GeometryType.COLLISION)
    geometry.addAllCollisionPairs()
    data = geometry.createData()
    touching = set()
    for q in (HOME, SIDE, TOP):
        pin.computeCollisions(MODEL, DATA, geometry, data, configuration(hand_at(q, 0.6)), False)
        for pair, result in zip(geometry.collisionPairs, data.collisionResults, strict=True):
            frames = [MODEL.frames[geometry.geometryObjects[each].parentFrame] for each in (pair.first, pair.second)]
            if result.isCollision() and frames[0].name != frames[1].name:
                touching.add(frozenset(frame.name for frame in frames))
    joints = ElementTree.parse(URDF).getroot().iter("joint")
    neighbours = {
        frozenset((parent.get("link"), child.get("link")))
        for joint in joints
        if (parent := joint.find("parent")) is not None and (child := joint.find("child")) is not None
    }
    assert touching <= neighbours


@pytest.mark.parametrize("posture", [SIDE, TOP], ids=["side", "top"])
@pytest.mark.parametrize(("round_", "width", "mass"), [(True, 0.040, 0.2), (True, 0.070, 0.4), (False, 0.055, 0.6)])
def test_the_hand_lifts_and_holds_by_friction(
    twin: Twin, posture: np.ndarray, round_: bool, width: float, mass: float
) -> None:
    twin.place(hand_at(posture, 0.15))
    tool, height = twin.frame("tool").translation, 0.12
    foot = tool[2] - (0.095 if posture is TOP else 0.080)
    twin.add(pybullet.GEOM_BOX, [tool[0], tool[1], foot - 0.01], 0, halfExtents=[0.1, 0.1, 0.01])
    middle = [tool[0] + 0.003, tool[1] + 0.005, foot + height / 2]
    if round_:
        thing = twin.add(pybullet.GEOM_CYLINDER, middle, mass, radius=width / 2, height=height)
    else:
        thing = twin.add(pybullet.GEOM_BOX, middle, mass, halfExtents=[width / 2, width / 2, height / 2])
    for link in ("distal_1", "distal_2", "proximal_1", "proximal_2"):
        # Without friction against spinning, a cylinder turns on the two points on which PyBullet lets it touch.
        twin.friction(twin.body, twin.links[link], 1.0, spinning=0.01)
    twin.friction(thing, -1, 1.0, spinning=0.01)
    ends = (twin.body, twin.joints["finger_1"], twin.body, twin.joints["finger_2"])
    gear = pybullet.createConstraint(
        *ends, pybullet.JOINT_GEAR, [0, 1, 0], [0, 0, 0], [0, 0, 0], physicsClientId=twin.client
    )
    pybullet.changeConstraint(gear, gearRatio=-1, maxForce=50, erp=0.5, physicsClientId=twin.client)
    columns = [MODEL.joints[MODEL.getJointId(name)].idx_v for name in ARM]
    q, speeds = posture.copy(), [0.0] * 312 + [0.1] * 240 + [0.0] * 480  # close, lift by 0.1 m in 1 s, hold for 2 s
    for step, speed in enumerate(speeds):
        if speed:
            full = configuration(hand_at(q, 0.15))
            jacobian = pin.computeFrameJacobian(MODEL, DATA, full, MODEL.getFrameId("tool"), pin.LOCAL_WORLD_ALIGNED)
            q = q + np.linalg.solve(jacobian[:, columns], [0, 0, speed, 0, 0, 0]) * STEP
        for finger in FINGERS:
            twin.hold(finger, 1.45, force=1.5, speed=1.0)
        twin.step(q)
        if step == 311:
            held = twin.frame("tool").actInv(twin.pose(thing))
    slid = held.actInv(twin.frame("tool").actInv(twin.pose(thing)))
    assert twin.pose(thing).translation[2] - foot - height / 2 > 0.095
    # In 100 trials with random sizes, masses and places things slid by 3.1 mm and turned by 4.4 degrees at most.
    assert np.linalg.norm(slid.translation) < 0.004
    assert np.linalg.norm(pin.log3(slid.rotation)) < math.radians(5)


@pytest.mark.parametrize("twin", [False], indirect=True, ids=["floating"])
def test_the_base_goes_where_its_wheels_turn_and_stands_while_the_arm_moves(twin: Twin) -> None:
    ground = twin.add(pybullet.GEOM_BOX, [0, 0, -0.5], 0, halfExtents=[10, 10, 0.5])
    twin.friction(ground, -1, 1.0)
    for link, lateral in {"left_wheel": 1.0, "right_wheel": 1.0, "caster_front": 0.0, "caster_back": 0.0}.items():
        twin.friction(twin.body, twin.links[link], lateral)
    twin.place(hand_at(HOME, 0.6))

    def drive(forward: float, turn: float, q: np.ndarray = HOME) -> None:
        for wheel, side in zip(WHEELS, (-1, 1), strict=True):
            pybullet.setJointMotorControl2(
                twin.body,
                twin.joints[wheel],
                pybullet.VELOCITY_CONTROL,
                targetVelocity=(forward + side * turn * TRACK / 2) / RADIUS,
                force=twin.force[wheel],
                physicsClientId=twin.client,
            )
        for finger in FINGERS:
            twin.hold(finger, 0.6, 2.0)
        twin.step(q)

    def ramped(top: float, rate: float, total: float) -> list[float]:
        """Speeds that rise, stay and fall, and add up to a way."""
        rise = np.arange(0, top, rate * STEP)
        level = np.full(round((total - 2 * rise.sum() * STEP) / (top * STEP)), top)
        speeds = np.concatenate([rise, level, rise[::-1]])
        return list(speeds * total / (speeds.sum() * STEP))

    def stand() -> pin.SE3:
        for _ in range(60):
            drive(0, 0)
        return twin.pose(twin.body)

    start, turned = stand(), [twin.at(wheel) for wheel in WHEELS]
    for forward in ramped(0.5, 0.5, 1.0):
        drive(forward, 0)
    gone, turns = start.actInv(stand()).translation, np.array([twin.at(wheel) for wheel in WHEELS]) - turned
    # The wheels roll without slip: the way is theirs to the tenth of a millimetre, and 1 m to 2%.
    assert gone[0] == pytest.approx(RADIUS * turns.mean(), abs=2e-4)
    assert gone[0] == pytest.approx(1.0, abs=0.02)
    np.testing.assert_allclose(gone[1:], 0, atol=0.002)

    before, turned = twin.pose(twin.body), [twin.at(wheel) for wheel in WHEELS]
    for turn in ramped(1.0, 1.5, math.pi / 2):
        drive(0, turn)
    moved, turns = before.actInv(stand()), np.array([twin.at(wheel) for wheel in WHEELS]) - turned
    angle = math.atan2(moved.rotation[1, 0], moved.rotation[0, 0])
    assert angle == pytest.approx(RADIUS * (turns[1] - turns[0]) / TRACK, rel=0.02)
    assert angle == pytest.approx(math.pi / 2, rel=0.02)
    assert np.linalg.norm(moved.translation) < 0.01

    still, q = twin.pose(twin.body), HOME.copy()
    fastest = np.radians([36, 36, 36, 48, 48, 48])
    for step in range(480):
        q += fastest * (1 if step < 240 else -1) * (1, -1, 1, 1, -1, 1) * STEP
        drive(0, 0, q)
        slid = still.actInv(twin.pose(twin.body))
        # An arm at full speed, turned round at once, shoves the standing base by less than 1 mm and 0.1 degree.
        assert np.linalg.norm(slid.translation) < 0.001
        assert math.acos(min(1.0, slid.rotation[2, 2])) < math.radians(0.1)
