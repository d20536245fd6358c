"""A gamepad plugged into this machine."""

from collections.abc import Mapping
from pathlib import Path

from teleop.gamepad import AXIS_INDEX, BUTTON_INDEX, RESTING, GamepadState
from teleop.mapping_file import PadSection, read_mapping_file
from teleop.pad_source import RawInput, parse_axis_source, parse_button_source

from .device import DeviceBase, DeviceReading
from .sdl_pads import PadInfo, SdlPads, open_pads


class PadLayout:
    """Where a gamepad that SDL does not know has its controls."""

    def __init__(self, section: PadSection) -> None:
        """Read a mapping file's section."""
        self._axes = [(AXIS_INDEX[name], parse_axis_source(text)) for name, text in section.axes.items()]
        self._buttons = [(BUTTON_INDEX[name], parse_button_source(text)) for name, text in section.buttons.items()]

    def standard(self, raw: RawInput) -> GamepadState:
        """Bring raw input into W3C's layout; controls that the section does not name rest."""
        axes, buttons = [0.0] * len(AXIS_INDEX), [0.0] * len(BUTTON_INDEX)
        for index, source in self._axes:
            axes[index] = source.value(raw)
        for index, source in self._buttons:
            buttons[index] = source.value(raw)
        return GamepadState(tuple(axes), tuple(buttons))


def load_pad_layouts(path: str | Path | None = None) -> dict[str, PadLayout]:
    """Read a mapping file's `[pad."NAME"]` sections, by the gamepad's name or SDL identifier.

    Raises:
        MappingError: The file is wrong; names file, key and what is allowed.
    """
    return {name: PadLayout(section) for name, section in read_mapping_file(path).pad.items()}


def standard_state(pads: SdlPads, pad: PadInfo, layouts: Mapping[str, PadLayout]) -> GamepadState | None:
    """What a gamepad says in W3C's layout: by a layout of one's own, else as SDL knows it; None when neither does."""
    layout = layouts.get(pad.name) or layouts.get(pad.guid)
    raw = pads.raw(pad.number) if layout else None
    return layout.standard(raw) if layout and raw else pads.standard(pad.number)


class Gamepad(DeviceBase):
    """One of the gamepads that are plugged in, or will be.

    Which one is settled when the first that fits is seen. When it is unplugged, readings are not connected, until one
    of the same make is plugged in again: another one that lies on the table is never taken instead.
    """

    def __init__(self, choice: int | str | None = None, layouts: Mapping[str, PadLayout] | None = None) -> None:
        """Start SDL and look for the gamepad; that none is there is no error.

        Args:
            choice: Its place among those plugged in, from 0; its name or a part of it, or SDL's identifier; None takes
                the first.
            layouts: Own layouts by gamepad name, which go before SDL's.

        Raises:
            DeviceError: SDL does not start.
        """
        self._choice = choice
        self._layouts = dict(layouts or {})
        self._pads = open_pads()
        self._pad: PadInfo | None = None
        self._lost_at = -1
        """Gamepads up to this number were there when ours was lost."""
        self._seen = 0.0
        self._open = True

    @property
    def info(self) -> PadInfo | None:
        """The gamepad, once it has been seen."""
        return self._pad

    def poll(self, now: float) -> DeviceReading:
        """Say what the gamepad says; unplugged is a reading that is not connected."""
        if not self._open:
            return DeviceReading(RESTING, self._seen, False, self._name(), "the gamepad was closed")
        present = self._pads.refresh()
        pad = self._find(present)
        if pad is None:
            return DeviceReading(RESTING, self._seen, False, self._name(), self._missing(present))
        state = standard_state(self._pads, pad, self._layouts)
        self._seen = now  # SDL tells when it is unplugged, so one that says nothing new is alive
        if state is None:
            return DeviceReading(
                RESTING,
                now,
                True,
                pad.name,
                f'the layout of gamepad {pad.name!r} is unknown: describe it under [pad."{pad.name}"] in a mapping '
                "file; `showtell devices` shows its axes and buttons",
            )
        return DeviceReading(state, now, True, pad.name)

    def close(self) -> None:
        """Let go of the gamepad."""
        if self._open:
            self._open = False
            self._pads.close()

    def _find(self, present: tuple[PadInfo, ...]) -> PadInfo | None:
        """The gamepad that was chosen, if it is there."""
        if self._pad is None:
            self._pad = self._chosen(present)
            return self._pad
        if self._pad in present:
            return self._pad
        if self._lost_at < 0:
            self._lost_at = self._pads.newest
        back = next((each for each in present if each.guid == self._pad.guid and each.number > self._lost_at), None)
        if back is not None:
            self._pad, self._lost_at = back, -1
        return back

    def _chosen(self, present: tuple[PadInfo, ...]) -> PadInfo | None:
        if self._choice is None:
            return present[0] if present else None
        if isinstance(self._choice, int):
            return present[self._choice] if 0 <= self._choice < len(present) else None
        wanted = self._choice.lower()
        exact = (each for each in present if wanted in (each.name.lower(), each.guid))
        return next(exact, None) or next((each for each in present if wanted in each.name.lower()), None)

    def _name(self) -> str:
        if self._pad is not None:
            return self._pad.name
        return "gamepad" if self._choice is None else f"gamepad {self._choice}"

    def _missing(self, present: tuple[PadInfo, ...]) -> str:
        if self._pad is not None:
            return f"gamepad {self._pad.name!r} was unplugged: plug it in again"
        if not present:
            return "no gamepad is plugged in: plug one in, and press a button of a wireless one"
        return f"there is no {self._name()!r}; plugged in are {', '.join(each.name for each in present)}"
