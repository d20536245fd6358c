"""Recording at this machine, with a gamepad or the terminal's keys: what `showtell record --device` does."""

import time
from dataclasses import dataclass
from pathlib import Path

from rich.live import Live
from rich.table import Table

from executor.commands.output import Output
from teleop.devices import Device, Gamepad, KeyTable, TerminalKeyboard, load_pad_layouts
from teleop.hand_loop import HandStatus, drive_by_hand
from teleop.loop_deck import Deck
from teleop.mapping_table import describe

LOOKS, BETWEEN_LOOKS = 5, 0.01
"""SDL tells of a gamepad a moment after it was started: so often it is looked for, so far apart [s]."""
_COLOURS = {"ok": "green", "slowed": "yellow", "stopped": "red"}


@dataclass(frozen=True, slots=True)
class HandSettings:
    """What to drive, with what, and where the demos go.

    Attributes:
        device: What the person drives with: `gamepad` or `keyboard`.
        scene: Name of a scene, or path of a TOML file.
        robot: Robot instead of the scene's own; None keeps that.
        seed: Decides a random scene.
        folder: Where the demos go.
        sentences: Said of the first demo.
        pad: Which gamepad: its number or part of its name; None takes the first.
        mapping: File of sticks, buttons and keys; None takes the usual one.
        window: Whether PyBullet's window shows the scene.
        seconds: How long [s]; None goes on until Ctrl-C.
    """

    device: str
    scene: str
    robot: str | None
    seed: int
    folder: Path
    sentences: tuple[str, ...] = ()
    pad: str | None = None
    mapping: Path | None = None
    window: bool = False
    seconds: float | None = None


def record_by_hand(settings: HandSettings, out: Output) -> list[Path]:
    """Let a person drive and record; shows what every control does and, live, how things are.

    Returns:
        The demos that were kept.

    Raises:
        ShowtellError: Scene, robot, mapping or device is wrong; the message names which.
    """
    with _device(settings) as device:
        deck = Deck(
            settings.scene,
            settings.robot,
            settings.seed,
            settings.folder,
            name="demo",
            mapping=settings.mapping,
            window=settings.window,
        )
        for text in settings.sentences:
            deck.describe(text)
        rows = describe(deck.world.robot, settings.mapping)
        out.table("Controls", ("action", "gamepad", "keys"), [(row.action, row.pad, row.keys) for row in rows])
        out.note("Record with its button, end and keep with the same one; Ctrl-C ends.")
        if missing := _missing(device):
            out.note(f"{missing}; the robot waits for it")
        with Live(console=out.console(err=True), refresh_per_second=10, transient=True) as live:
            return drive_by_hand(deck, device, lambda status: live.update(_line(status)), seconds=settings.seconds)


def _device(settings: HandSettings) -> Device:
    if settings.device == "keyboard":
        return TerminalKeyboard(KeyTable.load(settings.mapping))
    pad = settings.pad
    choice = int(pad) if pad is not None and pad.isdigit() else pad
    return Gamepad(choice, load_pad_layouts(settings.mapping))


def _missing(device: Device) -> str:
    """Why the device cannot be driven with yet; empty when it is there."""
    for _ in range(LOOKS):
        reading = device.poll(time.monotonic())
        if reading.connected:
            return ""
        time.sleep(BETWEEN_LOOKS)
    return reading.fault or "no device is connected"


def _line(status: HandStatus) -> Table:
    """How things are, in two lines."""
    line = Table.grid(padding=(0, 2))
    colour = _COLOURS[status.report.state]
    line.add_row(
        f"[{colour}]{status.report.state}[/]",
        status.mode,
        f"{status.seconds:.1f} s",
        status.manner,
        status.device or "no device",
    )
    text = Table.grid()
    text.add_row(line)
    text.add_row(status.report.reason or status.notice)
    return text
