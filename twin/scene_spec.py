"""What a scene is made of, before it stands in physics."""

import math
from collections.abc import Sequence
from itertools import combinations
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, field_validator, model_validator

from .board import BLOCK, COLOURS_RGB

Metres = Annotated[float, Field(allow_inf_nan=False)]

OVERLAP = 0.003
"""Depth [m] to which two blocks may overlap in a specification; physics pushes them apart when the scene settles."""


class ObjectSpec(BaseModel):
    """One object of a scene. `id` carries no meaning; colour and shape are what the camera would see."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    id: int
    shape: Literal["cube", "prism"]
    colour: str
    position: tuple[Metres, Metres, Metres]
    """Centre in the world [m]."""

    @field_validator("colour")
    @classmethod
    def _known_colour(cls, colour: str) -> str:
        if colour not in COLOURS_RGB:
            raise ValueError(f"unknown colour; use one of {', '.join(COLOURS_RGB)}")
        return colour


class SceneSpec(BaseModel):
    """A scene: objects, robot, and how the gripper starts. Saved in every demo's metadata.

    `gripper_position` is where the tool frame starts [m]; None leaves the robot at its home posture. `held` is the id
    of the object that starts in the closed gripper: it stands at the tool frame, whatever its own `position` says,
    and the gripper is closed, whatever `gripper_closed` says.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: str = "board"
    robot: str = "three_dof"
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
            if each.position[2] < BLOCK / 2 - OVERLAP:
                raise ValueError(
                    f"objects: id {each.id} is in the table: its centre must be at z >= {BLOCK / 2}, "
                    f"got {each.position[2]}"
                )
        for one, other in combinations(standing, 2):
            if _depth(one.position, other.position) > OVERLAP:
                raise ValueError(f"objects: ids {one.id} and {other.id} stand in each other, near {other.position}")
        return self


def _depth(one: Sequence[float], other: Sequence[float]) -> float:
    """How deep two blocks with these centres overlap [m]; negative when they are apart."""
    return min(BLOCK - math.fabs(a - b) for a, b in zip(one, other, strict=True))
