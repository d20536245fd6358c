"""`showtell devices`: which gamepads are plugged in, what they say, and what each control does."""

import sys
import time
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from executor.commands.output import Json, Output, Seed

if TYPE_CHECKING:
    from rich.console import RenderableType

    from teleop.devices import PadInfo, PadLayout, SdlPads
    from teleop.gamepad import GamepadState

PERIOD = 0.05
"""Between two pictures of the live display [s]."""
BAR = 9
"""Width of an axis's bar [characters]."""
NONE = "no gamepad is plugged in: plug one in, and press a button of a wireless one"


def devices(
    robot: Annotated[str | None, typer.Option(help="Show also what each stick, button and key does for it.")] = None,
    mapping: Annotated[
        Path | None, typer.Option(help="Mapping file of your own; what it leaves out is as usual.")
    ] = None,
    seconds: Annotated[
        float | None, typer.Option(min=0.0, help="Stop the live display after so many seconds; 0 shows one snapshot.")
    ] = None,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """List the gamepads and show live what they and the keys say, raw and in the standard layout. Ctrl-C ends it.

    Example: showtell devices --robot baxter
    """
    from robots import load_robot
    from teleop.devices import KeyTable, load_pad_layouts, open_pads
    from teleop.mapping_table import describe

    del seed  # nothing here is random; every command takes one
    out = Output(as_json)
    layouts = load_pad_layouts(mapping)
    table = KeyTable.load(mapping)
    rows = [] if robot is None else [(row.action, row.pad, row.keys) for row in describe(load_robot(robot), mapping)]
    if rows:
        out.table(f"Driving {robot}", ("what", "gamepad", "keys"), rows)
    with open_pads() as pads:
        if seconds != 0.0 and not as_json and sys.stdout.isatty():
            _show_live(out, pads, layouts, table, seconds)
            return
        for _ in range(5):  # SDL tells of held sticks a moment after it was started
            found = pads.refresh()
            time.sleep(0.01)
        out.console().print(_gamepads(pads, found, layouts))
        out.result(
            {
                "gamepads": [_plain(pads, info, layouts) for info in found],
                "terminal": sys.stdin.isatty(),
                "mapping": [dict(zip(("action", "gamepad", "keys"), row, strict=True)) for row in rows],
            }
        )


def _show_live(
    out: Output, pads: "SdlPads", layouts: "dict[str, PadLayout]", table: Any, seconds: float | None
) -> None:
    """Redraw what gamepads and keys say until the time is over or Ctrl-C."""
    from rich.console import Group
    from rich.live import Live

    from teleop.devices import TerminalKeyboard

    end = None if seconds is None else time.monotonic() + seconds
    keyboard = TerminalKeyboard(table) if sys.stdin.isatty() else nullcontext()
    with keyboard as keys, Live(console=out.console(), auto_refresh=False) as picture:
        try:
            while end is None or time.monotonic() < end:
                drawn = _gamepads(pads, pads.refresh(), layouts)
                if isinstance(keys, TerminalKeyboard):
                    now = time.monotonic()
                    said = _controls(keys.poll(now).gamepad)
                    drawn = Group(
                        drawn, f"keys {' '.join(sorted(keys.held(now))) or '-'}: {', '.join(said) or 'at rest'}"
                    )
                picture.update(drawn, refresh=True)
                time.sleep(PERIOD)
        except KeyboardInterrupt:  # the way to leave it
            return


def _gamepads(pads: "SdlPads", found: "tuple[PadInfo, ...]", layouts: "dict[str, PadLayout]") -> "RenderableType":
    """A table with one row a gamepad."""
    from rich.table import Table
    from rich.text import Text

    from teleop.devices import standard_state

    if not found:
        return Text(NONE)
    table = Table(title="Gamepads", title_justify="left", header_style="bold")
    for column in ("", "name", "raw axes", "raw buttons and hats", "standard layout"):
        table.add_column(column, overflow="fold")
    for place, info in enumerate(found):
        raw = pads.raw(info.number)
        if raw is None:
            continue
        axes = [f"a{index} {_bar(value)} {value:+.2f}" for index, value in enumerate(raw.axes)]
        pressed = [f"b{index}" for index, value in enumerate(raw.buttons) if value]
        pressed += [f"h{index} {right:+d},{up:+d}" for index, (right, up) in enumerate(raw.hats)]
        state = standard_state(pads, info, layouts)
        controls = [_known(info, layouts)] if state is None else [_known(info, layouts), *_controls(state)]
        cells = (str(place), info.name, "\n".join(axes), " ".join(pressed), "\n".join(controls))
        table.add_row(*(Text(cell) for cell in cells))
    return table


def _bar(value: float) -> str:
    """An axis as a mark between its ends."""
    place = round((value + 1.0) / 2.0 * (BAR - 1))
    return "".join("●" if index == place else "·" for index in range(BAR))


def _known(info: "PadInfo", layouts: "dict[str, PadLayout]") -> str:
    """Who knows a gamepad's layout."""
    if info.name in layouts or info.guid in layouts:
        return "by the mapping file"
    return "known to SDL" if info.known else f'unknown: describe it under [pad."{info.name}"] in a mapping file'


def _controls(state: "GamepadState") -> list[str]:
    """The controls that are not at rest."""
    from teleop.gamepad import AXES, BUTTONS

    named = [*zip(AXES, state.axes, strict=True), *zip(BUTTONS, state.buttons, strict=True)]
    return [f"{name} {value:+.2f}" for name, value in named if value]


def _plain(pads: "SdlPads", info: "PadInfo", layouts: "dict[str, PadLayout]") -> dict[str, Any]:
    """A gamepad for a program."""
    from teleop.devices import standard_state

    raw = pads.raw(info.number)
    state = standard_state(pads, info, layouts)
    return {
        "name": info.name,
        "guid": info.guid,
        "layout": _known(info, layouts),
        "axes": [] if raw is None else raw.axes,
        "buttons": [] if raw is None else raw.buttons,
        "hats": [] if raw is None else raw.hats,
        "standard": None if state is None else {"axes": state.axes, "buttons": state.buttons},
    }


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(devices)
