"""A scene specification refuses what cannot be, and says why."""

from typing import Any

import pytest
from pydantic import ValidationError

from twin import ObjectSpec, SceneSpec


def block(number: int, position: tuple[float, float, float], **changes: Any) -> dict[str, Any]:
    return {"id": number, "shape": "cube", "colour": "red", "position": position} | changes


def thing(number: int, model: str, x: float = 0.0, z: float = 0.04, **changes: Any) -> dict[str, Any]:
    return {"id": number, "model": model, "position": (x, 0.0, z)} | changes


LOW = (0.025, 0.025, 0.019)
NEXT = (0.075, 0.025, 0.019)

WRONG = [
    ({"objects": [block(1, LOW), block(1, NEXT)]}, "objects: id 1 is used more than once"),
    ({"objects": [block(1, LOW, colour="pink")]}, "unknown colour; use one of blue, cyan, red, yellow, green"),
    ({"objects": [block(1, LOW, shape="ball")]}, "unknown shape; use one of cube, prism, sphere, cylinder"),
    ({"objects": [block(1, LOW)], "held": 2}, "held: 2 is not the id of an object; the scene's ids: 1"),
    ({"held": 0}, "held: 0 is not the id of an object; the scene's ids: none"),
    ({"objects": [block(1, LOW), block(2, (0.030, 0.025, 0.019))]}, "objects: ids 1 and 2 stand in each other"),
    ({"objects": [block(1, (0.025, 0.025, 0.0))]}, "objects: id 1 is in the table"),
    ({"objects": [block(1, (float("nan"), 0, 1))]}, "finite number"),
    ({"objects": [block(1, LOW, size=3)]}, "Extra inputs are not permitted"),
    ({"gripper_position": (0.1, 0.2)}, "Field required"),
    ({"objects": [thing(1, "gold_mug")]}, "unknown model; use one of red_cube, blue_cube, yellow_cube"),
    ({"objects": [thing(1, "green_mug", colour="red")]}, "the colour of green_mug is green; leave it out"),
    ({"objects": [thing(1, "green_mug", shape="cube")]}, "the shape of green_mug is mug; leave it out"),
    ({"objects": [thing(1, "green_mug", z=0.03)]}, "objects: id 1 is in the table: its centre must be at z >= 0.03525"),
    ({"objects": [thing(1, "green_mug"), thing(2, "red_mug", x=0.05)]}, "objects: ids 1 and 2 stand in each other"),
    ({"objects": [thing(1, "green_mug", yaw=float("inf"))]}, "finite number"),
    ({"kind": "shelf"}, "Input should be 'board' or 'table'"),
]


@pytest.mark.parametrize(("data", "message"), WRONG)
def test_wrong_scenes_are_refused(data: dict[str, Any], message: str) -> None:
    with pytest.raises(ValidationError, match=message.replace("(", r"\(")):
        SceneSpec.model_validate(data)


def test_a_held_block_may_overlap_what_it_does_not_stand_in() -> None:
    spec = SceneSpec.model_validate({"objects": [block(1, LOW), block(2, LOW)], "held": 2})
    assert spec.held == 2


def test_a_scene_survives_json() -> None:
    spec = SceneSpec(objects=(ObjectSpec(id=4, shape="prism", colour="cyan", position=LOW),), seed=9)
    assert SceneSpec.model_validate_json(spec.model_dump_json()) == spec


def test_a_model_brings_its_look() -> None:
    spec = ObjectSpec.model_validate(thing(3, "green_mug", yaw=0.5))
    assert spec == ObjectSpec.of_model(3, "green_mug", (0.0, 0.0, 0.04), 0.5)
    assert (spec.shape, spec.colour, spec.yaw) == ("mug", "green", 0.5)
    assert spec.rgb == spec.object_model().rgb
    assert spec.half_extents == tuple(spec.object_model().half_extents)


@pytest.mark.parametrize("shape", ["cube", "prism", "sphere", "cylinder"])
def test_blocks_of_all_shapes_may_be_black(shape: str) -> None:
    spec = ObjectSpec(id=0, shape=shape, colour="black", position=LOW)
    assert spec.object_model().shape == shape
    assert spec.half_extents == pytest.approx(tuple(spec.object_model().half_extents), abs=1e-12)


def test_things_may_stand_in_a_bowl_but_not_in_its_wall() -> None:
    bowl = thing(1, "white_bowl", z=0.023)
    inside = thing(2, "red_apple", z=0.005 + 0.0186)
    assert len(SceneSpec.model_validate({"kind": "table", "objects": [bowl, inside]}).objects) == 2
    with pytest.raises(ValidationError, match="ids 1 and 2 stand in each other"):
        SceneSpec.model_validate({"kind": "table", "objects": [bowl, thing(2, "red_apple", x=0.045, z=0.0236)]})


def test_turned_things_may_lie_closer() -> None:
    crossed = [thing(1, "gray_fork", z=0.0065), thing(2, "black_fork", x=0.05, z=0.0065)]
    with pytest.raises(ValidationError, match="stand in each other"):
        SceneSpec.model_validate({"objects": crossed})
    beside = [each | {"yaw": 1.5707963} for each in crossed]
    assert len(SceneSpec.model_validate({"objects": beside}).objects) == 2


def test_specifications_of_older_demos_are_still_read() -> None:
    cube = '{"id": 1, "shape": "cube", "colour": "red", "position": [0.025, 0.025, 0.019]}'
    old = f'{{"name": "board", "robot": "three_dof", "objects": [{cube}], "held": null, "seed": 3}}'
    assert SceneSpec.model_validate_json(old).kind == "board"
