"""Recording and replaying, as on a tape deck: what is on, and what each button does next.

`idle` -> record -> `recording` -> stop -> `review` (describe, label; then keep, discard or redo) -> `idle`;
`idle` -> replay -> `replaying` -> `idle`. Recording begins with the scene as new, so that the demo can be played again
exactly.
"""

from pathlib import Path
from typing import Literal

import numpy as np

from twin.scene_spec import SceneSpec
from twin.scenes import resolve_scene
from twin.world import World

from .demo_reader import load_demo
from .errors import TeleopError
from .gamepad_mapping import GamepadMapping
from .loop_driver import DriveReport, OperatorInput, RobotDriver
from .recorder import Recorder
from .recording import Recording
from .replay import DemoPlayer

DeckMode = Literal["idle", "recording", "review", "replaying"]
LONGEST = 600.0
"""A recording stops by itself after this time [s]."""
MOST_LISTED = 50
"""The newest demos that are offered for replay."""
_MODES: dict[str, DeckMode] = {"idle": "idle", "recording": "recording", "stopped": "review"}


class Deck:
    """A scene, its driver, and what is recorded or replayed.

    Attributes:
        driver: Drives the robot.
        changes: Counts the worlds: another number means that geometry has to be looked at anew.
    """

    def __init__(
        self,
        scene: str,
        robot: str | None,
        seed: int,
        folder: Path,
        *,
        name: str = "page",
        mapping: Path | None = None,
        window: bool = False,
    ) -> None:
        """Set the scene up.

        Args:
            scene: Name of a scene, or the path of a TOML file.
            robot: Robot instead of the scene's own; None keeps that.
            seed: Decides a random scene.
            folder: Where demos are written, and found for replay.
            name: What the demos' files are called, before their numbers.
            mapping: File of sticks and buttons; None takes the usual one.
            window: Show the world in PyBullet's own window.

        Raises:
            SceneError: The scene is unknown or wrong.
            RobotError: The robot is unknown or its files are wrong.
        """
        self.changes = 0
        self._scene, self._robot, self._seed, self._folder = scene, robot, seed, folder
        self._mapping, self._window = mapping, window
        self._recording = Recording(folder, self._begin, name)
        self._said = self._said_before = 0
        self._outcome = ""
        self._player: DemoPlayer | None = None
        self.driver = RobotDriver(World(self._spec(), window=window), mapping=mapping)

    @property
    def mode(self) -> DeckMode:
        """What is on."""
        return "replaying" if self._player is not None else _MODES[self._recording.state]

    @property
    def world(self) -> World:
        """The world that is shown now."""
        return self.driver.world if self._player is None else self._player.world

    @property
    def last(self) -> Path | None:
        """The demo that is or was recorded last; None before the first."""
        return self._recording.path

    def settle(self) -> None:
        """Wait until the demo that was kept last is whole on the disk."""
        self._recording.settle()

    def step(self, wish: OperatorInput) -> tuple[DriveReport, str]:
        """One control step of what is on; the second is something to tell people, mostly empty."""
        if self._player is not None:
            return self._play(self._player)
        recorder = self._recording.recorder
        report = self.driver.step(wish, recorder)
        ends = recorder is not None and recorder.seconds >= LONGEST
        return report, self._recording.poll() or (self.stop() if ends else "")

    def record(self) -> str:
        """Set the scene up anew and record from its first step.

        Raises:
            TeleopError: Something else is on, or the file cannot be written.
        """
        self._needs("idle", "record")
        path = self._recording.start()
        self._said_before = self._said
        return f"recording {path.name}; the scene starts anew"

    def stop(self) -> str:
        """End a recording's motion, or a replay."""
        if self.mode == "replaying":
            return self._end_replay()
        self._needs("recording", "stop")
        if (recorder := self._recording.recorder) is not None:
            self.driver.last_state(recorder)
        self._recording.stop()
        return "recorded: say what was done, then keep or discard it"

    def describe(self, text: str) -> str:
        """Add a sentence to the demo: before (it goes with the next), during or after it.

        Raises:
            TeleopError: Nothing was said.
        """
        if self.mode == "replaying":
            raise TeleopError("a replay is on: what is said of it is not kept")
        self._recording.say(text)
        self._said += 1
        return f"added: {' '.join(text.split())}"

    def label(self, outcome: Literal["success", "failure"]) -> str:
        """Say how a recording ended; the last word counts."""
        self._recording.label(outcome)
        self._outcome = outcome
        return f"labelled a {outcome}"

    def keep(self) -> str:
        """Keep the demo."""
        self._needs("review", "keep")
        said, self._said = self._said, 0
        path = self._recording.keep(wait=False)
        return f"kept {path.name} with {said} sentence{'' if said == 1 else 's'}"

    def discard(self) -> str:
        """Throw the recording away."""
        self._recording.discard()
        self._said = 0
        return "discarded"

    def redo(self) -> str:
        """Throw the recording away and begin it again."""
        path = self._recording.redo()
        self._said = self._said_before
        return f"recording {path.name} again; the scene starts anew"

    def replay(self, name: str) -> str:
        """Play a demo of the folder, in a world of its own.

        Raises:
            TeleopError: Something else is on, or there is no such demo.
        """
        self._needs("idle", "replay")
        if name not in self.demos():
            raise TeleopError(f"there is no demo {name!r} in {self._folder}: choose one of the list")
        self._recording.settle()
        self._player = DemoPlayer(load_demo(self._folder / name))
        self.changes += 1
        return f"replaying {name}: its inputs are simulated afresh"

    def renew(self, another: bool) -> str:
        """Set the scene up anew, or another one with the next seed.

        Raises:
            TeleopError: Something is on.
        """
        self._needs("idle", "start another scene" if another else "start the scene anew")
        self._seed += another
        self._renew()
        return f"scene {self._scene} {self._seed}"

    def press(self, event: str) -> str:
        """What a button of the gamepad or a key does to the recording; its meaning depends on what is on.

        Returns:
            Something to tell people; empty where the button means nothing now.

        Raises:
            TeleopError: It cannot be done.
        """
        mode = self.mode
        ends, recorded = mode in ("recording", "replaying"), mode in ("recording", "review")
        if event == "record":
            return self.stop() if ends else self.keep() if mode == "review" else self.record()
        if event == "discard" and recorded:
            return self.discard()
        if event == "redo" and recorded:
            return self.redo()
        if mode == "review" and event in ("success", "failure"):
            return self.label("success" if event == "success" else "failure")
        return ""

    def demos(self) -> list[str]:
        """Names of the demos that can be replayed, newest first."""
        busy = None if self.mode == "idle" else self._recording.path
        paths = [path for path in self._folder.glob("*.mcap") if path != busy]
        return [path.name for path in sorted(paths, key=lambda each: each.stat().st_mtime, reverse=True)[:MOST_LISTED]]

    def kept(self) -> list[Path]:
        """The demos of the folder, oldest first."""
        return [self._folder / name for name in reversed(self.demos())]

    def progress(self) -> dict[str, object]:
        """What is on, for the page."""
        mode, path, player = self.mode, self._recording.path, self._player
        return {
            "mode": mode,
            "file": path.name if path is not None and mode in ("recording", "review") else "",
            "sentences": self._said,
            "outcome": self._outcome if mode == "review" else "",
            "seconds": self.world.time if mode in ("recording", "replaying") else 0.0,
            "duration": 0.0 if player is None else len(player.demo.inputs) / player.demo.rate,
            "scene": self.driver.world.spec.name,
            "seed": self._seed,
        }

    def close(self) -> None:
        """Keep a recording as far as it went and end."""
        if self._player is not None:
            self._player.close()
        self._recording.close()
        self.driver.close()

    def _spec(self) -> SceneSpec:
        spec = resolve_scene(self._scene, self._seed)
        return spec if self._robot is None else spec.model_copy(update={"robot": self._robot})

    def _begin(self, path: Path) -> Recorder:
        """Start the scene anew and open a recorder for it."""
        self._renew()
        self._outcome = ""
        world = self.driver.world
        settings = self.driver.mapping.settings
        feel = GamepadMapping(settings.top_speed, settings.dead_zone, settings.expo)
        rate, details = round(1.0 / world.DT), {"drive_mapping": settings.model_dump_json()}
        return Recorder(path, world.spec, feel, rate, robot=world.robot, details=details, exclusive=True)

    def _renew(self) -> None:
        old = self.driver
        if self._window:  # there can be but one
            old.close()
        self.driver = RobotDriver(World(self._spec(), window=self._window), old, self._mapping)
        old.close()
        self.changes += 1

    def _play(self, player: DemoPlayer) -> tuple[DriveReport, str]:
        """Play one input of a replay; the emergency stop holds it."""
        if self.driver.mapping.state.stopped:
            return DriveReport("stopped", "emergency stop"), ""
        player.step()
        velocity = player.world.joint_velocities
        report = DriveReport("ok", "replaying", moving=bool(np.abs(velocity).max() > 1e-4))
        return report, self._end_replay() if player.done else ""

    def _end_replay(self) -> str:
        player, self._player = self._player, None
        self.changes += 1
        if player is None:
            return ""
        player.close()
        done = "done" if player.done else "stopped"
        return f"replay {done}: largest difference from the recording {player.error:.2g} ({player.worst})"

    def _needs(self, mode: DeckMode, wish: str) -> None:
        if self.mode != mode:
            is_on = {"idle": "nothing is on", "review": "a recording waits to be kept or discarded"}
            raise TeleopError(f"cannot {wish} now: {is_on.get(self.mode, f'{self.mode} is on')}")
