"""One try at a demo of a collection."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from executor.collections import rules
from executor.collections.performance import PlannedDemo, perform
from executor.collections.truths import objects_of
from teleop.annotators import Told
from twin import World
from twin.state import WorldState


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


@dataclass(frozen=True, slots=True)
class Trying:
    """Which try at which demo.

    Attributes:
        collection: Name of the collection.
        action: What is to be shown.
        number: Number of the demo.
        attempt: Number of the try.
        path: Where the demo goes.
    """

    collection: str
    action: str
    number: int
    attempt: int
    path: Path

    def perform(
        self,
        world: World,
        plan: PlannedDemo,
        rule: rules.Rule,
        told: Sequence[Told],
        rng: np.random.Generator,
        destination: Callable[[WorldState], Mapping[str, object] | None] = lambda _: None,
    ) -> Attempt:
        """Drive and record the demo, and judge it by physics.

        Args:
            world: A world in which nothing has moved yet.
            plan: What to do.
            rule: When the demo shows what it shall.
            told: What annotators say of it.
            rng: Source of the operator's tremble.
            destination: Where the thing went, for the sidecar, told the state at the end.
        """
        judge = rules.judge_of(rule, world.model_of(plan.target))
        spoken = [(each.text, each.language) for each in told]
        reason = perform(world, plan, judge, self.path, lambda _: spoken, rng)
        if reason:
            return Attempt(self.action, reason, simulated=world.time)
        truth = {
            "collection": self.collection,
            "action": self.action,
            "number": self.number,
            "attempt": self.attempt,
            "arm": plan.arm,
            "target": plan.target,
            "destination": destination(world.state()),
            "objects": objects_of(world.spec),
            "sentences": [each.truth() for each in told],
        }
        return Attempt(self.action, "", truth, world.time)
