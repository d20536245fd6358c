"""A scene specification refuses what cannot be, and says why."""

from typing import Any

import pytest
from pydantic import ValidationError

from twin import ObjectSpec, SceneSpec


def block(number: int, position: tuple[float, float, float], **changes: Any) -> dict[str, Any]:
    return {"id": number, "shape": "cube", "colour": "red", "position": position} | changes


LOW = (0.025, 0.025, 0.019)
NEXT = (0.075, 0.025, 0.019)

WRONG = [
    ({"objects": [block(1, LOW), block(1, NEXT)]}, "objects: id 1 is used more than once"),
    ({"objects": [block(1, LOW, colour="pink")]}, "unknown colour; use one of blue, cyan, red, yellow, green"),
    ({"objects": [block(1, LOW, shape="ball")]}, "Input should be 'cube' or 'prism'"),
    ({"objects": [block(1, LOW)], "held": 2}, "held: 2 is not the id of an object; the scene's ids: 1"),
    ({"held": 0}, "held: 0 is not the id of an object; the scene's ids: none"),
    ({"objects": [block(1, LOW), block(2, (0.030, 0.025, 0.019))]}, "objects: ids 1 and 2 stand in each other"),
    ({"objects": [block(1, (0.025, 0.025, 0.0))]}, "objects: id 1 is in the table"),
    ({"objects": [block(1, (float("nan"), 0, 1))]}, "finite number"),
    ({"objects": [block(1, LOW, size=3)]}, "Extra inputs are not permitted"),
    ({"gripper_position": (0.1, 0.2)}, "Field required"),
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
