"""Synthetic observations of table-top actions, as noisy as a camera's: each action in visibly different ways."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from learning.perception.observation import Observation

PERIOD = 0.1
WIDEST = 0.11
"""Gap of the open fingers [m]."""


@dataclass(frozen=True)
class Noise:
    """How badly the camera sees.

    Attributes:
        place: Standard deviation of an object's place from frame to frame [m].
        hidden: Standard deviation of how far its place seems off while the hand hides part of it [m].
        flicker: Share of frames in which a track jumps.
        gaps: Mean number of occlusion gaps in a demo.
    """

    place: float = 0.006
    hidden: float = 0.006
    flicker: float = 0.02
    gaps: float = 1.0


class Hand:
    """Moves a hand and what it holds or pushes, frame by frame, and keeps the true tracks."""

    def __init__(self, rng: np.random.Generator, things: int) -> None:
        self.rng = rng
        self.sizes = np.column_stack([rng.uniform(0.04, 0.08, (things, 2)), rng.uniform(0.05, 0.2, things)])
        angle = rng.uniform(0, 2 * np.pi)
        spots = np.array([[0.16 * np.cos(angle + i * 1.2), 0.16 * np.sin(angle + i * 1.2)] for i in range(things)])
        spots[0] = 0.0
        self.things = np.column_stack([spots + rng.uniform(-0.02, 0.02, (things, 2)), 0.5 * self.sizes[:, 2]])
        self.things[:, 0] += 0.6
        self.tool = self.things[0] + [*rng.uniform(-0.1, 0.1, 2), rng.uniform(0.25, 0.35)]
        self.opening, self.closed, self.held, self.force = WIDEST, False, False, 0.0
        self.rows: list[tuple[np.ndarray, np.ndarray, bool, float, float]] = []

    @property
    def thing(self) -> np.ndarray:
        return self.things[0]

    @property
    def height(self) -> float:
        return float(self.sizes[0, 2])

    def frame(self) -> None:
        self.rows.append((self.tool.copy(), self.things.copy(), self.closed, self.opening, self.force))

    def wait(self, seconds: float) -> None:
        for _ in range(max(1, round(seconds / PERIOD))):
            self.frame()

    def pause(self, least: float = 0.3, most: float = 1.5) -> None:
        self.wait(self.rng.uniform(least, most))

    def go(self, goal: np.ndarray, pushing: bool = False, speed: float | None = None) -> None:
        """Move the tool, by way of a point off the straight line if the way is long."""
        speed = self.rng.uniform(0.08, 0.25) if speed is None else speed
        way = np.asarray(goal, dtype=float) - self.tool
        steps = max(1, int(np.linalg.norm(way) / (speed * PERIOD)))
        start, bend = self.tool.copy(), self.rng.normal(0, 0.02, 3) * (np.linalg.norm(way) > 0.15 and not pushing)
        for share in np.linspace(0, 1, steps + 1)[1:]:
            new = start + share * way + np.sin(np.pi * share) * bend
            if self.held or pushing:
                self.things[0] += new - self.tool
            self.tool = new
            self.frame()

    def close(self) -> None:
        self.closed = True
        width = float(self.sizes[0, :2].min()) if self._around() else 0.0
        while self.opening > width:
            self.opening = max(width, self.opening - 0.02)
            self.frame()
        self.held = width > 0.0

    def open(self) -> None:
        self.closed, self.held = False, False
        while self.opening < WIDEST:
            self.opening = min(WIDEST, self.opening + 0.02)
            fall = self.thing[2] - 0.5 * self.height
            self.thing[2] -= min(fall, 0.12)
            self.thing[:2] += self.rng.normal(0, 0.01, 2) if fall > 0.02 else 0.0
            self.frame()

    def start(self, *, aloft: float | None = None, closed: bool = False) -> None:
        """Begin with the hand somewhere, or around the object, which is in the air if `aloft` is a height."""
        if aloft is not None:
            self.thing[2] += aloft
            self.tool = self.grip()
            self.closed, self.held, self.opening = True, True, float(self.sizes[0, :2].min())
        elif closed:
            self.closed, self.opening = True, 0.0
        self.pause()

    def grip(self) -> np.ndarray:
        """Where the tool holds the object: in its upper half, a little off."""
        share = self.rng.uniform(0.0, 0.35)
        return self.thing + [*self.rng.normal(0, 0.006, 2), share * self.height]

    def above(self) -> np.ndarray:
        return self.thing + [0.0, 0.0, 0.5 * self.height + self.rng.uniform(0.08, 0.15)]

    def reach(self) -> None:
        """Come to the object from above or from the side."""
        grip = self.grip()
        if self.rng.random() < 0.5:
            self.go(self.above())
        else:
            angle = self.rng.uniform(np.pi / 2, 3 * np.pi / 2)
            self.go(grip + 0.16 * np.array([np.cos(angle), np.sin(angle), 0.1]))
        self.go(grip)

    def leave(self) -> None:
        self.go(self.tool + [0.0, 0.0, 0.5 * self.height + self.rng.uniform(0.08, 0.15)])

    def _around(self) -> bool:
        return bool(np.all(np.abs(self.tool - self.thing) < 0.5 * self.sizes[0] + 0.01))


def grasp(hand: Hand) -> None:
    hand.start()
    hand.reach()
    hand.pause(0.1)
    hand.close()
    hand.pause(0.5)


def lift(hand: Hand) -> None:
    hand.start(aloft=0.0)
    hand.go(hand.tool + [*hand.rng.normal(0, 0.02, 2), hand.rng.uniform(0.07, 0.2)])
    hand.pause()


def lower(hand: Hand) -> None:
    height = hand.rng.uniform(0.07, 0.2)
    hand.start(aloft=height)
    hand.go(hand.tool - [*hand.rng.normal(0, 0.02, 2), height])
    hand.pause(0.5)


def drop(hand: Hand) -> None:
    hand.start(aloft=hand.rng.uniform(0.06, 0.15))
    hand.open()
    hand.pause()
    hand.leave()
    hand.pause()


def press(hand: Hand) -> None:
    hand.start(closed=True)
    hand.go(hand.above())
    hand.go(hand.thing + [*hand.rng.normal(0, 0.005, 2), 0.5 * hand.height + hand.rng.uniform(0.0, 0.015)])
    hand.force = 6.0
    hand.pause(0.5)
    hand.force = 0.0
    hand.leave()
    hand.pause()


def push(hand: Hand) -> None:
    hand.start(closed=True)
    angle = hand.rng.uniform(0, 2 * np.pi)
    way = np.array([np.cos(angle), np.sin(angle), 0.0])
    low = hand.thing - [0.0, 0.0, hand.rng.uniform(0.1, 0.25) * hand.height]
    radius = 0.25 * hand.sizes[0, :2].sum()
    hand.go(low - 0.16 * way + [0.0, 0.0, 0.2])
    hand.go(low - 0.16 * way)
    hand.go(low - (radius + hand.rng.uniform(0.0, 0.015)) * way)
    hand.go(hand.tool + hand.rng.uniform(0.05, 0.15) * way, pushing=True, speed=hand.rng.uniform(0.04, 0.12))
    hand.pause(0.1, 0.5)
    hand.go(hand.tool - hand.rng.uniform(0.08, 0.12) * way)
    hand.pause()


def hold(hand: Hand) -> None:
    hand.start(aloft=hand.rng.uniform(0.07, 0.2))
    hand.pause(2.0, 3.0)


def pick_up(hand: Hand) -> None:
    grasp(hand)
    hand.go(hand.tool + [*hand.rng.normal(0, 0.03, 2), hand.rng.uniform(0.08, 0.25)])
    hand.pause()


def _set_down(hand: Hand) -> None:
    away = hand.rng.uniform(0.1, 0.25) * np.array([1.0, hand.rng.choice([-1.0, 1.0]), 0.0])
    hand.go(hand.tool + away)
    hand.go(hand.tool - [0.0, 0.0, hand.thing[2] - 0.5 * hand.height])
    hand.pause(0.4)
    hand.open()
    hand.pause(0.1)
    hand.leave()
    hand.pause()


def put_down(hand: Hand) -> None:
    hand.start(aloft=hand.rng.uniform(0.08, 0.2))
    _set_down(hand)


def move(hand: Hand) -> None:
    pick_up(hand)
    _set_down(hand)


ORDERING: dict[str, Callable[[Hand], None]] = {
    "grasp": grasp,
    "lift": lift,
    "lower": lower,
    "drop": drop,
    "press": press,
    "push": push,
    "hold": hold,
}
TABLETOP: dict[str, Callable[[Hand], None]] = {"pick up": pick_up, "put down": put_down, "move": move}


def table_demo(
    rng: np.random.Generator, action: str, things: int | None = None, noise: Noise = Noise()
) -> tuple[Observation, int]:
    """What a camera saw of an action, and the index of the object that was manipulated."""
    if things is None:
        things = 1 if action in ORDERING else int(rng.integers(2, 6))
    hand = Hand(rng, things)
    (ORDERING | TABLETOP)[action](hand)
    return seen(hand, rng, noise)


def seen(hand: Hand, rng: np.random.Generator, noise: Noise) -> tuple[Observation, int]:
    """Put a camera's noise on true tracks, whose objects are shuffled."""
    tools, places, closed, openings, forces = map(np.array, zip(*hand.rows, strict=True))
    frames, things = places.shape[:2]
    near = np.linalg.norm(places - tools[:, None], axis=2) < 0.1
    location = places + rng.normal(0, noise.place, places.shape)
    location += near[..., None] * rng.normal(0, noise.hidden, (1, things, 3))
    jumps = rng.random((frames, things)) < noise.flicker
    visible = np.ones((frames, things), dtype=bool)
    for thing in range(things):
        for _ in range(rng.poisson(noise.gaps)):
            begin = int(rng.integers(3, max(4, frames - 8)))
            visible[begin : begin + int(rng.integers(2, 8)), thing] = False
    for thing in range(things):
        for frame in np.flatnonzero(~visible[:, thing]):
            location[frame, thing] = location[frame - 1, thing]
    location[jumps & visible] += rng.normal(0, 0.06, (int((jumps & visible).sum()), 3))
    extent = hand.sizes[None] + rng.normal(0, 0.004, (frames, things, 3)) - 0.01 * near[..., None]
    order = rng.permutation(things)
    observation = Observation(
        times=PERIOD * np.arange(frames),
        gripper_location=tools,
        gripper_closed=closed,
        object_ids=np.arange(things),
        location=location[:, order],
        colour=np.full((frames, things, 3), 0.5),
        shape=np.full((frames, things, 33), 1.0 / 33.0),
        visible=visible[:, order],
        extent=extent[:, order],
        gripper_opening=np.maximum(openings + rng.normal(0, 0.0003, frames), 0.0),
        wrist_force=np.column_stack([np.zeros((frames, 2)), forces - 5.0]) + rng.normal(0, 0.3, (frames, 3)),
    )
    return observation, int(np.flatnonzero(order == 0)[0])
