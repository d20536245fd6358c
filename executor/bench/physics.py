"""Physics: how many steps a second each twin makes, beside robosuite's Baxter."""

import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from executor.bench.report import BenchReport
from executor.bench.robosuite import robosuite_speed
from twin import JointCommand, SceneSpec, World

BATCH = 240
"""Steps that are timed together: a second of simulated time."""
LOOK_EVERY = 8
"""Steps between two looks at the whole state, as a recorder at 30 Hz takes them."""

_PRIMITIVES = (
    ("cube", "red", 0.55, -0.20),
    ("cube", "blue", 0.55, 0.20),
    ("cylinder", "green", 0.65, -0.10),
    ("cylinder", "yellow", 0.65, 0.10),
    ("sphere", "magenta", 0.75, -0.20),
    ("sphere", "cyan", 0.75, 0.20),
    ("cube", "white", 0.80, 0.0),
    ("cylinder", "gray", 0.60, 0.0),
)


def primitives_scene() -> SceneSpec:
    """Baxter at its table with eight cubes, cylinders and spheres."""
    objects = [
        {"id": number, "shape": shape, "colour": colour, "position": (x, y, 0.019)}
        for number, (shape, colour, x, y) in enumerate(_PRIMITIVES)
    ]
    return SceneSpec.model_validate({"name": "primitives", "kind": "table", "robot": "baxter", "objects": objects})


def run(
    seed: int, seconds: float = 20.0, log: Path | None = None, on_done: Callable[[], None] = lambda: None
) -> BenchReport:
    """Time every robot in its scene, with all joints moving.

    Args:
        seed: Decides the random scenes.
        seconds: Simulated time a robot [s].
        log: File for what installing and running robosuite says; None leaves robosuite out.
        on_done: Called after each scene.
    """
    scenes: dict[str, str | SceneSpec] = {
        "three_dof": "board",
        "baxter": primitives_scene(),
        "baxter_tabletop": "tabletop",
        "mico_segway": "ordering",
    }
    figures: dict[str, float | None] = {}
    for name, scene in scenes.items():
        rates = _rates(scene, seed, seconds)
        figures[f"{name}.steps_per_second"] = float(np.median(rates))
        figures[f"{name}.real_time_factor"] = float(np.median(rates)) * World.DT
        figures[f"{name}.real_time_factor_slowest"] = float(min(rates)) * World.DT
        on_done()
    baselines: dict[str, float | None] = {}
    notes: tuple[str, ...] = ()
    if log is not None:
        theirs, notes = robosuite_speed(seed, log)
        baselines = {f"robosuite.{key}": value for key, value in theirs.items()}
        own = figures["baxter.real_time_factor"]
        controlled = theirs.get("controlled_real_time_factor")
        if own is not None and controlled:
            # A ratio is ours over theirs here, because more is better.
            figures["baxter.ratio_vs_robosuite"] = own / controlled
        on_done()
    settings = {
        "showtell": f"{1 / World.DT:.0f} Hz steps, all joints moving, whole state read every {LOOK_EVERY} steps; "
        f"medians of {BATCH}-step batches over {seconds:g} s",
        "robosuite": "TwoArmLift with Baxter; controlled: env.step at 20 Hz with its default controller (two arms, "
        "gripper, 2 ms steps); raw: MuJoCo steps alone",
    }
    return BenchReport(figures, baselines, settings, notes)


def _rates(scene: str | SceneSpec, seed: int, seconds: float) -> Sequence[float]:
    """Steps a second of each batch, with every joint swinging gently about its home."""
    with World.from_scene(scene, seed=seed) as world:
        count = len(world.robot.joint_names)
        pace = 0.15 * world.robot.velocity
        phase = np.arange(count) * 0.7
        opening = [arm.gripper.max_opening for arm in world.robot.arms.values()]
        rates = []
        step = 0
        for _ in range(max(2, round(seconds / (BATCH * World.DT)))):
            began = time.perf_counter()
            for _ in range(BATCH):
                swing = np.cos(2.0 * np.pi * 0.5 * step * World.DT + phase)
                world.step(JointCommand(pace * swing, opening))
                step += 1
                if step % LOOK_EVERY == 0:
                    world.state()
            rates.append(BATCH / (time.perf_counter() - began))
    return rates
