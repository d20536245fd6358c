"""Rendering recorded states in other processes, so that control is never kept waiting by a picture."""

import itertools
import multiprocessing
import os
import queue
import signal
import threading
from collections.abc import Iterable, Iterator
from multiprocessing.connection import Connection

import numpy as np

from robots.pose import FloatArray, Pose

from ..errors import TwinError
from .camera_model import CameraModel
from .frame import RgbdFrame
from .renderer import make_renderer
from .scene_geometry import SceneGeometry

State = tuple[FloatArray, Pose]
"""Poses of the moving drawables, (N, 4, 4), and pose of the camera's optical frame, in the world."""

LOOK_AHEAD = 8
"""States given to each process before its first frame is asked for."""


def render_states(
    geometry: SceneGeometry,
    camera: CameraModel,
    states: Iterable[State],
    processes: int | None = None,
    kind: str = "auto",
) -> Iterator[RgbdFrame]:
    """Render recorded states.

    States are taken as they are needed, so that neither they nor the frames need fit in memory. Leaving the loop early,
    an error and Ctrl-C all end the processes. As always with processes, a script calls this under
    `if __name__ == "__main__":`.

    Args:
        geometry: What to draw.
        camera: The camera.
        states: For every frame, the poses of the moving drawables (N, 4, 4) and the pose of the camera's optical frame.
        processes: How many; None takes one for each processor, 0 renders in this process.
        kind: Renderer, as in `make_renderer`.

    Yields:
        The frames in the order of the states, bit for bit what one renderer in this process gives.

    Raises:
        TwinError: `processes` is negative, a state does not fit the geometry, the renderer is missing, or a process was
            killed.
    """
    if processes is not None and processes < 0:
        raise TwinError(f"processes must be at least 0, got {processes}")
    if processes == 0:
        return _rendered_here(geometry, camera, states, kind)
    return _rendered_elsewhere(geometry, camera, states, processes or _processors(), kind)


def _processors() -> int:
    """How many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _rendered_here(
    geometry: SceneGeometry, camera: CameraModel, states: Iterable[State], kind: str
) -> Iterator[RgbdFrame]:
    with make_renderer(geometry, camera, kind) as renderer:
        for poses, pose_camera_in_world in states:
            yield renderer.render(poses, pose_camera_in_world)


def _rendered_elsewhere(
    geometry: SceneGeometry, camera: CameraModel, states: Iterable[State], processes: int, kind: str
) -> Iterator[RgbdFrame]:
    workers: list[_Worker] = []
    try:
        workers.extend(_Worker(geometry, camera, kind) for _ in range(processes))
        remaining = iter(states)
        # Frame k is rendered by worker k modulo their number, and fetched in that order.
        asked = 0
        for state in itertools.islice(remaining, LOOK_AHEAD * processes):
            workers[asked % processes].ask(state)
            asked += 1
        fetched = 0
        while fetched < asked:
            frame = workers[fetched % processes].fetch()
            fetched += 1
            for state in itertools.islice(remaining, 1):
                workers[asked % processes].ask(state)
                asked += 1
            yield frame
    finally:
        for worker in workers:
            worker.stop()


class _Worker:
    """A process with a renderer, and the thread that takes its frames, so that it never waits for us."""

    def __init__(self, geometry: SceneGeometry, camera: CameraModel, kind: str) -> None:
        self._camera = camera
        self._frames: queue.SimpleQueue[RgbdFrame | Exception] = queue.SimpleQueue()
        # A forked child would share the parent's OpenGL and its threads' locks.
        context = multiprocessing.get_context("spawn")
        self._connection, theirs = context.Pipe()
        self._process = context.Process(target=_work, args=(theirs, geometry, camera, kind), daemon=True)
        self._process.start()
        theirs.close()  # so that the end of the process is the end of the pipe
        self._thread = threading.Thread(target=self._receive, daemon=True)
        self._thread.start()

    def ask(self, state: State) -> None:
        """Ask for a frame."""
        try:
            self._connection.send(state)
        except OSError:
            return  # the thread has seen the process's end too, and `fetch` tells

    def fetch(self) -> RgbdFrame:
        """Wait for the next frame."""
        answer = self._frames.get()
        if isinstance(answer, Exception):
            raise answer
        return answer

    def _receive(self) -> None:
        size = (self._camera.height, self._camera.width)
        try:
            while self._connection.recv():
                colour, depth, mask = (
                    np.empty((*size, 3), np.uint8),
                    np.empty(size, np.float32),
                    np.empty(size, np.int32),
                )
                for part in (colour, depth, mask):
                    self._connection.recv_bytes_into(part.data.cast("B"))
                self._frames.put(RgbdFrame(colour, depth, mask))
            self._frames.put(self._connection.recv())
        except (EOFError, OSError):
            self._frames.put(
                TwinError("a rendering process ended early (killed, or out of memory): use fewer processes")
            )

    def stop(self) -> None:
        """End the process, whatever it does."""
        self._process.terminate()
        self._process.join()
        self._thread.join()
        self._connection.close()
        self._process.close()


def _work(connection: Connection, geometry: SceneGeometry, camera: CameraModel, kind: str) -> None:
    """The other process: a state comes in; True and three arrays go out, or False and an error."""
    # Ctrl-C reaches the whole group; the parent ends us in order.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # The processes fill the processors already; Mesa reads this when the context is made.
    os.environ["LP_NUM_THREADS"] = "1"
    try:
        with make_renderer(geometry, camera, kind) as renderer:
            while True:
                frame = renderer.render(*connection.recv())
                connection.send(True)
                for part in (frame.colour, frame.depth, frame.mask):
                    connection.send_bytes(part.data.cast("B"))
    except (EOFError, BrokenPipeError):
        return  # the parent is gone
    except Exception as error:  # whatever it is, the parent raises it
        connection.send(False)
        connection.send(error)
