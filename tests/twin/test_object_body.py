"""Objects in physics: they stand still where they are put, are hollow where they look so, and keep their frame."""

from collections.abc import Iterator

import numpy as np
import pybullet
import pytest
from scipy.spatial.transform import Rotation

from robots.pose import FloatArray
from twin import ObjectSpec
from twin.board import ALL_SHAPES
from twin.object_body import ObjectBody
from twin.objects import CATALOGUES, object_model
from twin.physics import Physics

NAMES = [name for names in CATALOGUES.values() for name in names]
HOLLOW = ("bowl", "mug", "cup", "tub")
DT = 1 / 240


@pytest.fixture
def physics() -> Iterator[Physics]:
    client = Physics(DT, 50)
    client.set_friction(client.add_box((3, 3, 0.05), (0, 0, -0.05), 0.0, (1, 1, 1)), -1, 1.0)
    yield client
    client.close()


def stand(physics: Physics, number: int, name: str, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> ObjectBody:
    """Stand a catalogue's object on the ground, or `z` above it [m], turned by its number."""
    height = float(object_model(name).half_extents[2]) + z
    spec = ObjectSpec.of_model(number, name, (x, y, height), 0.7 * number)
    return ObjectBody(physics, spec, np.array(spec.position))


def place(body: ObjectBody) -> tuple[FloatArray, Rotation]:
    pose = body.state().pose_object_in_world
    return pose.position.copy(), Rotation.from_quat(pose.orientation_xyzw.copy())


def test_every_object_rests_where_it_is_put(physics: Physics) -> None:
    bodies = [stand(physics, number, name, number % 10 / 4, number // 10 / 4) for number, name in enumerate(NAMES)]
    for number, shape in enumerate(ALL_SHAPES):
        spec = ObjectSpec(id=number, shape=shape, colour="black", position=(-1, number / 4, 0.019), yaw=0.3)
        bodies.append(ObjectBody(physics, spec, np.array(spec.position)))
    before = [place(body) for body in bodies]
    for number, (position, turn) in enumerate(before[: len(NAMES)]):
        np.testing.assert_allclose(position[:2], [number % 10 / 4, number // 10 / 4], atol=1e-12)
        assert (Rotation.from_euler("z", -0.7 * number) * turn).magnitude() < 1e-7
    for _ in range(240):
        physics.step()
    for body, (position, turn) in zip(bodies, before, strict=True):
        now, turned = place(body)
        assert np.linalg.norm(now - position) < 0.0005, body.id  # measured: 0.03 mm
        assert np.degrees((turned * turn.inv()).magnitude()) < 0.2, body.id  # measured: 0.02 degrees


@pytest.mark.parametrize("name", [next(n for n in NAMES if n.endswith(shape)) for shape in HOLLOW])
def test_a_ball_dropped_into_a_hollow_object_stays_inside(physics: Physics, name: str) -> None:
    vessel = stand(physics, 3, name)
    model = object_model(name)
    radius, top = 0.008, 2 * float(model.half_extents[2])
    inside = np.min(model.half_extents[:2])
    axis = place(vessel)[1].apply([-model.half_extents[0] + inside, 0, 0])  # a mug's frame is not on its cup's axis
    client = physics._client
    ball = pybullet.createMultiBody(
        0.01,
        pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=radius, physicsClientId=client),
        basePosition=[axis[0] + 0.006, axis[1], top + 0.03],
        physicsClientId=client,
    )
    pybullet.changeDynamics(ball, -1, rollingFriction=0.001, physicsClientId=client)
    for _ in range(600):
        physics.step()
    x, y, z = physics.base_pose(ball)[0]
    assert np.hypot(x - axis[0], y - axis[1]) < inside - radius
    assert radius < z < radius + 0.012  # on the floor, which is 4 to 6 mm thick
    assert z + radius < top
    speed = np.linalg.norm(pybullet.getBaseVelocity(ball, physicsClientId=client)[0])
    assert speed < 0.005
    assert abs(place(vessel)[0][2] - top / 2) < 0.001


def test_a_hull_feels_as_large_as_it_looks(physics: Physics) -> None:
    """The margin that Bullet puts around hulls is made up for: a ray meets the wall where it is drawn."""
    mug = object_model("red_mug")
    body = stand(physics, 0, "red_mug")
    for grasp in mug.grasps[1:4]:
        out = np.sign(grasp.closing @ grasp.centre) * grasp.closing
        pad = grasp.centre + out * grasp.width / 2 + place(body)[0]
        hit = pybullet.rayTest(
            (pad + 0.02 * out).tolist(), (pad - 0.02 * out).tolist(), physicsClientId=physics._client
        )
        assert hit[0][0] == body.body
        np.testing.assert_allclose(hit[0][3], pad, atol=1e-4)  # Bullet's ray casting is that fine


def test_mass_and_inertia_reach_physics(physics: Physics) -> None:
    for name in ("green_mug", "gray_fork", "large_red_bottle"):
        model = object_model(name)
        body = stand(physics, 1, name)
        info = pybullet.getDynamicsInfo(body.body, -1, physicsClientId=physics._client)
        assert info[0] == pytest.approx(model.mass)
        np.testing.assert_allclose(sorted(info[2]), np.linalg.eigvalsh(model.inertia), rtol=1e-3)
        axes = Rotation.from_quat(info[4]).as_matrix()
        np.testing.assert_allclose(axes @ np.diag(info[2]) @ axes.T, model.inertia, atol=1e-3 * np.trace(model.inertia))
        np.testing.assert_allclose(info[3], model.centre_of_mass, atol=1e-12)


def test_the_frame_follows_a_tumbling_object(physics: Physics) -> None:
    body = stand(physics, 2, "blue_mug", z=0.3)
    client = physics._client
    pybullet.resetBaseVelocity(body.body, [0, 0, 0], [3, 2, 1], physicsClientId=client)
    local = pybullet.getDynamicsInfo(body.body, -1, physicsClientId=client)[3:5]
    for _ in range(40):
        physics.step()
    position, turn = place(body)
    centre, axes = physics.base_pose(body.body)
    np.testing.assert_allclose(position + turn.apply(local[0]), centre, atol=1e-12)
    assert ((turn * Rotation.from_quat(local[1])).inv() * Rotation.from_quat(axes)).magnitude() < 1e-9
    assert turn.magnitude() > 0.1


def test_obstacles_are_the_parts_where_they_are(physics: Physics) -> None:
    body = stand(physics, 4, "large_blue_bottle", 0.2, 0.1)
    kinds = [each.kind for each in body.obstacles()]
    assert kinds == ["cylinder", "hull", "cylinder", "cylinder"]
    assert {each.name for each in body.obstacles()} == {"4"}
    highest = max(each.pose_obstacle_in_world.position[2] + each.size[1] / 2 for each in body.obstacles() if each.size)
    assert highest == pytest.approx(0.2, abs=1e-9)


def test_two_runs_agree_bit_for_bit() -> None:
    ends = []
    for _ in range(2):
        client = Physics(DT, 50)
        client.add_box((1, 1, 0.05), (0, 0, -0.05), 0.0, (1, 1, 1))
        bodies = [stand(client, 1, "white_bowl"), stand(client, 2, "red_apple", 0.02, 0.01, 0.08)]
        for _ in range(200):
            client.step()
        ends.append([client.base_pose(body.body) for body in bodies])
        client.close()
    assert ends[0] == ends[1]


def test_an_unmoved_object_gives_the_same_state_again(physics: Physics) -> None:
    body = stand(physics, 1, "red_mug")
    assert body.state() is body.state()
