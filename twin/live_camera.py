"""A camera that the robot of a running world carries."""

from types import TracebackType
from typing import Self

import numpy as np

from .camera import CameraModel, RgbdFrame, kinect_noise, make_renderer
from .scene_view import SceneView, robot_state
from .world import World


class LiveCamera:
    """Takes pictures with a camera of a world's robot. Use `with`, in the thread that made it.

    A picture takes some milliseconds in which the world stands still; where that matters, record states and give them
    to `render_states` with a `SceneView`.

    Attributes:
        model: Size and intrinsics.
        note: Why this is not the fastest renderer; None when it is.
    """

    def __init__(self, world: World, name: str, width: int = 320, height: int = 240) -> None:
        """Mount the camera.

        Args:
            world: The world.
            name: One of the robot's cameras.
            width: Columns [pixel].
            height: Rows [pixel].

        Raises:
            TwinError: The robot carries no such camera, or a size is wrong.
        """
        self._world = world
        self._name = name
        self._view = SceneView(world.spec, world.robot, world.ground)
        self.model: CameraModel = self._view.camera(name, width, height)
        self._renderer = make_renderer(self._view.geometry, self.model)
        self.note = self._renderer.note

    def frame(self, rng: np.random.Generator | None = None) -> RgbdFrame:
        """What the camera sees now: colour, depth and mask.

        Args:
            rng: Where the sensor's noise comes from; None gives a picture without any.
        """
        state = self._world.state()
        robot = robot_state(self._world.robot, state)
        frame = self._renderer.render(self._view.poses(robot, state.objects), self._view.camera_pose(self._name, robot))
        return frame if rng is None else kinect_noise(frame, rng, self.model)

    def close(self) -> None:
        """Free the renderer."""
        self._renderer.close()

    def __enter__(self) -> Self:
        """Give the camera."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close it."""
        self.close()
