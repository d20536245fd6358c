"""A scene in physics, stepped at a fixed rate."""

import itertools
import math
import weakref
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from robots import load_robot
from robots.model import RobotModel
from robots.pose import FloatArray

from .arm import Arm
from .blocks import Block
from .board import BLOCK, CELL, CELLS
from .errors import SceneError, TwinError
from .physics import Physics
from .scene_spec import SceneSpec
from .scenes import resolve_scene
from .state import JointCommand, WorldState

SETTLE_STEPS = 120
"""Steps before a scene starts: half a second, in which blocks come to rest and fingers close."""
SOLVER_ITERATIONS = 50
WATCH_STEPS = 24
"""What the robot touches is kept awake, looked at this often: else a block that rested in the gripper for two seconds
would stay asleep, in mid-air, when it is let go."""

_TABLE_RGB = (0.62, 0.56, 0.50)
_SQUARES_RGB = ((0.93, 0.92, 0.88), (0.36, 0.40, 0.46))
_EYE = (-0.30, -0.44, 1.06)
_LOOKS_AT = (0.12, 0.20, 0.30)
_FIELD_OF_VIEW = 52.0


_numbers = itertools.count()
"""Numbers the worlds of this process, so that a snapshot knows its own."""


@dataclass(frozen=True, slots=True, weakref_slot=True)
class Snapshot:
    """A moment of one world, to go back to. Only the world that made it can use it.

    Attributes:
        owner: Number of the world it belongs to.
        physics_state: Number of the state that the physics client keeps.
        steps: Steps since the world started.
        target: The arm's joint targets, (n,) [rad].
        opening: Commanded gap between the fingers [m].
    """

    owner: int
    physics_state: int
    steps: int
    target: tuple[float, ...]
    opening: float


class World:
    """A scene in physics: a robot beside a board with blocks. Use `World.from_scene`, and close it or use `with`.

    Two worlds with the same scene and commands agree bit for bit; worlds share nothing.

    Attributes:
        DT: Length of a step [s].
        spec: The scene as it was specified.
        robot: The robot, placed.
    """

    DT: ClassVar[float] = 1.0 / 240.0

    def __init__(self, spec: SceneSpec) -> None:
        """Build the scene and let it settle.

        Raises:
            RobotError: The robot is unknown or its files are wrong.
            SceneError: The gripper cannot start where the scene says.
        """
        self.spec = spec
        self.robot: RobotModel = load_robot(spec.robot)
        posture, tool = _start(spec, self.robot)
        self._number = next(_numbers)
        self._state: WorldState | None = None
        self._physics = Physics(self.DT, SOLVER_ITERATIONS)
        try:
            self._build(posture, tool)
        except BaseException:
            self._physics.close()
            raise

    @classmethod
    def from_scene(cls, scene: str | Path | SceneSpec, *, robot: str | Path | None = None, seed: int = 0) -> Self:
        """Make a world.

        Args:
            scene: `"board"` for a random board scene, the path of a scene TOML, or a specification.
            robot: Robot to use instead of the scene's: a name or a folder.
            seed: Decides a random scene.

        Raises:
            SceneError: The scene is unknown or wrong; names file, field and value.
            RobotError: The robot is unknown or its files are wrong.
        """
        spec = resolve_scene(scene, seed)
        return cls(spec if robot is None else spec.model_copy(update={"robot": str(robot)}))

    def __enter__(self) -> Self:
        """Nothing to do: a world is open from the start."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the world."""
        self.close()

    def close(self) -> None:
        """End physics. A closed world cannot be used any more; closing again does nothing."""
        self._physics.close()

    @property
    def time(self) -> float:
        """Simulated time since the scene started [s]."""
        return self._steps * self.DT

    @property
    def joint_positions(self) -> FloatArray:
        """Measured positions of the driven joints, (n,) [rad]: what a control loop needs, without the whole state."""
        return self._arm.q

    @property
    def joint_velocities(self) -> FloatArray:
        """Measured velocities of the driven joints, (n,) [rad/s]."""
        return self._arm.dq

    def step(self, command: JointCommand) -> None:
        """Simulate one step of 1/240 s.

        Velocities are held to the robot's limits and integrated into joint targets, which end at the position limits;
        the passive joints follow.

        Raises:
            TwinError: The command has the wrong shape or is not finite, or the world is closed.
        """
        self._physics_open()
        velocity = command.velocity.tolist()
        if len(velocity) != len(self.robot.joint_names) or not all(map(math.isfinite, velocity)):
            raise TwinError(
                f"a command needs {len(self.robot.joint_names)} finite joint velocities [rad/s], got {velocity}"
            )
        if not 0.0 <= command.gripper_opening <= self.robot.gripper.max_opening + 1e-9:
            raise TwinError(
                f"gripper_opening must be in 0..{self.robot.gripper.max_opening} m, got {command.gripper_opening}"
            )
        self._arm.command(velocity, command.gripper_opening, self.DT)
        self._advance()
        self._steps += 1

    def state(self) -> WorldState:
        """True state now. Cheap to ask again before the next step."""
        if self._state is None:
            self._physics_open()
            arm = self._arm
            between = arm.between_fingers()
            self._state = WorldState(
                time=self.time,
                q=arm.q,
                dq=arm.dq,
                gripper_opening=arm.measured_opening,
                gripper_closed=self._told_to_close(arm.opening),
                pose_tool_in_world=arm.tool(),
                objects=tuple([block.state() for block in self._blocks]),
                held=next((block.id for block in self._blocks if block.body in between), None) if between else None,
            )
        return self._state

    def snapshot(self) -> Snapshot:
        """Keep this moment, exactly.

        Resting blocks are woken, here and when restored, because PyBullet does not keep who sleeps: a world goes on
        from `snapshot()` bit for bit as from `restore()`, though not bit for bit as if neither had been called.
        """
        self._physics_open()
        number = self._physics.save()
        snapshot = Snapshot(self._number, number, self._steps, tuple(self._arm.target), self._arm.opening)
        weakref.finalize(snapshot, self._physics.forget, number)
        self.restore(snapshot)
        return snapshot

    def restore(self, snapshot: Snapshot) -> None:
        """Go back to a moment of this world.

        Raises:
            TwinError: The snapshot is another world's.
        """
        self._physics_open()
        if snapshot.owner != self._number:
            raise TwinError("this snapshot is another world's: restore it in the world that made it")
        self._physics.restore(snapshot.physics_state)
        self._wake_all()
        # A woken block takes part in physics one step later, so we take a step and undo it.
        self._physics.step()
        self._physics.restore(snapshot.physics_state)
        self._wake_all()
        self._steps = snapshot.steps
        self._arm.resume(snapshot.target, snapshot.opening)
        self._state = None

    def render(self, width: int, height: int) -> NDArray[np.uint8]:
        """Picture from a fixed overview camera behind the robot's right shoulder: (height, width, 3), RGB.

        The board's left (+y) is on the left, its front (+x) in the distance.

        Raises:
            TwinError: A side is not in 1..4096 pixels.
        """
        self._physics_open()
        for side in (width, height):
            if not 1 <= side <= 4096:
                raise TwinError(f"a picture's sides must be in 1..4096 pixels, got {width} x {height}")
        return self._physics.picture(width, height, _EYE, _LOOKS_AT, _FIELD_OF_VIEW)

    def _build(self, posture: FloatArray, tool: FloatArray) -> None:
        """Add table, board, robot and blocks, and let them settle."""
        middle = CELLS * CELL / 2
        self._physics.set_friction(
            self._physics.add_box((0.6, 0.6, 0.05), (middle, middle, -0.05), 0.0, _TABLE_RGB), -1, 1.0
        )
        for parity, rgb in enumerate(_SQUARES_RGB):
            self._physics.add_picture(*_squares(parity), rgb)
        self._arm = Arm(self._physics, self.robot)
        self._blocks = [
            Block(self._physics, each, tool if each.id == self.spec.held else np.array(each.position))
            for each in self.spec.objects
        ]
        self._by_body = {block.body: block for block in self._blocks}
        self._steps = 0
        closed = self.spec.gripper_closed or self.spec.held is not None
        gap = BLOCK if self.spec.held is not None else 0.0 if closed else self.robot.gripper.max_opening
        self._arm.place(posture, gap, 0.0 if closed else gap)
        for _ in range(SETTLE_STEPS):
            self._advance()
        for block in self._blocks:
            if block.id != self.spec.held:
                self._physics.put_to_sleep(block.body)

    def _advance(self) -> None:
        """Simulate one step, whatever was commanded."""
        if self._steps % WATCH_STEPS == 0:
            for body in self._physics.touching_anywhere(self._arm.body):
                if body in self._by_body:
                    self._physics.wake(body)
        self._physics.step()
        self._arm.sense()
        self._state = None

    def _wake_all(self) -> None:
        for block in self._blocks:
            self._physics.wake(block.body)

    def _told_to_close(self, opening: float) -> bool:
        """A gap below half of the largest counts as closed."""
        return opening < self.robot.gripper.max_opening / 2

    def _physics_open(self) -> None:
        if not self._physics.open:
            raise TwinError("this world is closed")


def _start(spec: SceneSpec, robot: RobotModel) -> tuple[FloatArray, FloatArray]:
    """Posture (n,) [rad] and tool position (3,) [m] with which a scene starts.

    Raises:
        SceneError: The robot does not reach the position.
    """
    if spec.gripper_position is None:
        return robot.home, robot.forward_kinematics(robot.home).position
    tool = np.array(spec.gripper_position)
    found = robot.inverse_kinematics(tool, start=robot.home, tolerance=1e-6)
    if not found.success:
        raise SceneError(
            f"scene {spec.name!r}: gripper_position {spec.gripper_position} is out of {robot.name}'s reach by "
            f"{1000 * found.error:.1f} mm"
        )
    return found.q, tool


def _squares(parity: int) -> tuple[FloatArray, NDArray[np.int64]]:
    """Corners (n, 3) [m] and triangles (m, 3) of the board's light (0) or dark (1) squares, just above the table."""
    cells = [(x, y) for x in range(CELLS) for y in range(CELLS) if (x + y) % 2 == parity]
    corners = [((x + i) * CELL, (y + j) * CELL, 0.0002) for x, y in cells for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
    triangles = [[4 * n + a for a in face] for n in range(len(cells)) for face in ((0, 1, 2), (0, 2, 3))]
    return np.array(corners), np.array(triangles)
