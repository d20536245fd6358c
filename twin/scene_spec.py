"""What a scene is made of, before it stands in physics."""

from itertools import combinations
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationInfo, field_validator, model_validator

from .board import ALL_COLOURS_RGB, ALL_SHAPES, BLOCK
from .errors import SceneError
from .objects import COLOURS_RGB, ObjectModel, board_model, look_of, object_model

Metres = Annotated[float, Field(allow_inf_nan=False)]
Radians = Annotated[float, Field(allow_inf_nan=False)]

OVERLAP = 0.003
"""Depth [m] to which two objects may overlap in a specification; physics pushes them apart when the scene settles."""


class ObjectSpec(BaseModel):
    """One object of a scene: a block of the board by `shape` and `colour`, or an object of a catalogue by `model`.

    `id` carries no meaning. The shape and colour of a catalogue's object are filled in; they need not be given.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    id: int
    model: str | None = None
    """Name in a catalogue, such as `green_mug`; None for a block of the board."""
    shape: str
    colour: str
    position: tuple[Metres, Metres, Metres]
    """Centre of the bounding box in the world [m]."""
    yaw: Radians = 0.0
    """How the object is turned about the vertical [rad]."""

    @classmethod
    def of_model(
        cls, identity: int, model: str, position: tuple[float, float, float], yaw: float = 0.0
    ) -> "ObjectSpec":
        """An object of a catalogue.

        Raises:
            ValueError: There is no such model (pydantic's `ValidationError`); lists the names.
        """
        return cls.model_validate({"id": identity, "model": model, "position": position, "yaw": yaw})

    @property
    def rgb(self) -> tuple[float, float, float]:
        """Surface colour, red green blue in 0..1."""
        return COLOURS_RGB[self.colour]

    @property
    def half_extents(self) -> tuple[float, float, float]:
        """Half of the bounding box in the object's own frame [m]."""
        if self.model is None:
            return (BLOCK / 2, BLOCK / 2, BLOCK / 2)
        x, y, z = object_model(self.model).half_extents.tolist()
        return x, y, z

    def object_model(self) -> ObjectModel:
        """All that is known about the object's body: faces, parts, mass, friction, where to hold it."""
        return board_model(self.shape, self.colour) if self.model is None else object_model(self.model)

    @model_validator(mode="before")
    @classmethod
    def _look_of_model(cls, data: Any) -> Any:
        """Fill in the look of a catalogue's object."""
        if isinstance(data, dict) and isinstance(data.get("model"), str):
            try:
                shape, colour = look_of(data["model"])
            except SceneError:
                return data  # the model's own check says what is wrong
            return {"shape": shape, "colour": colour, **data}
        return data

    @field_validator("model")
    @classmethod
    def _known_model(cls, model: str | None) -> str | None:
        if model is not None:
            look_of(model)
        return model

    @field_validator("shape")
    @classmethod
    def _known_shape(cls, shape: str, info: ValidationInfo) -> str:
        return _one_of("shape", shape, info, 0, ALL_SHAPES)

    @field_validator("colour")
    @classmethod
    def _known_colour(cls, colour: str, info: ValidationInfo) -> str:
        return _one_of("colour", colour, info, 1, tuple(ALL_COLOURS_RGB))


class SceneSpec(BaseModel):
    """A scene: objects, robot, and how the gripper starts. Saved in every demo's metadata.

    `kind` is what the objects stand on, at z = 0: the board, or a table. `gripper_position` is where the tool frame
    starts [m]; None leaves the robot at its home posture. `held` is the id of the object that starts in the closed
    gripper: it stands at the tool frame, whatever its own `position` says, and the gripper is closed, whatever
    `gripper_closed` says.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: str = "board"
    kind: Literal["board", "table"] = "board"
    robot: str = "three_dof"
    finger_mounting: Metres | None = None
    """How far outwards on its carriage each sliding finger is mounted; None as the robot's file says."""
    objects: tuple[ObjectSpec, ...] = Field(default_factory=tuple)
    gripper_position: tuple[Metres, Metres, Metres] | None = None
    gripper_closed: bool = False
    held: int | None = None
    seed: int = 0

    @model_validator(mode="after")
    def _consistent(self) -> "SceneSpec":
        ids = [each.id for each in self.objects]
        for identity in ids:
            if ids.count(identity) > 1:
                raise ValueError(f"objects: id {identity} is used more than once; every object needs its own")
        if self.held is not None and self.held not in ids:
            known = ", ".join(map(str, ids)) or "none"
            raise ValueError(f"held: {self.held} is not the id of an object; the scene's ids: {known}")
        standing = [each for each in self.objects if each.id != self.held]
        for each in standing:
            lowest = each.half_extents[2]
            if each.position[2] < lowest - OVERLAP:
                raise ValueError(
                    f"objects: id {each.id} is in the table: its centre must be at z >= {lowest:.6g}, "
                    f"got {each.position[2]}"
                )
        for one, other in combinations(standing, 2):
            if overlap_depth(one, other) > OVERLAP:
                raise ValueError(f"objects: ids {one.id} and {other.id} stand in each other, near {other.position}")
        return self


def overlap_depth(one: ObjectSpec, other: ObjectSpec) -> float:
    """How deep two objects overlap where they stand [m]; negative or 0 when they are apart.

    Blocks count as boxes; an object of a catalogue counts with all its parts, so that something may stand in a bowl.
    """
    from .objects.overlap import box_depth, parts_depth

    offset = [b - a for a, b in zip(one.position, other.position, strict=True)]
    depth = box_depth(one.half_extents, other.half_extents, offset, one.yaw, other.yaw)
    if depth <= OVERLAP or (one.model is None and other.model is None):
        return depth
    return parts_depth((one.object_model(), one.position, one.yaw), (other.object_model(), other.position, other.yaw))


def _one_of(what: str, value: str, info: ValidationInfo, number: int, allowed: tuple[str, ...]) -> str:
    """Check a block's shape or colour, or that it is that of the model."""
    model = info.data.get("model")
    if model is not None:
        allowed = (look_of(model)[number],)
        if value not in allowed:
            raise ValueError(f"the {what} of {model} is {allowed[0]}; leave it out")
    elif value not in allowed:
        raise ValueError(f"unknown {what}; use one of {', '.join(allowed)}")
    return value
