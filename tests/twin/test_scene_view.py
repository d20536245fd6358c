"""What cameras see of scenes: all objects, where they are, from a live state as from recorded numbers."""

import numpy as np
import pytest

from robots import Pose, load_robot
from robots.kinematics import rotation_matrix
from robots.pose import FloatArray
from twin import JointCommand, LiveCamera, ObjectSpec, SceneSpec, TwinError, World
from twin.camera import CameraModel, RgbdFrame, make_renderer, render_states
from twin.camera.recorded import State
from twin.ground import Ground
from twin.scene_view import GROUND_ID, ROBOT_ID, RobotState, SceneView, robot_state
from twin.state import ObjectState

CAMERAS = {"tabletop": "chest", "ordering": "base"}
LEAST_PIXELS = 30
SEEDS = range(6)


def view_of(world: World) -> SceneView:
    return SceneView(world.spec, world.robot, world.ground)


def look(world: World, name: str) -> tuple[RgbdFrame, CameraModel, Pose]:
    view, state = view_of(world), world.state()
    robot, camera = robot_state(world.robot, state), view.camera(name)
    eye = view.camera_pose(name, robot)
    with make_renderer(view.geometry, camera) as renderer:
        return renderer.render(view.poses(robot, state.objects), eye), camera, eye


def in_camera(eye: Pose, point: FloatArray) -> FloatArray:
    return np.asarray(rotation_matrix(eye.orientation_xyzw).T @ (point - eye.position))


@pytest.mark.parametrize("scene", list(CAMERAS))
def test_the_robots_own_camera_sees_all_objects_where_they_are(scene: str) -> None:
    seen = hidden = 0
    for seed in SEEDS:
        with World.from_scene(scene, seed=seed) as world:
            frame, camera, eye = look(world, CAMERAS[scene])
            for thing in world.state().objects:
                pixels = frame.mask == thing.id
                if pixels.sum() <= LEAST_PIXELS:
                    hidden += 1
                    continue
                seen += 1
                # Back from pixels and depth to points: they lie on the object, wherever it is turned.
                rows, columns = np.nonzero(pixels)
                depth = frame.depth[pixels].astype(float)
                x = (columns - camera.cx) / camera.fx * depth
                y = (rows - camera.cy) / camera.fy * depth
                turn = rotation_matrix(eye.orientation_xyzw)
                points = np.column_stack((x, y, depth)) @ turn.T + eye.position
                own = rotation_matrix(thing.pose_object_in_world.orientation_xyzw)
                local = (points - thing.pose_object_in_world.position) @ own
                # Half a pixel of a steep surface is some millimetres.
                assert np.all(np.abs(local) <= world.model_of(thing.id).half_extents + 0.004), (seed, thing.id)
    assert hidden <= 0.03 * (seen + hidden)


@pytest.mark.parametrize("name", ["tabletop", "ordering"])
def test_the_depth_at_a_balls_middle_is_its_distance_less_its_radius(name: str) -> None:
    robot, place = ("baxter", (0.68, 0.05)) if name == "tabletop" else ("mico_segway", (0.55, 0.05))
    ball = ObjectSpec(id=4, shape="sphere", colour="red", position=(*place, 0.019))
    with World(SceneSpec(name=name, kind="table", robot=robot, objects=(ball,))) as world:
        frame, camera, eye = look(world, CAMERAS[name])
        centre = in_camera(eye, world.state().objects[0].pose_object_in_world.position)
        column = round(camera.fx * centre[0] / centre[2] + camera.cx)
        row = round(camera.fy * centre[1] / centre[2] + camera.cy)
        assert frame.mask[row, column] == 4
        towards = np.array([(column - camera.cx) / camera.fx, (row - camera.cy) / camera.fy, 1.0])
        near = np.linalg.norm(centre) - 0.019  # along the ray; depth is along the optical axis
        assert frame.depth[row, column] == pytest.approx(near / np.linalg.norm(towards), abs=0.002)
        assert {GROUND_ID, 4} <= set(np.unique(frame.mask).tolist())


@pytest.mark.parametrize("scene", list(CAMERAS))
def test_links_are_drawn_where_physics_has_them(scene: str) -> None:
    with World.from_scene(scene, seed=1) as world:
        count = len(world.robot.joint_names)
        openings = [0.5 * arm.gripper.max_opening for arm in world.robot.arms.values()]
        twist = (-0.2, 0.3) if world.robot.drive else (0.0, 0.0)
        for step in range(120):
            velocity = 0.3 * world.robot.velocity * np.sin(step / 40 + np.arange(count))
            world.step(JointCommand(velocity, openings, twist))
        view, state = view_of(world), world.state()
        drawn = view.poses(robot_state(world.robot, state), state.objects)
        body, physics = world._robot.body, world._physics
        links = physics.links(body)
        fingers = {link for hand in world._robot._hands for side in hand.finger_links for link in side}
        compared = set()
        for shape, matrix in zip(view._visuals.visuals, drawn, strict=False):
            if shape.link not in links or shape.link.endswith("wheel"):
                continue  # wheels turn, which a round thing does not show and a demo does not record
            position, orientation = physics.link_pose(body, links[shape.link])
            # A recorded gap is that of both fingers together, and passive tips give way a little.
            near = 2e-3 if links[shape.link] in fingers else 1e-5
            np.testing.assert_allclose(matrix[:3, 3], position, atol=near, err_msg=shape.link)
            off = matrix[:3, :3].T @ rotation_matrix(np.array(orientation))
            np.testing.assert_allclose(off, np.eye(3), atol=10 * near, err_msg=shape.link)
            compared.add(shape.link)
        assert len(compared) > 12


def test_the_view_of_objects_follows_their_poses() -> None:
    with World.from_scene("tabletop", seed=2) as world:
        view, state = view_of(world), world.state()
        robot = robot_state(world.robot, state)
        before = view.poses(robot, state.objects)
        shifted = [
            ObjectState(
                each.id,
                Pose(each.pose_object_in_world.position + [0.1, 0, 0], each.pose_object_in_world.orientation_xyzw),
            )
            for each in state.objects
        ]
        after = view.poses(robot, shifted)
        parts = [len(each.object_model().visuals) for each in world.spec.objects]
        moved = np.zeros(len(before))
        moved[-sum(parts) :] = 0.1
        np.testing.assert_allclose(after[:, 0, 3] - before[:, 0, 3], moved, atol=1e-12)
        # The order in which a state lists objects means nothing.
        np.testing.assert_array_equal(view.poses(robot, reversed(shifted)), after)


def test_recorded_numbers_look_like_the_live_state() -> None:
    """What a demo records of a robot: joint positions, gaps by arm, and the base's pose."""
    with World.from_scene("tabletop", seed=3) as world:
        for _ in range(30):
            world.step(JointCommand(np.full(14, 0.2), [0.01, 0.03]))
        state, view = world.state(), view_of(world)
        live = robot_state(world.robot, state)
        base = state.pose_base_in_world
        assert base is not None
        gaps = [arm.gripper_opening for arm in state.arms]
        recorded = RobotState(
            np.array(state.q.tolist()),
            dict(zip(["left", "right"], gaps, strict=True)),
            Pose(np.array(base.position.tolist()), np.array(base.orientation_xyzw.tolist())),
        )
        assert gaps[0] < 0.03 < gaps[1] + 0.005
        np.testing.assert_array_equal(view.poses(live, state.objects), view.poses(recorded, state.objects))
        one, other = view.camera_pose("chest", live), view.camera_pose("chest", recorded)
        np.testing.assert_array_equal(one.position, other.position)


def test_the_camera_moves_with_the_base() -> None:
    robot = load_robot("mico_segway")
    view = SceneView(SceneSpec(name="bare", kind="table", robot="mico_segway"), robot, Ground(()))
    openings = {name: arm.gripper.max_opening for name, arm in robot.arms.items()}
    base = robot.pose_base_in_world
    half = np.pi / 4
    turned = Pose(base.position + [0.3, -0.2, 0.0], np.array([0.0, 0.0, np.sin(half), np.cos(half)]))
    here = view.camera_pose("base", RobotState(robot.home, openings, base))
    there = view.camera_pose("base", RobotState(robot.home, openings, turned))
    x, y, z = here.position - base.position
    np.testing.assert_allclose(there.position, turned.position + [-y, x, z], atol=1e-9)
    one, other = rotation_matrix(here.orientation_xyzw), rotation_matrix(there.orientation_xyzw)
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(other, quarter @ one, atol=1e-9)
    assert here.position[2] > 0.2 and one[2, 2] < 0  # it looks down at the table


def test_a_recorded_run_rendered_elsewhere_is_the_same_run() -> None:
    with World.from_scene("ordering", seed=5) as world:
        view = view_of(world)
        camera = view.camera("base", 80, 60)
        states: list[State] = []
        for step in range(30):
            world.step(JointCommand(0.5 * world.robot.velocity, 0.05, (-0.3, 0.0)))
            if step % 10 == 9:
                state = world.state()
                robot = robot_state(world.robot, state)
                states.append((view.poses(robot, state.objects), view.camera_pose("base", robot)))
    here = list(render_states(view.geometry, camera, states, processes=0))
    there = list(render_states(view.geometry, camera, states, processes=1))
    assert len(here) == len(there) == 3
    for mine, theirs in zip(here, there, strict=True):
        np.testing.assert_array_equal(mine.colour, theirs.colour)
        np.testing.assert_array_equal(mine.depth, theirs.depth)
        np.testing.assert_array_equal(mine.mask, theirs.mask)
    assert any((here[0].depth != frame.depth).any() for frame in here[1:])


def test_a_live_camera_sees_what_the_view_sees_and_noise_is_asked_for() -> None:
    with World.from_scene("ordering", seed=6) as world, LiveCamera(world, "base", 160, 120) as live:
        clean = live.frame()
        view, state = view_of(world), world.state()
        robot = robot_state(world.robot, state)
        with make_renderer(view.geometry, view.camera("base", 160, 120)) as renderer:
            seen = renderer.render(view.poses(robot, state.objects), view.camera_pose("base", robot))
        np.testing.assert_array_equal(clean.colour, seen.colour)
        np.testing.assert_array_equal(clean.mask, seen.mask)
        noisy, again = live.frame(np.random.default_rng(1)), live.frame(np.random.default_rng(1))
        assert (noisy.depth != clean.depth).mean() > 0.3
        np.testing.assert_array_equal(noisy.depth, again.depth)
        assert {0, ROBOT_ID, GROUND_ID} & set(np.unique(clean.mask).tolist()) >= {0, GROUND_ID}
        with pytest.raises(TwinError, match="mico_segway has no camera 'chest'; it has base"):
            LiveCamera(world, "chest")


def test_unknown_cameras_missing_objects_and_ids_that_cannot_be_seen_are_named() -> None:
    with World.from_scene("tabletop", seed=0) as world:
        view, state = view_of(world), world.state()
        robot = robot_state(world.robot, state)
        for ask in (view.camera, lambda name: view.camera_pose(name, robot)):
            with pytest.raises(TwinError, match="baxter has no camera 'head'; it has chest"):
                ask("head")
        ids = ", ".join(str(each.id) for each in world.spec.objects)
        with pytest.raises(TwinError, match=f"the state has no object {state.objects[1].id}; the scene's are {ids}"):
            view.poses(robot, state.objects[:1] + state.objects[2:])
        block = ObjectSpec(id=ROBOT_ID, shape="cube", colour="red", position=(0.6, 0.0, 0.019))
        bad = world.spec.model_copy(update={"objects": (block,)})
        with pytest.raises(TwinError, match=r"object id 2000000000 cannot be seen: .* 0..1999999999"):
            SceneView(bad, world.robot, world.ground)
    robot_without = load_robot("three_dof")
    bare = SceneView(SceneSpec(), robot_without, Ground(()))
    with pytest.raises(TwinError, match="three_dof has no camera 'chest'; it has none"):
        bare.camera("chest")
