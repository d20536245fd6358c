import dataclasses

import numpy as np
import pytest

from learning.errors import PerceptionError
from learning.perception.observe import observe
from learning.perception.observe_camera import observe_camera_demo, observe_camera_world, perceive_camera_demo
from learning.perception.surface_colour import hsl_of
from robots.hand_dynamics import HandDynamics
from tests.learning.camera_demos import demo_of, robot, still, table
from twin import ObjectSpec, SceneSpec, World
from twin.objects import object_model

NAMES = (("small_red_can", 0.50, -0.10), ("small_blue_carton", 0.55, 0.12), ("small_green_tub", 0.44, 0.02))


def reaching(place: np.ndarray, count: int) -> np.ndarray:
    """Joints (count, n) that bring the Mico's tool straight from home to a place."""
    body = robot("mico_segway")
    goal = body.arm.inverse_kinematics(place, start=body.home, tolerance=1e-4).q
    return body.home + np.linspace(0.0, 1.0, count)[:, None] * (goal - body.home)


def test_every_object_is_found_where_it_stands_with_its_colour_and_size() -> None:
    spec = table(*NAMES)
    seen = observe_camera_demo(demo_of(spec, still(spec, 25)), np.random.default_rng(0))
    assert seen.location.shape == (len(seen.times), 3, 3)
    assert np.diff(seen.times) == pytest.approx(0.1, abs=0.04)  # states are a thirtieth of a second apart
    order = [int(np.linalg.norm(seen.location[0] - each.position, axis=1).argmin()) for each in spec.objects]
    assert sorted(order) == [0, 1, 2]
    for number, thing in zip(order, spec.objects, strict=True):
        # the mean over a second; what is left is bias of the seen side, 10 mm at most by the issue
        assert np.linalg.norm(seen.location[:, number].mean(axis=0) - thing.position) < 0.010
        height = 2 * thing.half_extents[2]
        assert seen.extent is not None
        assert seen.extent[-1, number, 2] == pytest.approx(height, abs=0.010)  # three pixels
        hue = np.median(seen.colour[:, number, 0])
        true = hsl_of(255 * np.array(thing.rgb))[0]
        assert abs((hue - true + 0.5) % 1.0 - 0.5) < 0.03  # shading keeps hue, noise of 2/255 does not
    assert np.allclose(seen.shape.sum(axis=2), 1.0)
    assert seen.visible is not None and seen.visible.all()
    assert set(seen.features) == {"size", "weight", "glimpsed_shape"}
    assert np.isnan(seen.features["weight"]).all()  # nothing was lifted


@pytest.mark.parametrize("gap", [0.02, 0.05])
def test_a_thing_before_another_is_another_thing(gap: float) -> None:
    """At the edge of the front one colour and depth are of different things, and some depth is missing."""
    centre = 0.50 + 0.0265 + gap + 0.033  # radii of a small and of a large can
    spec = table(("small_red_can", 0.50, 0.0), ("large_yellow_can", centre, 0.0), ("large_blue_can", 0.50, -0.1))
    with World(spec) as world:
        seen = observe_camera_world(world.state(), world.spec, np.random.default_rng(0))
    assert len(seen.object_ids) == 3
    for thing in spec.objects:
        away = np.linalg.norm(seen.location[-1] - thing.position, axis=1)
        assert away.min() < 0.012  # the back of a thing is not seen, and of one behind another not all of its front
        assert seen.extent is not None
        assert seen.extent[-1, away.argmin(), :2] == pytest.approx(2 * np.array(thing.half_extents[:2]), abs=0.012)


def test_a_white_mug_in_its_own_shade_is_white() -> None:
    mug = ObjectSpec.of_model(0, "white_mug", (0.62, 0.1, object_model("white_mug").half_extents[2]))
    tape = ObjectSpec.of_model(1, "gray_tape", (0.62, -0.15, object_model("gray_tape").half_extents[2]))
    with World(SceneSpec(name="shade", kind="table", robot="baxter", objects=(mug, tape))) as world:
        seen = observe_camera_world(world.state(), world.spec, np.random.default_rng(0))
    lightness = {
        each.model: np.median(seen.colour[:, np.linalg.norm(seen.location[-1] - each.position, axis=1).argmin(), 2])
        for each in (mug, tape)
    }
    assert lightness["white_mug"] > 0.8
    assert lightness["gray_tape"] == pytest.approx(0.5, abs=0.05)  # what is gray is not made white by that


def test_what_lies_in_a_bowl_is_seen_by_those_who_know_of_it() -> None:
    """The bowl's rim hides where the apple ends: without its colour the two are one thing."""
    apple = ObjectSpec.of_model(0, "orange_apple", (0.655, -0.137, 0.022))
    bowl = ObjectSpec.of_model(1, "blue_bowl", (0.655, -0.137, 0.022))
    with World(SceneSpec(name="in", kind="table", robot="baxter", objects=(apple, bowl))) as world:
        state, spec = world.state(), world.spec
    alone = observe_camera_world(state, spec, np.random.default_rng(0))
    both = observe_camera_world(state, spec, np.random.default_rng(0), apart=255.0 * np.array([apple.rgb]))
    other = observe_camera_world(state, spec, np.random.default_rng(0), apart=255.0 * np.array([[0.1, 0.6, 0.1]]))
    assert len(alone.object_ids) == len(other.object_ids) == 1
    assert len(both.object_ids) == 2
    hues = np.median(both.colour[..., 0], axis=0)
    seen = int(np.abs(hues - hsl_of(255 * np.array(apple.rgb))[0]).argmin())
    assert np.linalg.norm(both.location[-1, seen, :2] - apple.position[:2]) < 0.015


def test_the_same_seed_gives_the_same_observation() -> None:
    spec = table(NAMES[0])
    demo = demo_of(spec, still(spec, 7))
    one, other = (observe_camera_demo(demo, np.random.default_rng(3)) for _ in range(2))
    for name in ("location", "colour", "shape", "extent", "visible"):
        assert np.array_equal(getattr(one, name), getattr(other, name))


def test_identity_is_kept_while_the_hand_passes_in_front_and_the_hidden_stay_where_they_are() -> None:
    spec = table(("small_red_can", 0.50, -0.05), ("small_orange_can", 0.56, 0.08))
    out = reaching(np.array([0.42, 0.03, 0.06]), 30)
    q = np.concatenate((out, out[::-1]))
    seen = observe_camera_demo(demo_of(spec, still(spec, len(q)), q), np.random.default_rng(1))
    assert seen.location.shape[1] == 2
    assert seen.visible is not None and not seen.visible.all()  # the arm was in the way
    true = np.array([each.position for each in spec.objects])
    order = np.linalg.norm(seen.location[0][:, None] - true, axis=2).argmin(axis=1)
    errors = np.linalg.norm(seen.location - true[order], axis=2)
    assert np.median(errors) < 0.010
    assert errors.max() < 0.025  # never nearer to the other, and never led away by the arm


def test_what_is_carried_behind_the_arm_moves_with_the_hand_and_its_weight_is_felt() -> None:
    body = robot("mico_segway")
    spec = table(("small_white_cup", 0.45, 0.0))
    place = np.array([0.45, 0.0, 0.05])
    reach = body.arm.inverse_kinematics(place, start=body.home, tolerance=1e-4).q
    up = body.arm.inverse_kinematics(place + [0.0, -0.08, 0.12], start=reach, tolerance=1e-4).q
    ramp = np.linspace(0.0, 1.0, 20)[:, None]
    q = np.concatenate((body.home + ramp * (reach - body.home), np.tile(reach, (15, 1)), reach + ramp * (up - reach),
                        np.tile(up, (10, 1))))  # fmt: skip
    closed = np.arange(len(q)) >= 22
    gap = np.where(closed, 0.054, body.gripper.max_opening)
    positions = still(spec, len(q))
    tools = [body.arm.forward_kinematics(each).position for each in q]
    for step in range(35, len(q)):
        positions[step, 0] += tools[step] - tools[34]
    hand = HandDynamics(body)
    hand.move({name: (0.0, 0.0, 0.0) for name in body.joint_names + body.gripper.joints}, body.pose_base_in_world,
              np.zeros(6), np.zeros(6))  # fmt: skip
    empty = hand.wrench("arm")[2]
    force = np.zeros((len(q), 3))
    force[:, 2] = np.where(np.arange(len(q)) > 36, empty - 0.2 * 9.81, empty)
    seen = observe_camera_demo(demo_of(spec, positions, q, gap, closed, force), np.random.default_rng(2))
    assert seen.location.shape[1] == 1
    assert seen.features["weight"][0, 0, 0] == pytest.approx(0.2, abs=1e-6)
    assert seen.location[-1, 0, 2] - seen.location[0, 0, 2] > 0.08  # it went up by 12 cm


def test_a_thing_that_leaves_the_table_is_told_of() -> None:
    spec = table(("small_red_can", 0.45, 0.0), ("small_green_can", 0.40, 0.15))
    positions = still(spec, 75)
    positions[20:40, 0, 0] -= np.linspace(0.0, 0.12, 20)
    positions[40:, 0] = (0.2, 0.0, -0.65)  # on the floor
    perceived = perceive_camera_demo(demo_of(spec, positions), np.random.default_rng(0))
    assert len(perceived.notes) == 1
    assert "left the table" in perceived.notes[0]
    assert perceived.observation.visible is not None
    assert perceived.observation.visible[-1].tolist().count(False) == 1


def test_an_empty_table_shows_no_objects() -> None:
    seen = observe_camera_demo(demo_of(table(), np.zeros((7, 0, 3))), np.random.default_rng(0))
    assert seen.location.shape == (len(seen.times), 0, 3)
    assert seen.shape.shape == (len(seen.times), 0, 33)


def test_a_world_that_stands_still_is_observed() -> None:
    with World.from_scene(table(NAMES[0])) as world:
        state = world.state()
        seen = observe_camera_world(state, world.spec, np.random.default_rng(0), robot=world.robot)
    assert seen.location.shape[1] == 1
    assert np.linalg.norm(seen.location[-1, 0] - state.objects[0].pose_object_in_world.position) < 0.010
    assert not seen.gripper_closed.any()


def test_a_robot_without_a_camera_is_refused() -> None:
    spec = table(robot_name="three_dof")
    with pytest.raises(PerceptionError, match="three_dof has no camera.*cameras.NAME"):
        observe(demo_of(spec, np.zeros((3, 0, 3))), np.random.default_rng(0))


def test_an_unknown_arm_and_a_missing_state_are_refused() -> None:
    spec = table(NAMES[0])
    with World.from_scene(spec) as world, pytest.raises(PerceptionError, match="no arm 'left'; it has arm"):
        observe_camera_world(world.state(), spec, np.random.default_rng(0), arm="left")
    demo = demo_of(spec, still(spec, 5))
    spoiled = dataclasses.replace(demo, states=dataclasses.replace(demo.states, q=np.full_like(demo.states.q, np.nan)))
    with pytest.raises(PerceptionError, match="joint positions"):
        observe(spoiled, np.random.default_rng(0))
    gone = np.full((5, 1, 3), np.nan)
    with pytest.raises(PerceptionError, match="states of objects are missing"):
        observe(demo_of(spec, gone), np.random.default_rng(0))
