"""The feel of a stick: a dead zone around the centre, and finer motion beyond it."""


def shape(deflection: float, dead_zone: float, expo: float) -> float:
    """Shape a deflection -1..1: zero up to the dead zone, from zero at its edge; `expo` 0 is linear, 1 cubic."""
    size = abs(deflection)
    if size <= dead_zone:
        return 0.0
    size = (size - dead_zone) / (1.0 - dead_zone)
    size *= 1.0 - expo + expo * size * size
    return size if deflection > 0.0 else -size
