"""Inverse kinematics: ours, PyBullet's and pink's, on the same reachable random targets with the same restarts."""

import gc
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from executor.bench.ik_contenders import (
    PINK_CANDIDATES,
    PYBULLET_CANDIDATES,
    Contender,
    Ours,
    PinkIk,
    PyBulletIk,
    pink_is_there,
    pybullet_client,
)
from executor.bench.ik_questions import (
    MAX_RESTARTS,
    ORIENTATION_TOLERANCE,
    POSITION_TOLERANCE,
    ArmQuestion,
    arm_question,
)
from executor.bench.report import BenchReport
from robots import list_robots, load_robot
from robots.pose import Pose

PILOT = 100
"""Targets on which the others' settings are chosen; they are not measured."""

BLOCK = 50


@dataclass(slots=True)
class Tally:
    """How one contender did on the targets of a robot.

    Attributes:
        seconds: Time a target, restarts and failures included [s].
        solved: Whether the judge agreed, for each.
        restarts: How many there were, for each.
    """

    seconds: list[float] = field(default_factory=list)
    solved: list[bool] = field(default_factory=list)
    restarts: list[int] = field(default_factory=list)

    def ask(self, contender: Contender, question: ArmQuestion, target: Pose, starts: np.ndarray) -> None:
        """Ask a contender, and the judge."""
        begun = time.perf_counter()
        q, restarts = contender.solve(target, starts)
        self.seconds.append(time.perf_counter() - begun)
        self.solved.append(question.solved(q, target))
        self.restarts.append(restarts)

    @property
    def success(self) -> float:
        """Share of the targets that were solved."""
        return float(np.mean(self.solved))

    @property
    def median(self) -> float:
        """Median time a target [s]."""
        return float(np.median(self.seconds))

    def figures(self, prefix: str) -> dict[str, float | None]:
        """The figures under a dotted prefix."""
        micro = 1e6 * np.array(self.seconds)
        return {
            f"{prefix}.success": self.success,
            f"{prefix}.median_us": float(np.median(micro)),
            f"{prefix}.mean_us": float(np.mean(micro)),
            f"{prefix}.p99_us": float(np.percentile(micro, 99)),
            f"{prefix}.first_try": float(np.mean(np.array(self.solved) & (np.array(self.restarts) == 0))),
            f"{prefix}.most_restarts": float(max(self.restarts)),
        }


def run(
    seed: int,
    targets: int = 2000,
    robots: Sequence[str] | None = None,
    progress: Callable[[], None] = lambda: None,
    baseline_targets: int | None = None,
) -> BenchReport:
    """Ask all contenders the same questions, one after the other.

    A target is the tool pose of a random posture inside the limits; an arm with fewer than six joints is asked for its
    position alone. The judge is Pinocchio's forward kinematics of the whole arm and its joint limits. Times are end to
    end for each target, restarts included; a failure counts with the time until it was given up. The figures of a
    robot with several arms are over the targets of all of them.

    Args:
        seed: Decides targets and random starts.
        targets: How many an arm.
        robots: Names; None takes all that come with Showtell.
        progress: Called after each arm.
        baseline_targets: How many of them the others are asked; None asks all.

    Returns:
        Ours under `<robot>.`, the others under `pybullet.<robot>.` and `pink.<robot>.`; ratios are medians, theirs over
        ours.
    """
    figures: dict[str, float | None] = {}
    baselines: dict[str, float | None] = {}
    settings = {
        "tolerances": f"{1000 * POSITION_TOLERANCE:g} mm, {1000 * ORIENTATION_TOLERANCE:g} mrad",
        "restarts": f"at most {MAX_RESTARTS}; times include them and failures",
        "targets": f"{targets} an arm, of random postures inside the limits",
    }
    with TemporaryDirectory() as folder, pybullet_client() as client:
        for number, name in enumerate(robots or list_robots()):
            robot = load_robot(name)
            tallies = {"ours": Tally(), "pybullet": Tally(), "pink": Tally()}
            for index, arm in enumerate(robot.arms.values()):
                question = arm_question(robot, arm, Path(folder))
                rng = np.random.default_rng([seed, number, index])
                contenders = _contenders(question, client, np.random.default_rng([seed, number, index, 1]))
                for each, contender in contenders.items():
                    settings[f"{each}.{name}.{arm.name}"] = str(contender)
                _measure(question, contenders, rng, targets, baseline_targets or targets, tallies)
                progress()
            ours = tallies.pop("ours")
            figures |= ours.figures(name)
            for other, tally in tallies.items():
                figures[f"{name}.ratio_vs_{other}"] = tally.median / ours.median if tally.seconds else None
                if tally.seconds:
                    baselines |= tally.figures(f"{other}.{name}")
    missing = () if pink_is_there() else ("pink is not installed: pip install 'showtell[bench]' to compare with it",)
    return BenchReport(figures, baselines, settings, missing)


def _contenders(question: ArmQuestion, client: int, rng: np.random.Generator) -> dict[str, Contender]:
    """Ours, and the others with the settings that did best on pilot targets."""
    contenders: dict[str, Contender] = {"ours": Ours(question)}
    pilot = question.targets(rng, PILOT)
    starts = [question.postures(rng, MAX_RESTARTS + 1) for _ in pilot]
    choices: dict[str, list[Contender]] = {
        "pybullet": [PyBulletIk(question, client, each) for each in PYBULLET_CANDIDATES],
        "pink": [PinkIk(question, each) for each in PINK_CANDIDATES] if pink_is_there() else [],
    }
    for name, candidates in choices.items():
        best: tuple[float, float] | None = None
        for candidate in candidates:
            tally = Tally()
            for target, random in zip(pilot, starts, strict=True):
                tally.ask(candidate, question, target, random)
            # Within 2% of the best success, the fastest: successes are compared in steps of that size.
            rank = (-round(50.0 * tally.success), tally.median)
            if best is None or rank < best:
                best, contenders[name] = rank, candidate
    for target, random in zip(pilot, starts, strict=True):
        contenders["ours"].solve(target, random)  # the compiler and the table of postures are no part of a question
    return contenders


def _measure(
    question: ArmQuestion,
    contenders: dict[str, Contender],
    rng: np.random.Generator,
    targets: int,
    baseline_targets: int,
    tallies: dict[str, Tally],
) -> None:
    """Ask every target, in blocks of which one contender after the other has all.

    Blocks are long enough that each works with warm caches, as it would in a loop of its own, and short enough that a
    machine that slows down does so for all.
    """
    names = list(contenders)
    asked = question.targets(rng, targets)
    for number, begin in enumerate(range(0, targets, BLOCK)):
        block = [(target, question.postures(rng, MAX_RESTARTS + 1)) for target in asked[begin : begin + BLOCK]]
        first = number % len(names)
        for name in names[first:] + names[:first]:
            # A collection of garbage would fall on whoever is being timed.
            gc.collect()
            gc.disable()
            try:
                for index, (target, starts) in enumerate(block):
                    if name == "ours" or begin + index < baseline_targets:
                        tallies[name].ask(contenders[name], question, target, starts)
            finally:
                gc.enable()
