"""What the scripted operator sees: late, noisy, and with an inner sense of where its own hand has gone since."""

from collections import deque

import numpy as np

from robots.pose import FloatArray
from twin.state import WorldState

LAG = 0.12
"""From the world to the thumb: human visual reaction takes 100 to 150 ms when the eye already rests on the spot [s]."""
NOISE = 0.001
"""Standard deviation of one look, per axis [m]."""
TRUST = 0.18
"""How far one look at the tool corrects the inner sense of it: at 60 Hz, about 0.1 s until a surprise is taken in."""
SETTLING = 0.3
"""How much one look counts in where the tool was last seen."""
STILL_TRUST = 0.08
"""The same for a block at rest, which can be looked at for longer."""
SURPRISE = 0.05
"""A block seen further from where it was last thought to be has moved: start afresh [m]."""


class Eyes:
    """Tracks the tool and one block.

    People steer through their reaction lag because they know what their hands have just done; `moved` tells the eyes
    the motion that the hand expects of its own commands.

    Attributes:
        tool: Where the tool is thought to be now, (3,) [m].
        opening: Gap between the fingers as seen [m].
        seen_tool: Where the tool was seen over the last few looks: late, (3,) [m].
        time: Simulated time of the last look [s].
    """

    def __init__(self, rng: np.random.Generator) -> None:
        """Open the eyes.

        Args:
            rng: Source of the noise.
        """
        self._rng = rng
        self._seen: deque[WorldState] = deque()
        self._thought: deque[tuple[float, FloatArray]] = deque()
        self.tool = np.zeros(3)
        self.opening = 0.0
        self.seen_tool = np.zeros(3)
        self.time = 0.0
        self._watched: int | None = None
        self._block: FloatArray | None = None
        self._grip: FloatArray | None = None
        self._apart = 0.0

    @property
    def view(self) -> WorldState:
        """The world as it was a lag ago, without noise: for what does not need a fine look (towers, what is held)."""
        return self._seen[0]

    def watch(self, object_id: int) -> None:
        """Look at a block from now on."""
        self._watched = object_id
        self._block = self._grip = None
        self._look_at_block(np.zeros(3))

    def look(self, state: WorldState) -> None:
        """Take in a new picture of the world."""
        self.time = state.time
        first = not self._seen
        self._seen.append(state)
        while len(self._seen) > 1 and self._seen[1].time <= state.time - LAG:
            self._seen.popleft()
        noise = self._rng.normal(0.0, NOISE, (2, 3))
        view = self._seen[0]
        self.opening = view.gripper_opening
        seen_tool = view.pose_tool_in_world.position + noise[0]
        if first:
            self.tool = self.seen_tool = seen_tool
        else:
            while len(self._thought) > 1 and self._thought[1][0] <= view.time:
                self._thought.popleft()
            wrong = seen_tool - self._thought[0][1]
            self.tool = self.tool + TRUST * wrong
            self.seen_tool = self.seen_tool + SETTLING * (seen_tool - self.seen_tool)
            self._thought = deque((when, where + TRUST * wrong) for when, where in self._thought)
        self._thought.append((state.time, self.tool))
        self._look_at_block(noise[1])

    def moved(self, displacement: FloatArray) -> None:
        """Expect the tool to move by (3,) [m] until the next look."""
        self.tool = self.tool + displacement

    def block(self) -> FloatArray:
        """Where the watched block is thought to be, if it rests, (3,) [m]."""
        assert self._block is not None, "watch a block first"
        return self._block

    def held_block(self) -> FloatArray:
        """Where the watched block is thought to be now, if it moves with the tool, (3,) [m]."""
        assert self._grip is not None, "watch a block first"
        return self.tool + self._grip

    def seen_apart(self) -> float:
        """Distance between tool and watched block as seen in the last look [m]."""
        return self._apart

    def _look_at_block(self, noise: FloatArray) -> None:
        if self._watched is None:
            return
        view = self._seen[0]
        where = next(each for each in view.objects if each.id == self._watched).pose_object_in_world.position + noise
        grip = where - view.pose_tool_in_world.position
        self._apart = float(np.sqrt(grip @ grip))
        if self._block is None or self._grip is None:
            self._block, self._grip = where, grip
            return
        block_off, grip_off = where - self._block, grip - self._grip
        self._block = where if np.abs(block_off).max() > SURPRISE else self._block + STILL_TRUST * block_off
        self._grip = grip if np.abs(grip_off).max() > SURPRISE else self._grip + STILL_TRUST * grip_off
