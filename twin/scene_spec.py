"""What a scene is made of, before it stands in physics."""

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field


class ObjectSpec(BaseModel):
    """One object of a scene. `id` carries no meaning; colour and shape are what the camera would see."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    id: int
    shape: Literal["cube", "prism"]
    colour: str
    position: tuple[float, float, float]
    """Centre in the world [m]."""


class SceneSpec(BaseModel):
    """A scene: objects, robot, and how the gripper starts. Saved in every demo's metadata.

    `gripper_position` is where the tool frame starts [m]; None leaves the robot at its home posture. `held` is the id of
    the object that starts in the closed gripper.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: str = "board"
    robot: str = "three_dof"
    objects: tuple[ObjectSpec, ...] = Field(default_factory=tuple)
    gripper_position: tuple[float, float, float] | None = None
    gripper_closed: bool = False
    held: int | None = None
    seed: int = 0
