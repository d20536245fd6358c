"""One try at a demo of a collection."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Attempt:
    """How a try went.

    Attributes:
        kind: The action.
        reason: Why there is no demo; empty when there is one.
        truth: What is true of the demo, for its sidecar; None when there is none.
        simulated: Simulated time [s]; 0 where it was seen beforehand that the arm cannot do it here.
    """

    kind: str
    reason: str = ""
    truth: Mapping[str, Any] | None = None
    simulated: float = 0.0
