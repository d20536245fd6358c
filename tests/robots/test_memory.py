"""What is done at every step keeps no memory."""

import sys

import numpy as np
import pytest

from executor.execution.evaluation.endurance import resident
from robots.kinematics import quaternion_xyzw, rotation_matrix


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="/proc tells the memory of a process on Linux alone")
def test_turns_between_matrices_and_quaternions_keep_no_memory() -> None:
    turn = rotation_matrix(np.array([0.1, 0.2, 0.3, 0.9]))
    before = resident()
    for _ in range(200_000):
        turn = rotation_matrix(quaternion_xyzw(turn))
    assert resident() < before + 4.0  # 80 bytes of each would be 16 MB
