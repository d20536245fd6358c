"""robosuite's Baxter for comparison, in an environment of its own (it wants other versions than we do)."""

import json
import os
import subprocess
import sys
from pathlib import Path

from robots.cache import user_folder

PACKAGES = ("robosuite==1.5.2", "mujoco==3.3.7", "numpy<2")
"""What is installed: robosuite 1.5.2 does not work with MuJoCo 4 (an assertion about joint types fails)."""

_SCRIPT = """
import json, time
import numpy as np
import robosuite
env = robosuite.make("TwoArmLift", robots="Baxter", has_renderer=False, has_offscreen_renderer=False,
                     use_camera_obs=False, control_freq=20, horizon=100000, ignore_done=True)
env.reset()
rng = np.random.default_rng(SEED)
for _ in range(20):  # its just-in-time compiler has its time before we look
    env.step(rng.uniform(-0.1, 0.1, env.action_dim))
began = time.perf_counter()
for _ in range(200):
    env.step(rng.uniform(-0.1, 0.1, env.action_dim))
controlled = 200 / 20 / (time.perf_counter() - began)
step = env.sim.model.opt.timestep
began = time.perf_counter()
for _ in range(5000):
    env.sim.step()
raw = 5000 * step / (time.perf_counter() - began)
print("RESULT " + json.dumps({"controlled_real_time_factor": controlled, "raw_real_time_factor": raw,
                              "raw_steps_per_second": raw / step}))
"""


def robosuite_speed(seed: int, log: Path) -> tuple[dict[str, float | None], tuple[str, ...]]:
    """Install robosuite beside us, once, and time its Baxter.

    Args:
        seed: Of its random actions.
        log: Where the output of installing and running is kept.

    Returns:
        Its figures, and notes; no figures and the reason where it cannot be installed or run.
    """
    home = user_folder("robosuite")
    python = home / "bin" / "python"
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("w", encoding="utf-8") as out:
        if not (home / "installed").is_file():
            steps = ([sys.executable, "-m", "venv", str(home)], [str(python), "-m", "pip", "install", *PACKAGES])
            for command in steps:
                if subprocess.run(command, stdout=out, stderr=subprocess.STDOUT, check=False).returncode != 0:
                    return {}, (f"robosuite could not be installed: see {log}",)
            (home / "installed").touch()
        done = subprocess.run(
            [str(python), "-c", _SCRIPT.replace("SEED", str(seed))],
            stdout=subprocess.PIPE,
            stderr=out,
            text=True,
            check=False,
            env={**os.environ, "MUJOCO_GL": "egl"},
        )
        out.write(done.stdout)
    lines = [line for line in done.stdout.splitlines() if line.startswith("RESULT ")]
    if done.returncode != 0 or not lines:
        return {}, (f"robosuite was installed but did not run: see {log}",)
    figures: dict[str, float | None] = json.loads(lines[-1].removeprefix("RESULT "))
    return figures, (f"robosuite's output is in {log}",)
