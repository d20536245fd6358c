"""The door to PyBullet: one DIRECT client of our own, and the calls that the twin needs, each with its client.

PyBullet's default client is global to the process; nothing here ever uses it, so two worlds do not meet.
"""

import math
import os
import sys
import weakref
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pybullet
from numpy.typing import NDArray

from .errors import TwinError
from .objects.model import Part

RawPose = tuple[tuple[float, float, float], tuple[float, float, float, float]]
"""Position [m] and quaternion xyzw, as PyBullet gives them."""
Rgb = tuple[float, float, float]
Vector = Sequence[float]

GRAVITY = 9.81
CONTACT_ERP = 0.8
"""Part of a penetration that a step takes away. PyBullet's 0.2 lets a stack of eight sink and shift by 2 mm."""
CONTACT_MARGIN = 0.002
"""How near [m] bodies must be to count as neighbours. With PyBullet's 20 mm, blocks in neighbouring cells keep each
other awake. Bullet has one such number for the whole process; all our clients set the same."""
HULL_MARGIN = 0.001
"""Bullet puts this much [m] around a convex hull; ours are made smaller by as much, so that their surface is true."""
FAR = 100.0
"""Distance [m] at which nothing is near anything."""
SLEEP_BELOW = 1e-4
"""Bodies whose squared speed stays below this for two seconds sleep: 10 mm/s or 10 mrad/s."""


@dataclass(frozen=True, slots=True)
class ContactForce:
    """What acts on a body at one point of contact.

    Attributes:
        link: Link of the body.
        other: The body that pushes.
        other_link: Its link.
        point: Where, (3,) [m].
        force: Normal and friction force on the body, (3,) [N].
    """

    link: int
    other: int
    other_link: int
    point: NDArray[np.float64]
    force: NDArray[np.float64]


class Physics:
    """One physics client. Body and link numbers are PyBullet's; link -1 is the base."""

    def __init__(self, time_step: float, solver_iterations: int, *, window: bool = False) -> None:
        """Connect a client.

        Args:
            time_step: Length of a step [s].
            solver_iterations: Of the contact solver, each step.
            window: Show what happens in PyBullet's own window; one process can have one.

        Raises:
            TwinError: There is no display, or PyBullet has no client left (about a thousand may be open at once).
        """
        if window and sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
            raise TwinError("a window needs a display, and DISPLAY is not set: leave the window out, or use the page")
        self._client = pybullet.connect(pybullet.GUI if window else pybullet.DIRECT)
        if self._client < 0 and window:
            raise TwinError("PyBullet could not open its window: one is open already, or the display cannot be used")
        if self._client < 0:
            raise TwinError("PyBullet gives no further client: close worlds that are no longer used")
        self._closer = weakref.finalize(self, _disconnect, self._client)
        self.time_step = time_step
        self._robots: set[int] = set()
        # The default broadphase forgets distant pairs one by one in a rotation that no saved state holds, so that a
        # restored world would drift from the first one by micrometres. For fifty bodies the simple one is as fast.
        pybullet.resetSimulation(pybullet.RESET_USE_SIMPLE_BROADPHASE, physicsClientId=self._client)
        pybullet.setGravity(0, 0, -GRAVITY, physicsClientId=self._client)
        pybullet.setPhysicsEngineParameter(
            fixedTimeStep=time_step,
            numSolverIterations=solver_iterations,
            contactERP=CONTACT_ERP,
            contactBreakingThreshold=CONTACT_MARGIN,
            deterministicOverlappingPairs=1,
            physicsClientId=self._client,
        )

    def close(self) -> None:
        """Disconnect; later calls fail."""
        self._closer()

    @property
    def open(self) -> bool:
        """Whether the client is still connected."""
        return self._closer.alive

    # Making bodies

    def add_box(self, half_extents: Vector, position: Vector, mass: float, rgb: Rgb) -> int:
        """Add a box [m, kg]; mass 0 stands still for ever. Returns the body."""
        shape = pybullet.createCollisionShape(
            pybullet.GEOM_BOX, halfExtents=list(half_extents), physicsClientId=self._client
        )
        visual = pybullet.createVisualShape(
            pybullet.GEOM_BOX, halfExtents=list(half_extents), rgbaColor=[*rgb, 1], physicsClientId=self._client
        )
        return self._add_body(mass, shape, visual, position)

    def add_hull(
        self,
        corners: NDArray[np.float64],
        triangles: NDArray[np.int64],
        drawn: NDArray[np.float64],
        position: Vector,
        mass: float,
        rgb: Rgb,
    ) -> int:
        """Add a convex body.

        Args:
            corners: Corners of the collision hull around the centre of mass, (n, 3) [m].
            triangles: Corner numbers of the drawn faces, (m, 3).
            drawn: Corners of the drawn faces, (n, 3) [m].
            position: Centre of mass [m].
            mass: Mass [kg].
            rgb: Colour.
        """
        shape = pybullet.createCollisionShape(
            pybullet.GEOM_MESH, vertices=corners.tolist(), physicsClientId=self._client
        )
        return self._add_body(mass, shape, self._mesh_visual(drawn, triangles, rgb), position)

    def add_parts(
        self,
        parts: Sequence[Part],
        hulls: Path | None,
        drawn: Sequence[tuple[Path, Rgb]],
        pose: RawPose,
        mass: float,
        inertial: RawPose,
        inertia: Vector,
    ) -> int:
        """Add a body of several convex parts.

        Args:
            parts: Its parts; those that are hulls are read from a file instead.
            hulls: OBJ file with a group for each hull, made smaller by `HULL_MARGIN`; None without hulls.
            drawn: OBJ files of the drawn faces with their colours.
            pose: Body frame in the world.
            mass: Mass [kg].
            inertial: Centre of mass and principal axes in the body frame; `base_pose` gives this frame.
            inertia: Principal moments, (3,) [kg m^2].
        """
        true = [part for part in parts if part.kind != "hull"]
        kinds = {"box": pybullet.GEOM_BOX, "sphere": pybullet.GEOM_SPHERE, "cylinder": pybullet.GEOM_CYLINDER}
        files = [str(hulls)] if hulls is not None else []
        shape = pybullet.createCollisionShapeArray(
            shapeTypes=[kinds[part.kind] for part in true] + [pybullet.GEOM_MESH] * len(files),
            halfExtents=[part.size.tolist() for part in true] + [[0, 0, 0]] * len(files),
            radii=[float(part.size[0]) for part in true] + [0] * len(files),
            lengths=[2 * float(part.size[2]) for part in true] + [0] * len(files),
            fileNames=[""] * len(true) + files,
            collisionFramePositions=[part.pose.position.tolist() for part in true] + [[0, 0, 0]] * len(files),
            collisionFrameOrientations=[part.pose.orientation_xyzw.tolist() for part in true]
            + [[0, 0, 0, 1]] * len(files),
            physicsClientId=self._client,
        )
        visual = pybullet.createVisualShapeArray(
            shapeTypes=[pybullet.GEOM_MESH] * len(drawn),
            fileNames=[str(path) for path, _ in drawn],
            rgbaColors=[[*rgb, 1] for _, rgb in drawn],
            meshScales=[[1, 1, 1]] * len(drawn),
            visualFramePositions=[[0, 0, 0]] * len(drawn),
            visualFrameOrientations=[[0, 0, 0, 1]] * len(drawn),
            physicsClientId=self._client,
        )
        if shape < 0 or visual < 0:
            raise TwinError(f"PyBullet cannot make a body of {[*files, *(str(path) for path, _ in drawn)]}")
        body = int(
            pybullet.createMultiBody(
                mass,
                shape,
                visual,
                pose[0],
                pose[1],
                baseInertialFramePosition=inertial[0],
                baseInertialFrameOrientation=inertial[1],
                physicsClientId=self._client,
            )
        )
        pybullet.changeDynamics(body, -1, localInertiaDiagonal=list(inertia), physicsClientId=self._client)
        return body

    def add_picture(self, corners: NDArray[np.float64], triangles: NDArray[np.int64], rgb: Rgb) -> None:
        """Add faces that are only drawn: corners (n, 3) [m] in the world, triangles (m, 3)."""
        self._add_body(0, -1, self._mesh_visual(corners, triangles, rgb), (0, 0, 0))

    def _mesh_visual(self, corners: NDArray[np.float64], triangles: NDArray[np.int64], rgb: Rgb) -> int:
        # Every face gets corners of its own, so that it is lit flat.
        flat = corners[triangles.ravel()]
        sides = flat.reshape(-1, 3, 3)
        normals = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        return int(
            pybullet.createVisualShape(
                pybullet.GEOM_MESH,
                vertices=flat.tolist(),
                indices=list(range(len(flat))),
                normals=np.repeat(normals, 3, axis=0).tolist(),
                rgbaColor=[*rgb, 1],
                physicsClientId=self._client,
            )
        )

    def _add_body(self, mass: float, shape: int, visual: int, position: Vector) -> int:
        return int(pybullet.createMultiBody(mass, shape, visual, list(position), physicsClientId=self._client))

    def add_robot(self, urdf: Path, pose: RawPose, *, fixed: bool = True) -> int:
        """Load a URDF, its base fixed or free to move. Returns the body.

        Raises:
            TwinError: PyBullet cannot load it.
        """
        try:
            body = int(
                pybullet.loadURDF(
                    str(urdf),
                    pose[0],
                    pose[1],
                    useFixedBase=fixed,
                    flags=pybullet.URDF_USE_INERTIA_FROM_FILE | pybullet.URDF_USE_IMPLICIT_CYLINDER,
                    physicsClientId=self._client,
                )
            )
        except pybullet.error as error:
            raise TwinError(f"{urdf}: PyBullet cannot load it: {error}") from error
        self._robots.add(body)
        return body

    def set_friction(
        self,
        body: int,
        link: int,
        lateral: float,
        *,
        spinning: float = 0.0,
        rolling: float = 0.0,
        anchored: bool = False,
    ) -> None:
        """Set a link's friction: coefficient, and arms of the torque against spinning and rolling [m].

        `anchored` makes static friction hold a place, not only a speed of 0.
        """
        pybullet.changeDynamics(
            body,
            link,
            lateralFriction=lateral,
            spinningFriction=spinning,
            rollingFriction=rolling,
            frictionAnchor=anchored,
            physicsClientId=self._client,
        )

    # Sleep: bodies that rest are left out of the solver until something that moves touches them

    def let_sleep(self, body: int) -> None:
        """Let a body fall asleep when it has rested for two seconds."""
        pybullet.changeDynamics(
            body,
            -1,
            activationState=pybullet.ACTIVATION_STATE_ENABLE_SLEEPING,
            sleepThreshold=SLEEP_BELOW,
            physicsClientId=self._client,
        )

    def put_to_sleep(self, body: int) -> None:
        """Put a resting body to sleep now."""
        pybullet.changeDynamics(body, -1, activationState=pybullet.ACTIVATION_STATE_SLEEP, physicsClientId=self._client)

    def wake(self, body: int) -> None:
        """Wake a body, with two seconds before it may sleep again."""
        pybullet.changeDynamics(
            body, -1, activationState=pybullet.ACTIVATION_STATE_WAKE_UP, physicsClientId=self._client
        )

    # Joints

    def joints(self, body: int) -> dict[str, int]:
        """Joint numbers by name, fixed joints included."""
        count = pybullet.getNumJoints(body, physicsClientId=self._client)
        return {self._joint_info(body, joint)[1].decode(): joint for joint in range(count)}

    def links(self, body: int) -> dict[str, int]:
        """Link numbers by name."""
        count = pybullet.getNumJoints(body, physicsClientId=self._client)
        return {self._joint_info(body, joint)[12].decode(): joint for joint in range(count)}

    def joint_force(self, body: int, joint: int) -> float:
        """Largest force [N] or torque [Nm] that the URDF gives a joint; 0 where it gives none."""
        return float(self._joint_info(body, joint)[10])

    def _joint_info(self, body: int, joint: int) -> tuple[bytes, ...]:
        info: tuple[bytes, ...] = pybullet.getJointInfo(body, joint, physicsClientId=self._client)
        return info

    def reset_joint(self, body: int, joint: int, position: float) -> None:
        """Place a joint at rest [rad or m]; only before a world starts."""
        pybullet.resetJointState(body, joint, position, 0.0, physicsClientId=self._client)

    def links_behind(self, body: int, joint: int) -> list[int]:
        """The link that a joint carries and all links behind it."""
        found = [joint]
        for other in range(joint + 1, pybullet.getNumJoints(body, physicsClientId=self._client)):
            if int(self._joint_info(body, other)[16]) in found:
                found.append(other)
        return found

    def moving_joint_of(self, body: int, link: int) -> int:
        """The movable joint nearest to a link on the way to the base."""
        while link >= 0 and int(self._joint_info(body, link)[2]) == pybullet.JOINT_FIXED:
            link = int(self._joint_info(body, link)[16])
        return link

    def brake(self, body: int, force: float) -> int:
        """Fix a body's base where it is, with a limited force [N, Nm]. Returns the constraint."""
        position, orientation = pybullet.getBasePositionAndOrientation(body, physicsClientId=self._client)
        brake = pybullet.createConstraint(
            body,
            -1,
            -1,
            -1,
            pybullet.JOINT_FIXED,
            [0, 0, 0],
            [0, 0, 0],
            position,
            [0, 0, 0, 1],
            orientation,
            physicsClientId=self._client,
        )
        pybullet.changeConstraint(brake, maxForce=force, physicsClientId=self._client)
        return int(brake)

    def release(self, constraint: int) -> None:
        """Take a constraint away."""
        pybullet.removeConstraint(constraint, physicsClientId=self._client)

    def base_twist(self, body: int) -> NDArray[np.float64]:
        """Velocity of a body's base frame (that of the URDF), (6,): linear [m/s], angular [rad/s], world's axes."""
        (vx, vy, vz), (wx, wy, wz) = pybullet.getBaseVelocity(body, physicsClientId=self._client)
        # That is of the centre of mass.
        x, y, z = (a - b for a, b in zip(self.base_frame(body)[0], self.base_pose(body)[0], strict=True))
        return np.array([vx + wy * z - wz * y, vy + wz * x - wx * z, vz + wx * y - wy * x, wx, wy, wz])

    def gear(self, body: int, first: int, second: int, ratio: float, force: float) -> None:
        """Couple two joints: the velocity of the first plus `ratio` times that of the second stays 0."""
        gear = pybullet.createConstraint(
            body,
            first,
            body,
            second,
            pybullet.JOINT_GEAR,
            [0, 1, 0],
            [0, 0, 0],
            [0, 0, 0],
            physicsClientId=self._client,
        )
        pybullet.changeConstraint(
            gear, gearRatio=ratio, maxForce=force, erp=0.5, relativePositionTarget=0, physicsClientId=self._client
        )

    def drive(self, body: int, joints: list[int], targets: list[float], forces: list[float]) -> None:
        """Drive joints so that after the next step they are at the targets, forces [N, Nm] permitting."""
        ones = [1.0] * len(joints)
        pybullet.setJointMotorControlArray(
            body,
            joints,
            pybullet.POSITION_CONTROL,
            targetPositions=targets,
            positionGains=ones,
            velocityGains=ones,
            forces=forces,
            physicsClientId=self._client,
        )

    def drive_slowly(self, body: int, joint: int, target: float, force: float, speed: float) -> None:
        """Drive one joint toward a target with limited force and speed [per s]."""
        pybullet.setJointMotorControl2(
            body,
            joint,
            pybullet.POSITION_CONTROL,
            targetPosition=target,
            positionGain=1.0,
            velocityGain=1.0,
            force=force,
            maxVelocity=speed,
            physicsClientId=self._client,
        )

    def spin(self, body: int, joints: list[int], speeds: list[float], force: float) -> None:
        """Drive joints at speeds [rad/s] with a limited torque [Nm]."""
        pybullet.setJointMotorControlArray(
            body,
            joints,
            pybullet.VELOCITY_CONTROL,
            targetVelocities=speeds,
            forces=[force] * len(joints),
            physicsClientId=self._client,
        )

    def joint_states(self, body: int, joints: list[int]) -> list[tuple[float, float, float]]:
        """Position, velocity and the motor's effort of each joint."""
        states = pybullet.getJointStates(body, joints, physicsClientId=self._client)
        return [(position, velocity, effort) for position, velocity, _, effort in states]

    # Poses and contacts

    def base_pose(self, body: int) -> RawPose:
        """Pose of a body's centre of mass in the world."""
        pose: RawPose = pybullet.getBasePositionAndOrientation(body, physicsClientId=self._client)
        return pose

    def base_frame(self, body: int) -> RawPose:
        """Pose of a body's base frame (that of the URDF) in the world."""
        position, orientation = pybullet.getBasePositionAndOrientation(body, physicsClientId=self._client)
        local = pybullet.getDynamicsInfo(body, -1, physicsClientId=self._client)
        inverse = pybullet.invertTransform(local[3], local[4], physicsClientId=self._client)
        pose: RawPose = pybullet.multiplyTransforms(position, orientation, *inverse, physicsClientId=self._client)
        return pose

    def link_pose(self, body: int, link: int) -> RawPose:
        """Pose of a link's frame (that of the URDF) in the world."""
        state = pybullet.getLinkState(body, link, computeForwardKinematics=True, physicsClientId=self._client)
        return state[4], state[5]

    def touching(self, body: int, link: int, within: float) -> set[int]:
        """Bodies whose surface is within a distance [m] of a link's, as of the last step."""
        points = pybullet.getContactPoints(bodyA=body, linkIndexA=link, physicsClientId=self._client)
        return {point[2] for point in points if point[8] <= within}

    def touching_anywhere(self, body: int, within: float = math.inf) -> set[int]:
        """Bodies near any link of a body, or within a distance [m] of one, as of the last step."""
        points = pybullet.getContactPoints(bodyA=body, physicsClientId=self._client)
        return {point[2] for point in points if point[8] <= within}

    def contact_forces(self, body: int) -> list[ContactForce]:
        """What pushes on a body, as of the last step. Torques of spinning and rolling friction are left out."""
        points = pybullet.getContactPoints(bodyA=body, physicsClientId=self._client)
        return [
            ContactForce(
                link=point[3],
                other=point[2],
                other_link=point[4],
                point=np.array(point[5]),
                force=point[9] * np.array(point[7]) + point[10] * np.array(point[11]) + point[12] * np.array(point[13]),
            )
            for point in points
            if point[9] > 0.0
        ]

    def mass_of(self, body: int) -> tuple[float, RawPose, tuple[float, float, float]]:
        """Mass [kg] of a body without joints, its centre of mass and principal axes in the world, and moments.

        A body that stands still for ever has mass 0.
        """
        mass, _, moments, *_ = pybullet.getDynamicsInfo(body, -1, physicsClientId=self._client)
        return float(mass), self.base_pose(body), moments

    # Time

    def step(self) -> None:
        """Simulate one step."""
        pybullet.stepSimulation(physicsClientId=self._client)

    def save(self) -> int:
        """Keep the present state in memory; returns its number."""
        return int(pybullet.saveState(physicsClientId=self._client))

    def restore(self, state: int) -> None:
        """Go back to a kept state. Motor targets are not part of it.

        Bullet remembers contacts by pairs of their parts, but gives back those of only one pair for each two bodies;
        those of the others stay as they are. So all are forgotten first, by moving everything apart: else what comes
        after would depend on what was before.
        """
        count = pybullet.getNumBodies(physicsClientId=self._client)
        bodies = [pybullet.getBodyUniqueId(number, physicsClientId=self._client) for number in range(count)]
        others = [body for body in bodies if body not in self._robots]
        poses = [self.base_pose(body) for body in others]
        for number, (body, (_, orientation)) in enumerate(zip(others, poses, strict=True)):
            self._put(body, ((FAR * (number + 1), FAR, 0.0), orientation))
        pybullet.performCollisionDetection(physicsClientId=self._client)
        for body, pose in zip(others, poses, strict=True):
            self._put(body, pose)  # what stands still for ever is not part of a state
        pybullet.restoreState(stateId=state, physicsClientId=self._client)

    def _put(self, body: int, pose: RawPose) -> None:
        pybullet.resetBasePositionAndOrientation(body, *pose, physicsClientId=self._client)

    def forget(self, state: int) -> None:
        """Free a kept state."""
        if self.open:
            pybullet.removeState(state, physicsClientId=self._client)

    # Pictures

    def picture(self, width: int, height: int, eye: Vector, target: Vector, field_of_view: float) -> NDArray[np.uint8]:
        """Draw the scene with PyBullet's own software renderer, (height, width, 3).

        Args:
            width: Width [pixel].
            height: Height [pixel].
            eye: Where the camera is [m].
            target: What it looks at [m].
            field_of_view: Vertical angle [degree].
        """
        view = pybullet.computeViewMatrix(list(eye), list(target), [0, 0, 1], physicsClientId=self._client)
        projection = pybullet.computeProjectionMatrixFOV(
            field_of_view, width / height, 0.05, 5.0, physicsClientId=self._client
        )
        image = pybullet.getCameraImage(
            width,
            height,
            view,
            projection,
            lightDirection=[-0.6, -0.9, 1.6],
            shadow=True,
            renderer=pybullet.ER_TINY_RENDERER,
            physicsClientId=self._client,
        )
        return np.reshape(np.asarray(image[2], dtype=np.uint8), (height, width, 4))[:, :, :3].copy()


def _disconnect(client: int) -> None:
    """Close one client; the interpreter may already have taken it down."""
    if pybullet.isConnected(client):
        pybullet.disconnect(client)
