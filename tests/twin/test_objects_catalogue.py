"""The catalogues hold what they promise: numbers, masses, inertia, and parts that fingers can hold."""

from collections import Counter, defaultdict

import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull

from robots.pose import FloatArray
from twin import SceneError
from twin.board import ALL_COLOURS_RGB, ALL_SHAPES, BLOCK
from twin.objects import CATALOGUES, COLOURS_RGB, ObjectModel, board_model, look_of, object_model

NAMES = [name for names in CATALOGUES.values() for name in names]
BOARD = [(shape, colour) for shape in ALL_SHAPES for colour in ("black", "red")]


def everything() -> list[ObjectModel]:
    return [*map(object_model, NAMES), *(board_model(*look) for look in BOARD)]


@pytest.mark.parametrize(
    ("catalogue", "objects", "shapes", "colours"), [("tabletop", 51, 13, 10), ("ordering", 32, 6, 7)]
)
def test_catalogues_are_as_large_and_varied_as_promised(
    catalogue: str, objects: int, shapes: int, colours: int
) -> None:
    names = CATALOGUES[catalogue]
    looks = [look_of(name) for name in names]
    assert len(set(names)) == objects
    by_shape, by_colour = defaultdict(set), defaultdict(set)
    for shape, colour in looks:
        by_shape[shape].add(colour)
        by_colour[colour].add(shape)
    assert len(by_shape) == shapes
    assert len(by_colour) == colours
    # No class has a colour of its own, and no colour a class: only so can the two be learned apart.
    assert min(map(len, by_shape.values())) >= 3
    assert min(map(len, by_colour.values())) >= 2


def test_tabletop_looks_are_unique() -> None:
    assert max(Counter(map(look_of, CATALOGUES["tabletop"])).values()) == 1


@pytest.mark.parametrize("name", NAMES)
def test_a_model_is_what_its_name_says(name: str) -> None:
    model = object_model(name)
    shape, colour = look_of(name)
    assert (model.name, model.shape, model.colour, model.rgb) == (name, shape, colour, COLOURS_RGB[colour])
    assert {colour, shape} <= set(name.split("_"))
    assert any(visual.rgb == model.rgb for visual in model.visuals)


@pytest.mark.parametrize(("catalogue", "least", "most"), [("tabletop", 0.02, 0.3), ("ordering", 0.03, 0.6)])
def test_masses_are_sane(catalogue: str, least: float, most: float) -> None:
    masses = [object_model(name).mass for name in CATALOGUES[catalogue]]
    assert least <= min(masses) and max(masses) <= most


def test_orders_differ_in_size_and_weight() -> None:
    models = [object_model(name) for name in CATALOGUES["ordering"]]
    for shape in {model.shape for model in models}:
        alike = [model for model in models if model.shape == shape]
        heights = {round(float(model.half_extents[2]), 4) for model in alike}
        masses = [model.mass for model in alike]
        assert len(heights) == 2
        assert max(masses) > 2 * min(masses)


def test_inertia_is_that_of_a_body() -> None:
    for model in everything():
        np.testing.assert_allclose(model.inertia, model.inertia.T, atol=1e-15)
        small, middle, large = np.linalg.eigvalsh(model.inertia)
        assert small > 0 and large < small + middle, model.name
        # The mass lies inside the bounding box, which bounds the radius of gyration.
        assert large < model.mass * float(model.half_extents @ model.half_extents), model.name
        assert (np.abs(model.centre_of_mass) < model.half_extents).all(), model.name


def test_known_bodies_have_their_textbook_inertia() -> None:
    cube, sphere = board_model("cube", "red"), board_model("sphere", "red")
    np.testing.assert_allclose(cube.mass, 0.050, rtol=1e-12)
    np.testing.assert_allclose(cube.inertia, cube.mass * BLOCK**2 / 6 * np.eye(3), rtol=1e-9, atol=1e-18)
    # The drawn ball of 1280 triangles lies 0.6% of volume inside the true one.
    np.testing.assert_allclose(np.diag(sphere.inertia), 0.4 * sphere.mass * (BLOCK / 2) ** 2, rtol=0.01)
    np.testing.assert_allclose(board_model("prism", "red").mass, 0.025, rtol=1e-12)


def test_visuals_are_closed_and_fill_the_bounding_box_around_the_origin() -> None:
    for model in everything():
        corners = np.concatenate([visual.vertices for visual in model.visuals])
        np.testing.assert_allclose(corners.max(axis=0), model.half_extents, atol=1e-12)
        np.testing.assert_allclose(corners.min(axis=0), -model.half_extents, atol=1e-12)
        for visual in model.visuals:
            mesh = trimesh.Trimesh(visual.vertices, visual.faces, process=False)
            assert mesh.is_watertight and mesh.volume > 0, model.name


def test_what_is_touched_is_what_is_seen() -> None:
    for model in everything():
        lowest = []
        for part in model.parts:
            # Corners of round parts stand around them: 2% of the radius where they have sixteen sides.
            corners = (
                part.pose.position + np.array([[-1.0], [1.0]]) * part.size if part.kind == "sphere" else part.vertices
            )
            assert (np.abs(corners) <= model.half_extents * 1.02 + 1e-9).all(), model.name
            lowest.append(float(corners[:, 2].min()))
        assert min(lowest) == pytest.approx(-model.half_extents[2], abs=1e-9), model.name


def reachable_widths(model: ObjectModel) -> tuple[float, float]:
    """Widths that the gripper of the catalogue's robot can hold [m]."""
    if model.name in CATALOGUES["ordering"]:
        return 0.035, 0.070
    return (0.003, 0.036) if model.name in CATALOGUES["tabletop"] else (BLOCK, BLOCK)


def depth_in(model: ObjectModel, point: FloatArray) -> float:
    """How deep a point is in the parts [m]; negative outside."""
    distances = []
    for part in model.parts:
        if part.kind == "sphere":
            distances.append(float(np.linalg.norm(point - part.pose.position) - part.size[0]))
        else:
            faces = ConvexHull(part.vertices).equations
            distances.append(float((faces[:, :3] @ point + faces[:, 3]).max()))
    return -min(distances)


@pytest.mark.parametrize("model", everything(), ids=lambda model: model.name)
def test_grasps_fit_the_gripper_and_touch_the_surface(model: ObjectModel) -> None:
    least, most = reachable_widths(model)
    meshes = [trimesh.Trimesh(visual.vertices, visual.faces, process=False) for visual in model.visuals]
    seen = trimesh.util.concatenate(meshes)
    assert model.grasps
    pads = np.concatenate([grasp.pads for grasp in model.grasps])
    _, away, _ = trimesh.proximity.closest_point_naive(seen, pads)
    # The pads lie on corners of the drawn 32-sided bodies, where these are true; 0.2 mm is left for the drawn sphere,
    # whose corners are elsewhere.
    assert away.max() < 2e-4
    for grasp in model.grasps:
        assert least - 1e-9 <= grasp.width <= most + 1e-9
        assert np.linalg.norm(grasp.closing) == pytest.approx(1)
        assert np.linalg.norm(grasp.approach) == pytest.approx(1)
        assert abs(grasp.closing @ grasp.approach) < 1e-9
        # From above or from the side, as it stands; what may roll is held so on each of its sides, too.
        sides = {"cube": 4, "marker": 8}.get(model.name.rsplit("_", 1)[-1])
        allowed = (-1.0, 0.0) if sides is None else np.cos(2 * np.pi * np.arange(sides) / sides)
        assert np.abs(np.asarray(allowed) - grasp.approach[2]).min() < 1e-6
        # A finger tip may reach 5 mm below its pad's middle, and clears the table by 2 mm.
        assert grasp.centre[2] + model.half_extents[2] >= 0.007 - 1e-9
    assert model.grasps[0].approach[2] == pytest.approx(-1) or model.grasps[0].approach[2] == pytest.approx(0)
    for pad in pads[:: max(1, len(pads) // 8)]:
        assert depth_in(model, pad) == pytest.approx(0, abs=2e-5)  # contact's surface is where the pad is


def test_the_steadiest_grasp_comes_first() -> None:
    for shape in ("fork", "spoon", "knife", "banana", "stapler"):
        model = object_model(next(name for name in CATALOGUES["tabletop"] if name.endswith(shape)))
        off = [np.linalg.norm((grasp.centre - model.centre_of_mass)[:2]) for grasp in model.grasps]
        assert off[0] < 0.010
        assert off[0] <= min(off) + 0.005


def test_arrays_are_read_only() -> None:
    model = object_model("green_mug")
    for array in (model.inertia, model.visuals[0].vertices, model.parts[0].vertices, model.grasps[0].centre):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_unknown_names_are_refused() -> None:
    with pytest.raises(SceneError, match="unknown model; use one of red_cube, blue_cube, .*large_black_tub"):
        object_model("gold_mug")
    with pytest.raises(SceneError, match="unknown shape 'mug' of a block; use one of cube, prism, sphere, cylinder"):
        board_model("mug", "red")
    with pytest.raises(SceneError, match="unknown colour 'pink' of a block; use one of blue, .*, black"):
        board_model("cube", "pink")
    assert len(ALL_COLOURS_RGB) == 9
