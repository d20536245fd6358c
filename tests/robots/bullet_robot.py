"""A robot in a PyBullet client of its own: the other opinion on where its links are and how far apart."""

from collections.abc import Mapping
from typing import Self

import numpy as np
import pybullet

from robots import Pose, RobotModel


class BulletRobot:
    """Use with `with`."""

    def __init__(self, robot: RobotModel) -> None:
        self.client = pybullet.connect(pybullet.DIRECT)
        self.body = pybullet.loadURDF(
            str(robot.urdf_path),
            robot.pose_base_in_world.position,
            robot.pose_base_in_world.orientation_xyzw,
            useFixedBase=True,
            flags=pybullet.URDF_USE_IMPLICIT_CYLINDER | pybullet.URDF_USE_INERTIA_FROM_FILE,
            physicsClientId=self.client,
        )
        count = pybullet.getNumJoints(self.body, physicsClientId=self.client)
        infos = [pybullet.getJointInfo(self.body, joint, physicsClientId=self.client) for joint in range(count)]
        self.joints = {info[1].decode(): info[0] for info in infos}
        self.links = {info[12].decode(): info[0] for info in infos}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        pybullet.disconnect(self.client)

    def place(self, positions: Mapping[str, float]) -> None:
        for name, value in positions.items():
            pybullet.resetJointState(self.body, self.joints[name], value, physicsClientId=self.client)

    def frame(self, link: str) -> Pose:
        """Pose of a link's frame (that of the URDF) in the world."""
        state = pybullet.getLinkState(
            self.body, self.links[link], computeForwardKinematics=True, physicsClientId=self.client
        )
        return Pose(np.array(state[4]), np.array(state[5]))

    def mass(self, link: str) -> float:
        return float(pybullet.getDynamicsInfo(self.body, self.links[link], physicsClientId=self.client)[0])

    def add_box(self, size: np.ndarray, position: np.ndarray) -> int:
        shape = pybullet.createCollisionShape(
            pybullet.GEOM_BOX, halfExtents=(size / 2).tolist(), physicsClientId=self.client
        )
        return int(pybullet.createMultiBody(0, shape, -1, position.tolist(), physicsClientId=self.client))

    def between(self, one: str, other: str) -> float:
        """Distance of two links of the robot [m]."""
        points = pybullet.getClosestPoints(
            self.body, self.body, 0.5, self.links[one], self.links[other], physicsClientId=self.client
        )
        return float(min(point[8] for point in points))

    def distances(self, body: int) -> dict[str, float]:
        """Distance of each link that is within 2 m of a body [m]."""
        names = {number: name for name, number in self.links.items()}
        found: dict[str, float] = {}
        for point in pybullet.getClosestPoints(self.body, body, 2.0, physicsClientId=self.client):
            if point[3] in names:
                name = names[point[3]]
                found[name] = min(found.get(name, np.inf), float(point[8]))
        return found
