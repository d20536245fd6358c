"""Grasp poses: the pads come to both sides of the object, whichever way tool frame and object are turned."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from robots import Pose, load_robot
from robots.gripper import Gripper
from robots.kinematics import rotation_matrix
from robots.pose import FloatArray
from twin.grasp_poses import BITE, CLEARANCE, GraspPose, grasp_poses
from twin.objects import CATALOGUES, ObjectModel, board_model, object_model

GRIPPERS: dict[str, Gripper] = {
    "three_dof": load_robot("three_dof").gripper,  # approach -z, closing y
    "left": load_robot("baxter").arms["left"].gripper,  # approach z
    "right": load_robot("baxter").arms["right"].gripper,
    "mico_segway": load_robot("mico_segway").gripper,
}
MODELS = [object_model(name) for name in ("green_mug", "white_bowl", "gray_fork", "red_apple", "small_red_can")]
MODELS += [board_model(shape, "red") for shape in ("cube", "prism", "sphere", "cylinder")]
ORIGIN = Pose(np.zeros(3), np.array([0.0, 0.0, 0.0, 1.0]))


def hand(proposal: GraspPose, gripper: Gripper) -> tuple[FloatArray, FloatArray]:
    """Where the tool frame's approach and closing axes point, (3,) each."""
    turn = rotation_matrix(proposal.pose_tool_in_world.orientation_xyzw)
    return turn @ gripper.approach, turn @ gripper.closing


@st.composite
def poses(draw: st.DrawFn) -> Pose:
    numbers = st.floats(-1.0, 1.0, allow_nan=False)
    position = np.array([draw(numbers) for _ in range(3)])
    return Pose(position, Rotation.from_rotvec([3 * draw(numbers) for _ in range(3)]).as_quat())


@pytest.mark.parametrize("arm", list(GRIPPERS))
@settings(max_examples=40, deadline=None)
@given(model=st.sampled_from(MODELS), pose=poses(), depth=st.floats(0.0, 0.02), tilt=st.floats(-1.0, 1.0))
def test_the_hand_closes_on_the_surfaces_and_comes_along_the_approach(
    arm: str, model: ObjectModel, pose: Pose, depth: float, tilt: float
) -> None:
    gripper = GRIPPERS[arm]
    turn = rotation_matrix(pose.orientation_xyzw)
    proposals = grasp_poses(model, pose, gripper, depths=(depth,), tilts=(tilt,))
    fitting = [each for each in model.grasps if fits(each.width, gripper)]
    assert len(proposals) == 2 * len(fitting)
    for number, proposal in enumerate(proposals):
        assert proposal.grasp is fitting[number // 2]
        approach, closing = hand(proposal, gripper)
        np.testing.assert_allclose(approach, proposal.approach, atol=1e-9)
        assert np.linalg.norm(approach) == pytest.approx(1.0)
        # The fingers close along the line between the two surfaces, either way round, tilted or not.
        between = turn @ proposal.grasp.closing
        assert abs(closing @ between) == pytest.approx(1.0, abs=1e-9)
        # Go back by the depth: the middle of the pads is the middle of the held part, so that each pad is outside.
        middle = proposal.pose_tool_in_world.position - depth * approach
        pads = proposal.grasp.pads @ turn.T + pose.position
        np.testing.assert_allclose(middle, pads.mean(axis=0), atol=1e-9)
        fingers = [middle + sign * proposal.opening / 2 * closing for sign in (1.0, -1.0)]
        gaps = [min(np.linalg.norm(finger - pad) for pad in pads) for finger in fingers]
        np.testing.assert_allclose(gaps, (proposal.opening - proposal.width) / 2, atol=1e-9)
        assert min(gaps) >= CLEARANCE - 1e-12
        # The untilted approach is that of the object's grasp; the tilt is the angle to it.
        assert approach @ (turn @ proposal.grasp.approach) == pytest.approx(np.cos(tilt), abs=1e-9)


def fits(width: float, gripper: Gripper) -> bool:
    return gripper.min_opening + BITE <= width <= gripper.max_opening - 2 * CLEARANCE


@pytest.mark.parametrize("arm", list(GRIPPERS))
def test_widths_outside_the_fingers_range_are_left_out(arm: str) -> None:
    gripper = GRIPPERS[arm]
    seen = {"narrow": 0, "held": 0, "wide": 0}
    for model in [object_model(name) for names in CATALOGUES.values() for name in names]:
        proposed = {id(each.grasp) for each in grasp_poses(model, ORIGIN, gripper)}
        for grasp in model.grasps:
            assert (id(grasp) in proposed) == fits(grasp.width, gripper)
            kind = "narrow" if grasp.width < gripper.min_opening + BITE else "held" if id(grasp) in proposed else "wide"
            seen[kind] += 1
    assert seen["held"] > 0 and (seen["wide"] > 0 or arm == "mico_segway")  # made for what it holds


def test_nothing_is_proposed_where_nothing_fits() -> None:
    wide = max((object_model(name) for name in CATALOGUES["ordering"]), key=lambda each: each.grasps[0].width)
    gripper = GRIPPERS["three_dof"]
    assert min(each.width for each in wide.grasps) > gripper.max_opening
    assert grasp_poses(wide, ORIGIN, gripper) == []


def test_a_cube_is_held_from_above_with_the_hand_either_way_round() -> None:
    """The board arm's tool frame is upright where it grips: its -z axis points down."""
    gripper = GRIPPERS["three_dof"]
    proposals = grasp_poses(board_model("cube", "red"), ORIGIN, gripper)
    down = [each for each in proposals if each.approach[2] < -0.99]
    assert down
    for each in down:
        np.testing.assert_allclose(each.pose_tool_in_world.position, 0.0, atol=1e-12)
        assert abs(rotation_matrix(each.pose_tool_in_world.orientation_xyzw)[2, 2] - 1.0) < 1e-9
    one, other = down[:2]
    angle = Rotation.from_quat(one.pose_tool_in_world.orientation_xyzw.copy()).inv() * Rotation.from_quat(
        other.pose_tool_in_world.orientation_xyzw.copy()
    )
    assert angle.magnitude() == pytest.approx(np.pi)


def test_depths_come_before_narrower_openings_and_tilts_last() -> None:
    gripper = GRIPPERS["mico_segway"]
    model = object_model("small_red_can")
    proposals = grasp_poses(model, ORIGIN, gripper, depths=(0.01, 0.0), openings=(0.02, 9.0), tilts=(0.0, 0.4))
    first = [each for each in proposals if each.grasp is model.grasps[0]]
    # Two depths, two ways round, two openings: 9 m more than the width is beyond the widest, and left out.
    assert len(first) == 2 * 2 * 2 * 2
    width = model.grasps[0].width
    assert [each.opening for each in first[:2]] == [gripper.max_opening, pytest.approx(width + 0.02)]
    height = [float(each.pose_tool_in_world.position @ each.approach) for each in first[:8]]
    np.testing.assert_allclose(np.array(height) - height[4], [0.01] * 4 + [0.0] * 4, atol=1e-12)
    untilted = len(proposals) // 2
    assert all(each.approach @ each.grasp.approach > 1 - 1e-9 for each in proposals[:untilted])
    assert all(each.approach @ each.grasp.approach < 0.95 for each in proposals[untilted:])
    assert all(each.width == each.grasp.width for each in proposals)


@pytest.mark.parametrize(
    ("name", "axes", "turn"), [("red_marker", "x", np.pi / 4), ("red_cube", "xyz", np.pi / 2)], ids=["marker", "cube"]
)
def test_what_may_roll_can_be_held_from_above_whichever_side_is_up(name: str, axes: str, turn: float) -> None:
    for axis in axes:
        for times in range(round(2 * np.pi / turn)):
            lies = Pose(np.zeros(3), Rotation.from_euler(axis, times * turn).as_quat())
            proposals = grasp_poses(object_model(name), lies, GRIPPERS["left"])
            assert min(each.approach[2] for each in proposals) == pytest.approx(-1.0), (axis, times)
