"""A scene in physics, stepped at a fixed rate."""

import itertools
import math
import weakref
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from robots import load_robot
from robots.collision import FLOOR, Obstacle
from robots.model import RobotModel
from robots.pose import FloatArray, Pose

from .board import BLOCK
from .errors import SceneError, TwinError
from .ground import Ground, beside_board, board_ground, table_ground
from .object_body import ObjectBody
from .objects.model import ObjectModel
from .physics import Physics
from .robot_body import RobotBody, RobotMemory
from .scene_spec import SceneSpec
from .scenes import resolve_scene
from .state import ArmState, JointCommand, WorldState

SETTLE_STEPS = 120
"""Steps before a scene starts: half a second, in which blocks come to rest and fingers close."""
SOLVER_ITERATIONS = 50
WATCH_STEPS = 24
"""What the robot touches is kept awake, looked at this often: else a block that rested in the gripper for two seconds
would stay asleep, in mid-air, when it is let go."""

_VIEWS = {
    "board": ((-0.30, -0.44, 1.06), (0.12, 0.20, 0.30)),
    "board from the front": ((1.35, -0.75, 1.05), (0.02, 0.20, 0.12)),
    "table": ((1.75, -1.35, 1.15), (0.38, 0.0, 0.05)),
}
"""Eye and the point looked at [m] of the overview camera: a robot that stands on the floor would hide the board."""
_FIELD_OF_VIEW = 52.0
TABLE_X = (0.36, 1.06)
"""Nearest and farthest edge of a table [m]."""
TABLE_Y = (-0.60, 0.60)
"""Right and left edge of a table [m]."""

_numbers = itertools.count()
"""Numbers the worlds of this process, so that a snapshot knows its own."""


@dataclass(frozen=True, slots=True, weakref_slot=True)
class Snapshot:
    """A moment of one world, to go back to. Only the world that made it can use it.

    Attributes:
        owner: Number of the world it belongs to.
        physics_state: Number of the state that the physics client keeps.
        steps: Steps since the world started.
        robot: What that state lacks of the robot.
    """

    owner: int
    physics_state: int
    steps: int
    robot: RobotMemory


class World:
    """A scene in physics: a robot, and objects on a board or a table.

    Use `World.from_scene`, and close it or use `with`.

    Two worlds with the same scene and commands agree bit for bit; worlds share nothing.

    Attributes:
        DT: Length of a step [s].
        spec: The scene as it was specified.
        robot: The robot, where the scene starts; `placed_robot` knows where a robot on wheels is now.
        ground: What stands still.
        on_step: Called before every step, with nothing moved yet by it; None for nothing.
    """

    DT: ClassVar[float] = 1.0 / 240.0

    def __init__(self, spec: SceneSpec, *, window: bool = False) -> None:
        """Build the scene and let it settle.

        Args:
            spec: The scene.
            window: Show it in PyBullet's own window, for those with a display.

        Raises:
            RobotError: The robot is unknown or its files are wrong.
            SceneError: The gripper cannot start where the scene says.
        """
        self.spec = spec
        robot = load_robot(spec.robot, finger_mounting=spec.finger_mounting)
        self.robot: RobotModel = beside_board(robot) if spec.kind == "board" else robot
        self.ground: Ground = _ground(spec, self.robot)
        posture, tool = _start(spec, self.robot)
        self.on_step: Callable[[], None] | None = None
        self._number = next(_numbers)
        self._state: WorldState | None = None
        self._physics = Physics(self.DT, SOLVER_ITERATIONS, window=window)
        try:
            self._build(posture, tool)
        except BaseException:
            self._physics.close()
            raise

    @classmethod
    def from_scene(cls, scene: str | Path | SceneSpec, *, robot: str | Path | None = None, seed: int = 0) -> Self:
        """Make a world.

        Args:
            scene: `"board"`, `"tabletop"` or `"ordering"` for a random scene, the path of a scene TOML, or a
                specification.
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
        return self._robot.q

    @property
    def joint_velocities(self) -> FloatArray:
        """Measured velocities of the driven joints, (n,) [rad/s]."""
        return self._robot.dq

    @property
    def commanded_positions(self) -> FloatArray:
        """Where the drives are told to be, (n,) [rad]: what a controller goes on from without a jump."""
        return np.array(self._robot.target)

    @property
    def commanded_openings(self) -> tuple[float, ...]:
        """Gap that each arm's gripper was told to make [m]."""
        return self._robot.openings

    @property
    def commanded_base_twist(self) -> tuple[float, float]:
        """Speed [m/s] and turning speed [rad/s] that the base was told last; zeros for a robot without wheels."""
        return self._robot.base_twist

    @property
    def base_pose(self) -> Pose:
        """Pose of the robot's base in the world, now."""
        return self._robot.base()

    @property
    def placed_robot(self) -> RobotModel:
        """The robot where it stands now."""
        return self.robot if self.robot.drive is None else self.robot.placed_at(self._robot.base())

    def obstacles(self, detailed: Collection[int] | None = None, without: Collection[int] = ()) -> list[Obstacle]:
        """Everything around the robot, where it is now, for collision checks: ground, and objects named by their id.

        Args:
            detailed: Objects to give part by part; the others are wrapped in their convex hulls. None takes all.
            without: Objects to leave out.
        """
        self._physics_open()
        things = self.ground.obstacles()
        for block in self._blocks:
            if block.id not in without:
                things += block.obstacles(whole=detailed is not None and block.id not in detailed)
        return things

    def model_of(self, object_id: int) -> ObjectModel:
        """What an object is: its shape, mass, and where it can be held.

        Raises:
            TwinError: There is no such object.
        """
        for block in self._blocks:
            if block.id == object_id:
                return block.model
        raise TwinError(f"no object {object_id}; the scene has {', '.join(str(block.id) for block in self._blocks)}")

    def touches(self) -> set[str]:
        """What the robot touches now: ids of objects, and names of what stands still; empty when it touches nothing."""
        self._physics_open()
        names = {body: str(block.id) for body, block in self._by_body.items()}
        bodies = self._physics.touching_anywhere(self._robot.body, within=0.0)
        return {names.get(body, "ground") for body in bodies if body not in self._floor and body != self._robot.body}

    def step(self, command: JointCommand) -> None:
        """Simulate one step of 1/240 s.

        Velocities are held to the robot's limits and integrated into joint targets, which end at the position limits;
        the passive joints follow. A base on wheels is driven by its wheels alone.

        Raises:
            TwinError: The command has the wrong shape or is not finite, or the world is closed.
        """
        self._physics_open()
        velocity = command.velocity.tolist()
        if len(velocity) != len(self.robot.joint_names) or not all(map(math.isfinite, velocity)):
            raise TwinError(
                f"a command needs {len(self.robot.joint_names)} finite joint velocities [rad/s], got {velocity}"
            )
        if self.on_step is not None:
            self.on_step()
        self._robot.command(velocity, self._openings(command), self._base_twist(command), self.DT)
        self._advance()
        self._steps += 1

    def state(self) -> WorldState:
        """True state now. Cheap to ask again before the next step."""
        if self._state is None:
            self._physics_open()
            robot = self._robot
            arms = tuple([self._arm_state(number) for number in range(len(self.robot.arms))])
            self._state = WorldState(
                time=self.time,
                q=robot.q,
                dq=robot.dq,
                gripper_opening=arms[0].gripper_opening,
                gripper_closed=arms[0].gripper_closed,
                pose_tool_in_world=arms[0].pose_tool_in_world,
                objects=tuple([block.state() for block in self._blocks]),
                held=arms[0].held,
                effort=robot.effort,
                arms=arms,
                pose_base_in_world=robot.base(),
            )
        return self._state

    def snapshot(self) -> Snapshot:
        """Keep this moment, exactly.

        Resting blocks are woken, here and when restored, because PyBullet does not keep who sleeps: a world goes on
        from `snapshot()` bit for bit as from `restore()`, though not bit for bit as if neither had been called.
        """
        self._physics_open()
        number = self._physics.save()
        snapshot = Snapshot(self._number, number, self._steps, self._robot.memory())
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
        self._robot.unpark()  # the brake holds where it was put on
        self._physics.restore(snapshot.physics_state)
        if snapshot.robot.parked:
            self._robot.park()
        self._wake_all()
        # A woken block takes part in physics one step later, so we take a step and undo it.
        self._physics.step()
        self._physics.restore(snapshot.physics_state)
        self._wake_all()
        self._steps = snapshot.steps
        self._robot.resume(snapshot.robot)
        self._state = None

    def render(self, width: int, height: int) -> NDArray[np.uint8]:
        """Picture from a fixed overview camera: (height, width, 3), RGB.

        The board is seen from behind the board arm's right shoulder: its left (+y) is on the left, its front (+x) in
        the distance. A table, and robots that stand on the floor, are seen from the front.

        Raises:
            TwinError: A side is not in 1..4096 pixels.
        """
        self._physics_open()
        for side in (width, height):
            if not 1 <= side <= 4096:
                raise TwinError(f"a picture's sides must be in 1..4096 pixels, got {width} x {height}")
        front = self.spec.kind == "board" and self.robot.floor is not None
        view = _VIEWS["board from the front" if front else self.spec.kind]
        return self._physics.picture(width, height, *view, _FIELD_OF_VIEW)

    def _build(self, posture: FloatArray, tool: FloatArray) -> None:
        """Add ground, robot and objects, and let them settle."""
        standing = self.ground.build(self._physics)
        # A robot on wheels touches the floor it rolls on.
        self._floor = {body for body, slab in zip(standing, self.ground.slabs, strict=True) if slab.name == FLOOR}
        self._robot = RobotBody(self._physics, self.robot)
        self._blocks = [
            ObjectBody(self._physics, each, tool if each.id == self.spec.held else np.array(each.position))
            for each in self.spec.objects
        ]
        self._by_body = {block.body: block for block in self._blocks}
        self._steps = 0
        closed = self.spec.gripper_closed or self.spec.held is not None
        gaps, commanded = [], []
        for number, arm in enumerate(self.robot.arms.values()):
            most = arm.gripper.max_opening
            shut = closed and number == 0
            gaps.append(BLOCK if self.spec.held is not None and number == 0 else 0.0 if shut else most)
            commanded.append(0.0 if shut else most)
        self._robot.place(posture, gaps, commanded)
        for _ in range(SETTLE_STEPS):
            self._advance()
        self._robot.park()
        for block in self._blocks:
            if block.id != self.spec.held:
                self._physics.put_to_sleep(block.body)

    def _advance(self) -> None:
        """Simulate one step, whatever was commanded."""
        if self._steps % WATCH_STEPS == 0:
            for body in self._physics.touching_anywhere(self._robot.body):
                if body in self._by_body:
                    self._physics.wake(body)
        self._physics.step()
        self._robot.sense()
        self._state = None

    def _wake_all(self) -> None:
        for block in self._blocks:
            self._physics.wake(block.body)

    def _arm_state(self, number: int) -> ArmState:
        """What is true of an arm's hand."""
        robot = self._robot
        gripper = list(self.robot.arms.values())[number].gripper
        between = robot.between_fingers(number)
        return ArmState(
            gripper_opening=robot.measured_opening(number),
            # A gap below half of the largest counts as closed.
            gripper_closed=robot.openings[number] < gripper.max_opening / 2,
            pose_tool_in_world=robot.tool(number),
            held=next((block.id for block in self._blocks if block.body in between), None) if between else None,
            wrist_wrench=robot.wrist_wrench(number),
            finger_effort=robot.finger_effort(number),
        )

    def _openings(self, command: JointCommand) -> Sequence[float]:
        """The gap commanded for each arm [m]."""
        arms = self.robot.arms.values()
        given = command.gripper_opening
        openings = [given] * len(arms) if isinstance(given, float | int) else list(given)
        if len(openings) != len(arms):
            raise TwinError(f"gripper_opening must be one number, or one for each of {len(arms)} arms, got {given}")
        for opening, arm in zip(openings, arms, strict=True):
            if not 0.0 <= opening <= arm.gripper.max_opening + 1e-9:
                raise TwinError(f"gripper_opening must be in 0..{arm.gripper.max_opening} m, got {opening}")
        return openings

    def _base_twist(self, command: JointCommand) -> tuple[float, float]:
        """The commanded speeds of the base [m/s, rad/s]."""
        speed, turn = command.base_twist
        if not (math.isfinite(speed) and math.isfinite(turn)):
            raise TwinError(f"base_twist must be two finite numbers [m/s, rad/s], got {command.base_twist}")
        if self.robot.drive is None and (speed or turn):
            raise TwinError(f"{self.robot.name} has no wheels: base_twist must be (0, 0), got {command.base_twist}")
        return speed, turn

    def _physics_open(self) -> None:
        if not self._physics.open:
            raise TwinError("this world is closed")


def _ground(spec: SceneSpec, robot: RobotModel) -> Ground:
    """What a scene stands on."""
    return board_ground(robot) if spec.kind == "board" else table_ground(robot, TABLE_X, TABLE_Y)


def _start(spec: SceneSpec, robot: RobotModel) -> tuple[FloatArray, FloatArray]:
    """Posture of all arms (n,) [rad] and first arm's tool position (3,) [m] with which a scene starts.

    Raises:
        SceneError: The robot does not reach the position.
    """
    name, arm = next(iter(robot.arms.items()))
    home = robot.home[robot.slice_of(name)]
    if spec.gripper_position is None:
        return robot.home, arm.forward_kinematics(home).position
    tool = np.array(spec.gripper_position)
    found = arm.inverse_kinematics(tool, start=home, tolerance=1e-6)
    if len(home) >= 6:  # the hand points as at home, where that is in reach
        upright = Pose(tool, arm.forward_kinematics(home).orientation_xyzw)
        better = arm.inverse_kinematics(upright, start=home, posture=home, tolerance=1e-6)
        found = better if better.success else found
    if not found.success:
        raise SceneError(
            f"scene {spec.name!r}: gripper_position {spec.gripper_position} is out of {robot.name}'s reach by "
            f"{1000 * found.error:.1f} mm"
        )
    posture = robot.home.copy()
    posture[robot.slice_of(name)] = found.q
    return posture, tool
