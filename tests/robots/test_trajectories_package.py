"""The package's public names resolve, and loading it loads nothing heavy."""

import subprocess
import sys

import robots.trajectories as trajectories


def test_every_public_name_resolves_to_what_it_names() -> None:
    for name in trajectories.__all__:
        assert getattr(trajectories, name).__name__ == name


def test_loading_the_package_loads_no_heavy_library() -> None:
    code = "import sys, robots.trajectories; print({'ruckig', 'scipy', 'ompl', 'pinocchio'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"
    planned = (
        "import sys, numpy as np; from robots.trajectories import JointLimits, plan_path; one = np.ones(1);"
        "limits = JointLimits(-one, one, one, one, one);"
        "plan_path(0 * one, 0.5 * one, limits, lambda q: True, np.random.default_rng(0)); print('ompl' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", planned], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
