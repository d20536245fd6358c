"""Distances that do not depend on what a process asked before.

coal's support function of a box keeps a number from its very first call in a process (`static const inflate`, 1 or
1 + 1e-10, by the direction asked for). Distances to boxes would differ by some 1e-11 m from one process to another,
and a demo of a hundred contacts simulated afresh by centimetres. So the first call is always the same one.
"""

import coal
import numpy as np


def settle() -> None:
    """Ask for the distance of two boxes at fixed places; what coal keeps of it is then always the same."""
    box = coal.Box(1.0, 1.0, 1.0)
    here = coal.Transform3s(np.eye(3), np.zeros(3))
    there = coal.Transform3s(np.eye(3), np.array([3.0, 0.0, 0.0]))
    coal.distance(box, here, box, there, coal.DistanceRequest(), coal.DistanceResult())


settle()
