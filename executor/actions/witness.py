"""What physics says while an action is played: states before, on the way and after, for the judge."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from executor.actions.things import clear_below, pose_of
from robots.pose import FloatArray, read_only
from twin import JointCommand, World, WorldState

EVERY = 12
"""Steps between two samples: 20 a second."""


@dataclass(frozen=True, slots=True)
class Evidence:
    """What happened to one object and the hand that acted on it, over K samples.

    Attributes:
        object_id: The object.
        before: The world in the action's first state.
        after: The world when all has come to rest after it.
        times: Of the samples, (K,) [s].
        centre: The object's centre in the world, (K, 3) [m].
        clear: Free height below the object, (K,) [m].
        between: Whether both fingers of the acting hand touch the object, (K,).
        closed: Whether that hand was told to close, (K,).
        wrist_force: What is felt at its wrist, axes of the world, (K, 3) [N].
        clear_after: Free height below the object when all has come to rest [m].
        held_after: Whether the object is then between the acting hand's closed fingers.
    """

    object_id: int
    before: WorldState
    after: WorldState
    times: FloatArray
    centre: FloatArray
    clear: FloatArray
    between: NDArray[np.bool_]
    closed: NDArray[np.bool_]
    wrist_force: FloatArray
    clear_after: float
    held_after: bool

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        for name in ("times", "centre", "clear", "wrist_force"):
            object.__setattr__(self, name, read_only(getattr(self, name)))


@dataclass(frozen=True, slots=True)
class _Sample:
    """One moment, as in `Evidence`."""

    time: float
    centre: FloatArray
    clear: float
    between: bool
    closed: bool
    wrist_force: FloatArray


class WitnessedWorld(World):
    """A world that watches one object and one arm from `watch` on, until `evidence` is taken."""

    _watched: tuple[int, int] | None = None
    _samples: list[_Sample]
    _first: WorldState

    def watch(self, object_id: int, arm: str) -> None:
        """Begin: the world is in the action's first state."""
        self._watched = object_id, list(self.robot.arms).index(arm)
        self._samples = []
        self._first = self.state()
        self._sample()

    def step(self, command: JointCommand) -> None:
        """Simulate one step, and look every `EVERY` of them."""
        super().step(command)
        if self._watched is not None and self._steps % EVERY == 0:
            self._sample()

    def evidence(self) -> Evidence | None:
        """What was seen since `watch`; None if nothing was watched."""
        if self._watched is None:
            return None
        object_id, number = self._watched
        after = self.state()
        hand = after.arms[number]
        return Evidence(
            object_id=object_id,
            before=self._first,
            after=after,
            times=np.array([each.time for each in self._samples]),
            centre=np.array([each.centre for each in self._samples]),
            clear=np.array([each.clear for each in self._samples]),
            between=np.array([each.between for each in self._samples]),
            closed=np.array([each.closed for each in self._samples]),
            wrist_force=np.array([each.wrist_force for each in self._samples]),
            clear_after=clear_below(self, object_id),
            held_after=hand.gripper_closed and hand.held == object_id,
        )

    def _sample(self) -> None:
        assert self._watched is not None
        object_id, number = self._watched
        state = self.state()
        hand = state.arms[number]
        self._samples.append(
            _Sample(
                state.time,
                pose_of(state, object_id).position,
                clear_below(self, object_id),
                hand.held == object_id,
                hand.gripper_closed,
                hand.wrist_wrench[:3],
            )
        )
