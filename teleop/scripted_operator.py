"""An operator made of code: looks at the world, moves sticks and buttons like a person, and copes with failures."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from robots.pose import FloatArray
from twin.scene_spec import SceneSpec
from twin.state import WorldState

from .clearance import carry_height
from .gamepad import RESTING, GamepadState
from .gamepad_mapping import GamepadMapping
from .operator_eyes import Eyes
from .operator_hand import Hand
from .task import Task

ATTEMPTS = 3
"""How often a block is reached for before giving up."""
LOOK_FIRST = (0.15, 0.35)
"""A person looks before moving: shortest and longest time [s]."""
GAIN = 4.5
"""Distance to speed near a target [1/s]; the loop through eyes and hand stays well damped up to about 6."""
BRAKING = 0.9
"""Deceleration that the operator plans with [m/s²]."""
ALIGNED = 0.0015
"""Sideways error at which it goes down between neighbours [m]; fingers have about 4 mm to spare."""
ASTRAY = 0.0035
"""Sideways error at which it stops going down and corrects [m]."""
ALIGNED_FOR = 0.08
"""How long it wants to see itself aligned [s]."""
NEAR = 0.0018
"""Height error at which a height is reached [m]."""
NEAR_FOR = 0.08
"""How long it wants to see a height reached before it closes or opens the gripper [s]."""
RISE_SLACK = 0.008
"""It starts to move sideways this far below the height it rises to [m]."""
TAP = 0.10
"""How long a button is pressed [s]."""
GRIPPER_TIME = 0.32
"""It waits this long after a tap for the fingers, and for its own eyes [s]."""
CAREFUL_BELOW = 0.04
"""From this far above a block or its place it goes down carefully [m] ..."""
SLOWLY = 0.5
"""... at no more than this share of top speed."""
ABOVE_MIDDLE = 0.0015
"""It grasps a block a little above its middle, to keep clear of the one below [m]."""
STRAIGHT_UP = 0.012
"""A goal this close to straight above or below needs no detour over the towers [m]."""
PATIENCE = 6.0
"""Longest time for one part of a task [s]; then it tries something else."""
LIFT = 0.08
"""How far a block is lifted that should just be held [m]."""
CHECK_LIFT = 0.03
"""How far it lifts a block before it checks its grasp [m]."""
HELD_WITHIN = 0.012
"""A block whose centre is this close to the tool is in the gripper [m]."""
PLACED_WITHIN = 0.012
"""A block this close to its goal is left alone [m]."""
STUCK_FOR = 0.6
"""If it goes down and sees no progress for this long, it has arrived or something is in the way [s]."""
SUNK = 0.001
"""What counts as progress, through its noisy eyes [m]."""


@dataclass(frozen=True, slots=True)
class Wish:
    """What the operator wants right now.

    Attributes:
        velocity: Of the tool, (3,) [m/s].
        close: Press the button that closes.
        open: Press the button that opens.
    """

    velocity: FloatArray
    close: bool = False
    open: bool = False


_STILL = np.zeros(3)
_Point = Callable[[], FloatArray]


class ScriptedOperator:
    """Does one task with a gamepad.

    It sees the world late and through noise (`Eyes`), its thumbs are smooth and imprecise (`Hand`); so it slows down
    and corrects near blocks, checks its grasp, and tries again when it failed.

    Attributes:
        task: What to do.
        done: Whether it has put the gamepad down.
        success: Whether it believes the task done; None before the end.
        note: What went wrong, in plain words; empty if nothing did.
        attempts: How often it reached for the block.
    """

    def __init__(self, task: Task, rng: np.random.Generator, mapping: GamepadMapping | None = None) -> None:
        """Give the operator a task.

        Args:
            task: What to do.
            rng: Source of all its imprecision.
            mapping: The mapping it is used to; None takes the usual one.
        """
        self.task = task
        self.done = False
        self.success: bool | None = None
        self.note = ""
        self.attempts = 0
        self._rng = rng
        self._mapping = mapping or GamepadMapping()
        self._eyes = Eyes(rng)
        self._hand = Hand(self._mapping, rng)
        self._time: float | None = None
        self._script = self._do_task()

    def act(self, state: WorldState, spec: SceneSpec) -> GamepadState:
        """Look at the world and say what the gamepad says now; call at about 60 Hz.

        Args:
            state: The world now; the operator sees it a reaction time later.
            spec: What the scene is made of.
        """
        dt = 0.0 if self._time is None else state.time - self._time
        self._time = state.time
        if self.done:
            return RESTING
        self._eyes.moved(self._hand.expected * dt)
        self._eyes.look(state)
        wish = next(self._script, None)
        if wish is None:
            self.done = True
            return RESTING
        return self._hand.act(wish.velocity, dt, wish.close, wish.open)

    # The task

    def _do_task(self) -> Iterator[Wish]:
        yield from self._wait(float(self._rng.uniform(*LOOK_FIRST)))
        block = self.task.object_id
        while self.attempts < ATTEMPTS:
            self.attempts += 1
            if block is None:
                block = self._eyes.view.held
                if block is None:
                    self._finish(False, "there is nothing in the gripper")
                    return
                self._eyes.watch(block)
                yield from self._wait(0.1)
            elif self._eyes.view.held != block:
                yield from self._take(block)
            else:
                self._eyes.watch(block)
            if not self._holding():
                self.note = "the grasp failed"
                yield from self._let_go()
                yield from self._rise_from_here(None)
                continue
            if self.task.goal is None:
                self._finish(True)
                return
            goal = self.task.goal
            yield from self._carry(block, goal)
            if not self._holding():
                self.note = "the block was lost on the way"
                yield from self._let_go()
                continue
            if not self.task.release:
                self._finish(True)
                return
            yield from self._place(block, goal)
            if self._at(goal):
                self._finish(True)
                return
            self.note = "the block did not stay at its place"
        self._finish(False, f"{self.note}, {ATTEMPTS} times")

    def _finish(self, success: bool, note: str = "") -> None:
        self.success = success
        self.note = note

    def _take(self, block: int) -> Iterator[Wish]:
        """Over the block, down, close, and a little up."""
        eyes = self._eyes
        eyes.watch(block)
        if eyes.view.gripper_closed:
            yield from self._let_go()
        here = eyes.block().copy()
        yield from self._over(eyes.block, self._tool, carry_height(eyes.view, eyes.tool, here, None))
        hover = carry_height(eyes.view, here, here, None)
        yield from self._down(eyes.block, self._tool, hover, lambda: float(eyes.block()[2]) + ABOVE_MIDDLE)
        yield from self._tap(close=True)
        yield from self._vertical(float(eyes.tool[2]) + (LIFT if self.task.goal is None else CHECK_LIFT))
        yield from self._wait(0.1)

    def _carry(self, block: int, goal: FloatArray) -> Iterator[Wish]:
        """With the held block to the goal's place: over everything, or straight where it is above or below."""
        eyes = self._eyes
        if not self.task.release:
            yield from self._hold_at(block, goal)
            return
        aside = float(np.hypot(*(goal - eyes.held_block())[:2]))
        if aside > STRAIGHT_UP:
            height = carry_height(eyes.view, eyes.tool, goal, block)
            yield from self._over(lambda: goal, eyes.held_block, max(height, float(goal[2])))

    def _hold_at(self, block: int, goal: FloatArray) -> Iterator[Wish]:
        """Bring the held block to a point in the air and keep it there."""
        eyes = self._eyes
        if float(np.hypot(*(goal - eyes.held_block())[:2])) > STRAIGHT_UP:
            height = carry_height(eyes.view, eyes.tool, goal, block)
            yield from self._over(lambda: goal, eyes.held_block, max(height, float(goal[2])))
        give_up = eyes.time + PATIENCE
        while eyes.time < give_up:
            off = goal - eyes.held_block()
            if np.abs(off).max() < 2 * NEAR:
                break
            yield Wish(np.append(self._towards(off[:2], 1.0), self._towards(off[2:], 1.0)))
        yield from self._wait(0.25)

    def _place(self, block: int, goal: FloatArray) -> Iterator[Wish]:
        """Down until the block is at its place, let go, and up again."""
        eyes = self._eyes
        hover = carry_height(eyes.view, goal, goal, block)
        yield from self._down(lambda: goal, eyes.held_block, hover, lambda: float(goal[2]) + 0.001)
        yield from self._let_go()
        eyes.watch(block)
        yield from self._rise_from_here(None)

    def _rise_from_here(self, moved: int | None) -> Iterator[Wish]:
        eyes = self._eyes
        yield from self._vertical(carry_height(eyes.view, eyes.tool, eyes.tool, moved))
        yield from self._wait(0.12)

    # Motions

    def _over(self, goal: _Point, body: _Point, height: float) -> Iterator[Wish]:
        """Rise to a height, then move sideways until `body` is nearly over `goal`."""
        eyes = self._eyes
        give_up = eyes.time + PATIENCE
        while eyes.time < give_up:
            sideways = (goal() - body())[:2]
            if float(np.hypot(*sideways)) < 0.015:
                return
            up = height - eyes.tool[2]
            free = up < RISE_SLACK
            across = self._towards(sideways, 1.0) if free else _STILL[:2]
            yield Wish(np.append(across, self._towards(np.array([up]), 1.0)))

    def _down(self, goal: _Point, body: _Point, hover: float, bottom: Callable[[], float]) -> Iterator[Wish]:
        """Align `body` over `goal`, at or above the `hover` height of the tool; then bring it down to `bottom`."""
        eyes = self._eyes
        give_up = eyes.time + PATIENCE
        aligned_since = math.inf
        near_since = math.inf
        lowest, sunk_at = math.inf, math.inf
        going_down = False
        while eyes.time < give_up:
            here = body()
            sideways = (goal() - here)[:2]
            astray = float(np.hypot(*sideways))
            remaining = float(here[2]) - bottom()
            if astray > ALIGNED:
                aligned_since = math.inf
            elif aligned_since == math.inf:
                aligned_since = eyes.time
            if not going_down:
                going_down = eyes.time - aligned_since >= ALIGNED_FOR
                rest = np.array([hover - eyes.tool[2]])
                down = self._towards(rest, 1.0) if rest[0] < 0.0 else _STILL[:1]
            elif eyes.time - near_since >= NEAR_FOR or eyes.time - sunk_at > STUCK_FOR:
                return
            else:
                if eyes.seen_tool[2] < lowest - SUNK:
                    lowest, sunk_at = float(eyes.seen_tool[2]), eyes.time
                near_since = min(near_since, eyes.time) if abs(remaining) < NEAR else math.inf
                down = self._towards(np.array([-remaining]), SLOWLY if remaining < CAREFUL_BELOW else 1.0)
                if astray > ASTRAY:
                    down = down * 0.1
            yield Wish(np.append(self._towards(sideways, 0.4), down))

    def _vertical(self, height: float) -> Iterator[Wish]:
        """Straight up or down to a tool height, keeping the place seen from above."""
        eyes = self._eyes
        place = eyes.tool.copy()
        give_up = eyes.time + PATIENCE
        while eyes.time < give_up:
            off = height - float(eyes.tool[2])
            if abs(off) < 2 * NEAR:
                return
            yield Wish(np.append(self._towards((place - eyes.tool)[:2], 0.3), self._towards(np.array([off]), 1.0)))

    def _towards(self, off: FloatArray, fraction: float) -> FloatArray:
        """Velocity (m,) [m/s] towards a point that is `off` (m,) [m] away, slowing down in time."""
        distance = float(np.sqrt(off @ off))
        if distance < 1e-4:
            return np.zeros_like(off)
        speed = min(fraction * self._mapping.top_speed, GAIN * distance, math.sqrt(2.0 * BRAKING * distance))
        return off * (speed / distance)

    def _let_go(self) -> Iterator[Wish]:
        yield from self._tap(close=False)

    def _tap(self, close: bool) -> Iterator[Wish]:
        """Press a gripper button and wait for the fingers."""
        until = self._eyes.time + TAP
        while self._eyes.time < until:
            yield Wish(_STILL, close=close, open=not close)
        yield from self._wait(GRIPPER_TIME)

    def _wait(self, duration: float) -> Iterator[Wish]:
        until = self._eyes.time + duration
        while self._eyes.time < until:
            yield Wish(_STILL)

    # What it believes

    def _tool(self) -> FloatArray:
        return self._eyes.tool

    def _holding(self) -> bool:
        """Whether the watched block is seen between the fingers."""
        return self._eyes.seen_apart() < HELD_WITHIN

    def _at(self, goal: FloatArray) -> bool:
        return float(np.abs(self._eyes.block() - goal).max()) < PLACED_WITHIN
