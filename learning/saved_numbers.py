"""Reading numbers back from a saved file, so that what nobody can have counted is not learned from."""

import math
from typing import Any


def saved_number(value: Any, what: str) -> float:
    """Read a finite number.

    Raises:
        ValueError: It is not one; the message says `what` it should have been.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError(f"{what} is {value!r}, expected a finite number")
    return float(value)


def saved_count(value: Any, what: str, least: float = 0.0) -> float:
    """Read a finite number that is `least` or more, such as a count of sightings.

    Raises:
        ValueError: It is not one; the message says `what` it should have been.
    """
    number = saved_number(value, what)
    if number < least:
        raise ValueError(f"{what} is {value!r}, expected {least:g} or more")
    return number
