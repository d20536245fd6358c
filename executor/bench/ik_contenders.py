"""The solvers that `showtell bench kinematics` compares: ours, PyBullet's and pink's, each made strong.

PyBullet and pink start from the home posture or a random one, and restart from random ones, drawn before the clock
starts. Their settings are chosen anew in every run, on pilot targets that are not among those measured.
"""

import importlib
import importlib.util
import math
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import pinocchio as pin
import pybullet

from executor.bench.ik_questions import MAX_RESTARTS, ORIENTATION_TOLERANCE, POSITION_TOLERANCE, ArmQuestion
from robots.inverse_kinematics import IkSolver
from robots.pose import FloatArray, Pose

Answer = tuple[FloatArray | None, int]
"""A posture (n,), or None without success, and how many restarts it took."""


class Contender(Protocol):
    """A solver for one arm."""

    def solve(self, target: Pose, starts: FloatArray) -> Answer:
        """Answer a question; `starts`, (1 + restarts, n), are random postures for those who need some."""

    def __str__(self) -> str:
        """The settings."""


class Ours:
    """`IkSolver`, as it comes."""

    def __init__(self, question: ArmQuestion) -> None:
        arm = question.arm
        self._solver = IkSolver(question.kinematics, arm.lower, arm.upper, arm.home)
        self._whole_pose = question.whole_pose

    def solve(self, target: Pose, starts: FloatArray) -> Answer:
        """See `Contender`; the starts are our own."""
        result = self._solver.solve(
            target if self._whole_pose else target.position,
            position_tolerance=POSITION_TOLERANCE,
            orientation_tolerance=ORIENTATION_TOLERANCE,
            max_restarts=MAX_RESTARTS,
        )
        return (result.q if result.success else None), result.restarts

    def __str__(self) -> str:
        """See `Contender`."""
        return "IkSolver with its default settings; starts from its table of postures"


class _Check:
    """Tells others when to stop: errors of a posture by Pinocchio over the short chain, in 2 µs, and wrapped angles."""

    def __init__(self, question: ArmQuestion) -> None:
        self._lower, self._upper = question.lower.tolist(), question.upper.tolist()
        self._arm_lower, self._arm_upper = question.arm.lower.tolist(), question.arm.upper.tolist()
        self.model = pin.buildModelFromUrdf(str(question.chain_urdf))
        self.data = self.model.createData()
        self.frame = self.model.getFrameId(question.chain_tip)
        self._whole_pose = question.whole_pose
        self._endless = any(question.endless)
        self._neutral = pin.neutral(self.model)

    def configuration(self, q: FloatArray) -> FloatArray:
        """Pinocchio's configuration of joint positions (n,): continuous joints are (cos, sin) there."""
        return np.asarray(pin.integrate(self.model, self._neutral, q)) if self._endless else q

    def met(self, q: FloatArray, target: Any) -> bool:
        """Whether a posture (n,) has its tool at a target, limits aside."""
        pin.forwardKinematics(self.model, self.data, self.configuration(q))
        return self.near(pin.updateFramePlacement(self.model, self.data, self.frame), target)

    def near(self, placement: Any, target: Any) -> bool:
        """Whether the tool's placement is at a target."""
        way = placement.actInv(target)
        linear = way.translation
        if linear.dot(linear) > POSITION_TOLERANCE**2:
            return False
        if not self._whole_pose:
            return True
        angular = pin.log3(way.rotation)
        return bool(angular.dot(angular) <= ORIENTATION_TOLERANCE**2)

    def wrapped(self, q: list[float]) -> FloatArray | None:
        """The same posture turned by whole turns into the limits, (n,), or None if that is not possible."""
        values = []
        for value, lower, upper in zip(q, self._arm_lower, self._arm_upper, strict=True):
            turned = value
            if value < lower:
                turned = value + 2.0 * math.pi * math.ceil((lower - value) / (2.0 * math.pi))
            elif value > upper:
                turned = value - 2.0 * math.pi * math.ceil((value - upper) / (2.0 * math.pi))
            if not lower <= turned <= upper:
                return None
            values.append(turned)
        return np.array(values)


@dataclass(frozen=True, slots=True)
class PyBulletSettings:
    """Arguments of `calculateInverseKinematics`."""

    damping: float | None
    iterations: int
    calls: int
    threshold: float
    home_first: bool = True
    null_space: bool = False


PYBULLET_CANDIDATES = (
    PyBulletSettings(None, 100, 3, 1e-5),
    PyBulletSettings(None, 100, 3, 1e-5, null_space=True),
    *(
        PyBulletSettings(damping, iterations, calls, threshold, home_first)
        for damping in (1e-2, 1e-3, 1e-4, 1e-6)
        for iterations, calls in ((20, 1), (20, 3), (100, 1))
        for threshold in (1e-4, 1e-5)
        for home_first in (True, False)
    ),
)
"""Tried on the pilot targets. IK_SDLS is left out: it ends the process (PyBullet 3.2.7)."""


class PyBulletIk:
    """`pybullet.calculateInverseKinematics` over a chain without meshes, called until the errors are small enough."""

    def __init__(self, question: ArmQuestion, client: int, settings: PyBulletSettings) -> None:
        self._client, self._settings = client, settings
        self._check = _Check(question)
        self._offset, self._whole_pose = question.offset_in_base, question.whole_pose
        self._home = question.arm.home[None]
        self._body = pybullet.loadURDF(str(question.chain_urdf), useFixedBase=True, physicsClientId=client)
        count = pybullet.getNumJoints(self._body, physicsClientId=client)
        joints = [pybullet.getJointInfo(self._body, index, physicsClientId=client) for index in range(count)]
        self._link = next(joint[0] for joint in joints if joint[12].decode() == question.chain_tip)
        names = [joint[1].decode() for joint in joints if joint[2] != pybullet.JOINT_FIXED]
        # PyBullet numbers movable joints along the chain; the arm may list them otherwise.
        self._order = [names.index(name) for name in question.arm.joint_names]
        self._back = [question.arm.joint_names.index(name) for name in names]
        self._keywords: dict[str, Any] = {
            "maxNumIterations": settings.iterations,
            "residualThreshold": settings.threshold,
            "physicsClientId": client,
        }
        if settings.damping is not None:
            self._keywords["jointDamping"] = [settings.damping] * len(names)
        if settings.null_space:
            lower, upper = question.lower[self._back], question.upper[self._back]
            self._keywords |= {
                "lowerLimits": lower.tolist(),
                "upperLimits": upper.tolist(),
                "jointRanges": (upper - lower).tolist(),
                "restPoses": (0.5 * (lower + upper)).tolist(),
            }

    def solve(self, target: Pose, starts: FloatArray) -> Answer:
        """See `Contender`."""
        position = target.position - self._offset
        goal = pin.XYZQUATToSE3(np.concatenate((position, target.orientation_xyzw)))
        if self._settings.home_first:
            starts = np.concatenate((self._home, starts[1:]))
        arguments = [position.tolist(), target.orientation_xyzw.tolist()][: 2 if self._whole_pose else 1]
        for restart, start in enumerate(starts.tolist()):
            q = [start[index] for index in self._back]
            for _ in range(self._settings.calls):
                q = pybullet.calculateInverseKinematics(
                    self._body, self._link, *arguments, currentPositions=q, **self._keywords
                )
                ordered = [q[index] for index in self._order]
                if self._check.met(np.array(ordered), goal):
                    found = self._check.wrapped(ordered)
                    if found is not None:
                        return found, restart
                    break
        return None, len(starts) - 1

    def __str__(self) -> str:
        """See `Contender`."""
        each = self._settings
        damping = "its own damping" if each.damping is None else f"jointDamping {each.damping:g}"
        space = ", limits, ranges and rest poses given" if each.null_space else ""
        return (
            f"IK_DLS, {damping}, maxNumIterations {each.iterations}, residualThreshold {each.threshold:g}, up to "
            f"{each.calls} calls a start{space}; chain without meshes; {_starts_text(each.home_first)}"
        )


@dataclass(frozen=True, slots=True)
class PinkSettings:
    """Settings of a frame task and of `solve_ik`."""

    lm_damping: float
    damping: float
    limit_gain: float
    steps: int
    home_first: bool


PINK_CANDIDATES = tuple(
    PinkSettings(lm_damping, damping, limit_gain, steps, home_first)
    for lm_damping, damping in ((0.0, 1e-6), (1e-3, 1e-6), (1e-2, 1e-12), (1e-1, 1e-12))
    for limit_gain in (0.5, 1.0)
    for steps in (15, 40)
    for home_first in (True, False)
)
"""Tried on the pilot targets."""


class PinkIk:
    """`pink.solve_ik` with quadprog, a frame task and joint limits, stepped until the errors are small enough."""

    def __init__(self, question: ArmQuestion, settings: PinkSettings) -> None:
        _load_quadprog()
        import pink
        from pink.limits import ConfigurationLimit

        self._settings = settings
        self._check = _Check(question)
        model = self._check.model
        self._offset, self._home = question.offset_in_base, question.arm.home[None]
        self._solve_ik = pink.solve_ik
        cost = 1.0 if question.whole_pose else 0.0
        self._task = pink.tasks.FrameTask(
            question.chain_tip, position_cost=1.0, orientation_cost=cost, lm_damping=settings.lm_damping
        )
        self._limits = [ConfigurationLimit(model, config_limit_gain=settings.limit_gain)]
        self._configuration = pink.Configuration(model, self._check.data, pin.neutral(model), copy_data=False)
        names = list(model.names)[1:]
        self._order = [names.index(name) for name in question.arm.joint_names]
        self._back = [question.arm.joint_names.index(name) for name in names]

    def solve(self, target: Pose, starts: FloatArray) -> Answer:
        """See `Contender`."""
        goal = pin.XYZQUATToSE3(np.concatenate((target.position - self._offset, target.orientation_xyzw)))
        self._task.set_target(goal)
        if self._settings.home_first:
            starts = np.concatenate((self._home, starts[1:]))
        configuration, check = self._configuration, self._check
        for restart, start in enumerate(starts):
            q = start[self._back]
            configuration.update(check.configuration(q))
            for _ in range(self._settings.steps):
                if check.near(pin.updateFramePlacement(check.model, check.data, check.frame), goal):
                    found = check.wrapped(q[self._order].tolist())
                    if found is not None:
                        return found, restart
                    break
                try:
                    velocity = self._solve_ik(
                        configuration,
                        [self._task],
                        1.0,
                        solver="quadprog",
                        damping=self._settings.damping,
                        limits=self._limits,
                        safety_break=False,
                    )
                except Exception as error:  # quadprog has no solution here, which pink tells in several classes
                    if isinstance(error, MemoryError):
                        raise
                    break
                q = q + velocity
                configuration.update(check.configuration(q))
        return None, len(starts) - 1

    def __str__(self) -> str:
        """See `Contender`."""
        each = self._settings
        return (
            f"quadprog, lm_damping {each.lm_damping:g}, damping {each.damping:g}, gain 1, dt 1, "
            f"config_limit_gain {each.limit_gain:g}, up to {each.steps} steps a start; {_starts_text(each.home_first)}"
        )


def _starts_text(home_first: bool) -> str:
    return "home posture first, then random starts" if home_first else "random starts"


def _load_quadprog() -> None:
    """Import quadprog so that it calls its own functions.

    It exports a function `dot`, and so does the library of highspy: where that was loaded before, quadprog would call
    the wrong one and end the process.
    """
    flags = sys.getdlopenflags()
    sys.setdlopenflags(flags | getattr(os, "RTLD_DEEPBIND", 0))
    try:
        importlib.import_module("quadprog")
    finally:
        sys.setdlopenflags(flags)


def pink_is_there() -> bool:
    """Whether pink and quadprog are installed (`pip install showtell[bench]`)."""
    return all(importlib.util.find_spec(name) is not None for name in ("pink", "quadprog"))


@contextmanager
def pybullet_client() -> Iterator[int]:
    """A client of our own."""
    client = pybullet.connect(pybullet.DIRECT)
    try:
        yield client
    finally:
        pybullet.disconnect(physicsClientId=client)
