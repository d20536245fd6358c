"""Start, stop, keep, discard and redo a recording: what the buttons of a page or a gamepad call."""

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Literal

from .demo_events import OutcomeKind
from .demo_file import SUFFIX
from .errors import TeleopError
from .recorder import Recorder
from .trim import trim_demo

RecordingState = Literal["idle", "recording", "stopped"]
TRASH = ".discarded"
"""The demo that was discarded last lies under this name in the folder, until the next is."""


class Recording:
    """The recordings of one folder, one at a time: idle, recording, stopped (to be kept or discarded), idle.

    A file gets the next free number and never replaces another. Each demo starts with its scene as new, so that it
    can be simulated afresh; `begin` sees to that. The file stays open until the demo is kept or discarded: what is said
    after the end goes to its end, on the way on which everything goes to the disk, and the control loop, in which all
    of this is called, waits for nothing. Only `keep` may wait, where it is told to.

    Attributes:
        folder: Where the demos are.
        state: Which of the buttons make sense now.
        path: The demo that is or was recorded last; None before the first.
    """

    def __init__(self, folder: str | Path, begin: Callable[[Path], Recorder], name: str = "demo") -> None:
        """Nothing is recorded yet.

        Args:
            folder: Where the demos go; made when it is needed.
            begin: Puts the scene back to its start and opens a recorder for it at a path, with `exclusive` set.
            name: The files are called `<name>_0001.mcap` and so on.
        """
        self.folder = Path(folder)
        self.state: RecordingState = "idle"
        self.path: Path | None = None
        self._begin = begin
        self._name = name
        self._recorder: Recorder | None = None
        self._discarded: Recorder | None = None
        self._kept: Recorder | None = None
        """Kept, and perhaps not whole on the disk yet."""
        self._waiting: list[str] = []
        self._said_before: list[str] = []
        self._marks: list[float] = []

    @property
    def recorder(self) -> Recorder | None:
        """What the control loop writes to, while recording; None otherwise."""
        return self._recorder if self.state == "recording" else None

    @property
    def failed(self) -> str:
        """Why recording ended by itself, such as a full disk; empty while all is well. Control need not stop."""
        return "" if self._recorder is None else self._recorder.failed

    def start(self) -> Path:
        """Start a new demo from the scene's start; sentences said before are part of it.

        Raises:
            TeleopError: A recording is on, or waits to be kept or discarded.
            DemoError: The file cannot be written.
        """
        self._need("idle", "start")
        path = self._free()
        self._recorder = self._begin(path)
        self.path, self.state, self._marks = path, "recording", []
        for text in self._waiting:
            self._recorder.utterance(text, "before")
        self._said_before, self._waiting = self._waiting, []
        return path

    def poll(self) -> str:
        """Look after the disk; call now and then. Returns what people should be told, mostly nothing.

        When the disk failed, the recording is over, what was written is kept, and control goes on.
        """
        if self._kept is not None and self._kept.finished:
            kept, self._kept = self._kept, None
            if kept.failed:
                return kept.failed
        if self._recorder is None or self.state == "idle" or not (told := self.failed):
            return ""
        self._recorder.finish()
        self._recorder, self.state = None, "idle"
        return told

    def settle(self) -> None:
        """Wait until the demo that was kept last is whole on the disk; `poll` tells if it failed."""
        if self._kept is not None:
            self._kept.wait()

    def say(self, text: str) -> None:
        """Add a sentence: before a recording (it goes with the next), during it, or after it.

        Raises:
            TeleopError: Nothing was said.
        """
        text = " ".join(text.split())
        if not text:
            raise TeleopError("there is nothing to add: a sentence that describes the demo is needed")
        if self._recorder is None:
            self._waiting.append(text)
        else:
            self._recorder.utterance(text, "after" if self.state == "stopped" else None)

    def mark(self) -> float:
        """Mark where the piece that matters starts and, at the second call, ends; `keep` then makes a trimmed copy.

        Returns:
            The time in the demo [s].

        Raises:
            TeleopError: Nothing is being recorded.
        """
        self._need("recording", "mark a moment of")
        seconds = 0.0 if self._recorder is None else self._recorder.seconds
        self._marks = [*self._marks[:1], seconds]
        return seconds

    def stop(self, outcome: OutcomeKind | None = None, note: str = "") -> Path:
        """End the demo; it then waits to be kept or discarded, and is safe meanwhile.

        A process that is killed meanwhile leaves a demo that has all its steps and is marked as ending early.

        Args:
            outcome: How it ended, if that is known already.
            note: Why.

        Raises:
            TeleopError: Nothing is being recorded.
        """
        self._need("recording", "stop")
        if self._recorder is None or self.path is None:
            raise TeleopError("nothing is being recorded")
        if outcome is not None:
            self._recorder.outcome(outcome, note)
        self._recorder.event("record", "ended")
        self._recorder.flush()
        self.state = "stopped"
        return self.path

    def label(self, outcome: OutcomeKind, note: str = "") -> None:
        """Say how the demo ended, while it is recorded or when it has stopped; the last word counts.

        Raises:
            TeleopError: There is no demo to label.
            DemoError: There is no such outcome.
        """
        if self._recorder is None:
            self._need("stopped", "label")
        else:
            self._recorder.outcome(outcome, note)

    def keep(self, outcome: OutcomeKind | None = None, note: str = "", *, wait: bool = True) -> Path:
        """Keep the demo, success or failure; with a trimmed copy beside it where two moments were marked.

        Args:
            outcome: How it ended, if that is known now.
            note: Why.
            wait: Return when it is on the disk. Without, `poll` tells if the disk fails; marks need it.

        Raises:
            TeleopError: There is no demo to keep.
            DemoError: The disk failed, and what was written is kept; or the marks are too close for a copy.
        """
        if self.state == "recording":
            self.stop(outcome, note)
        elif outcome is not None:
            self.label(outcome, note)
        self._need("stopped", "keep")
        recorder, path = self._recorder, self.path
        if recorder is None or path is None:
            raise TeleopError("there is no demo")
        self._recorder, self.state = None, "idle"  # whatever fails from here on, the next demo can be recorded
        recorder.finish()
        if not wait:
            self._kept = recorder
            return path
        recorder.close()
        if len(self._marks) == 2:
            start, end = self._marks
            trim_demo(path, start, end, path.with_name(f"{path.stem}_trimmed{SUFFIX}"))
        return path

    def discard(self) -> None:
        """Throw the demo away; the last one can be had back with `restore`.

        Raises:
            TeleopError: There is no demo to discard.
        """
        if self.state == "recording":
            self.stop()
        self._need("stopped", "discard")
        if self.path is not None:
            with suppress(FileNotFoundError):
                os.replace(self.path, self.folder / TRASH)
        if self._recorder is not None:
            self._recorder.finish()
        self._discarded, self._recorder, self.state = self._recorder, None, "idle"

    def restore(self) -> Path:
        """Bring back the demo that was discarded last, under a new number.

        Raises:
            TeleopError: There is none.
        """
        trash, path = self.folder / TRASH, self._free()
        if not trash.exists():
            raise TeleopError(f"nothing was discarded in {self.folder}")
        if self._discarded is not None:
            self._discarded.wait()  # its end may still be on its way to the disk
        os.replace(trash, path)
        return path

    def redo(self) -> Path:
        """Discard the demo and start again from the scene; sentences said before it are said again.

        Raises:
            TeleopError: There is no demo to discard.
            DemoError: The new file cannot be written.
        """
        self.discard()
        self._waiting = [*self._said_before, *self._waiting]
        return self.start()

    def close(self) -> None:
        """Finish what is being recorded; it is kept."""
        if self._recorder is not None:
            if self.state == "recording":
                self._recorder.event("record", "ended with the program")
            self._recorder.finish()
            self._recorder.wait()
        self.settle()
        self._recorder, self.state = None, "idle"

    def _free(self) -> Path:
        """The next number after the last in use."""
        prefix = f"{self._name}_"
        names = [path.name for path in self.folder.glob(f"{prefix}*")]
        used = [name.removeprefix(prefix).split(".")[0].split("_")[0] for name in names]
        number = 1 + max((int(each) for each in used if each.isdigit()), default=0)
        return self.folder / f"{prefix}{number:04d}{SUFFIX}"

    def _need(self, state: RecordingState, what: str) -> None:
        if self.state != state:
            is_on = {
                "idle": "nothing is recorded",
                "recording": "a recording is on: stop it first",
                "stopped": "a demo waits to be kept or discarded",
            }
            raise TeleopError(f"cannot {what} a recording now: {is_on[self.state]}")
