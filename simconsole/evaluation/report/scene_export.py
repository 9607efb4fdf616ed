"""scene.rrd of a bundle, made by a process of its own: `python -m simconsole.evaluation.report.scene_export BUNDLE`.

rerun may block for good, so it is never called in the process that waits. The program reads the bundle itself, block by
block, and writes the share of the drive that it has done to its standard output, a line a block. With `--attached`
before the bundle, as the console starts it, it ends with whoever holds its standard input.
"""

import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryFile
from threading import Thread
from typing import Final

from simconsole.processes.lifetimes import ATTACHED, end, follow_parent, spawn
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import recorded_session
from simconsole.recording.log_header import ACTS
from simconsole.recording.reading import Recording
from simconsole.recording.recorded_plans import recorded_plans
from simconsole.recording.recorded_road_users import recorded_road_users
from simconsole.scene.entities import Array
from simconsole.scene.operator_acts import act_entry
from simconsole.scene.timeline import Ticks
from simconsole.scene.viewer.export import export
from simconsole.scene.viewer.job import job_of
from simconsole.session.camera_worker import DrawCamera, drawn_camera
from simconsole.session.scene_worker import scene_columns, scene_source
from simconsole.session.view.view_job import view_job
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import SimConsoleError, WorkerError
from simconsole.values.host.files import draft_of

SCENE: Final = "scene.rrd"
STALL_S: Final = 60.0
"""A scene of which nothing was added for so long has failed; how long the whole takes is not limited."""
_LOOK_S: Final = 0.1


@contextmanager
def scene_process(
    folder: Path, told: Callable[[float], object], stall_s: float = STALL_S
) -> Iterator[Callable[[], None]]:
    """Run a process that writes a bundle's scene.rrd; yield what waits for it. An earlier end leaves no file.

    Args:
        folder: the bundle.
        told: called in a thread with the share of the drive that is written, from 0 to 1.
        stall_s: how long it may take to add anything.

    Raises:
        WorkerError: it cannot be started, failed or stands still; what it said is in the message.
    """
    path = folder / SCENE
    arguments = ["-m", "simconsole.evaluation.report.scene_export", ATTACHED, str(folder)]
    with TemporaryFile() as said:  # not a pipe: nobody reads it until the end
        try:
            process = spawn(arguments, stdout=subprocess.PIPE, stderr=said.fileno())
        except OSError as error:
            raise WorkerError(f"{path}: the scene was not written: {error.strerror}") from None
        listener = _Listener(process, told)
        listener.start()
        try:
            yield lambda: _wait(process, path, listener, stall_s)
        finally:
            end([process], 0.0)
            listener.join()
            if process.returncode != 0:
                with suppress(OSError):
                    draft_of(path).unlink(missing_ok=True)  # of a process that was killed
        if process.returncode != 0:
            said.seek(0)
            lines = said.read().decode("utf-8", "replace").strip().splitlines()
            reason = (lines or [f"exit status {process.returncode}"])[-1]
            raise WorkerError(f"{path}: the scene was not written: {reason}")


class _Listener(Thread):
    """Passes on how far the process is, and keeps when it last said so."""

    def __init__(self, process: "subprocess.Popen[bytes]", told: Callable[[float], object]) -> None:
        super().__init__(name="scene export", daemon=True)
        self._process = process
        self._told = told
        self.moved_s = time.monotonic()

    def run(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as lines:
            for line in lines:
                self.moved_s = time.monotonic()
                self._told(float(line))


def _wait(process: "subprocess.Popen[bytes]", path: Path, listener: _Listener, stall_s: float) -> None:
    while process.poll() is None:
        if time.monotonic() - listener.moved_s > stall_s:
            raise WorkerError(f"{path}: the scene was not written: nothing was added to it for {stall_s:g} s")
        with suppress(subprocess.TimeoutExpired):
            process.wait(_LOOK_S)


def write(folder: Path) -> None:
    """Write scene.rrd into a bundle, in this process, and say on standard output how far it is.

    Raises:
        RecordingError: not a bundle, or of another version.
        WorkerError: the file cannot be written whole.
    """
    bundle = open_bundle(folder)
    resolved = recorded_session(bundle)
    ticks = (
        bundle.manifest.ticks if bundle.manifest.finished else sum(len(part.ticks) for part in bundle.log.blocks(()))
    )
    header = bundle.log.header
    columns = scene_columns(resolved, header.columns)
    job = job_of(scene_source(resolved, columns, header.tick_hz))
    acts = bundle.log.messages(ACTS) if any(stream.name == ACTS for stream in header.streams) else ()
    export(
        job,
        _told(bundle.log, columns, ticks),
        folder / SCENE,
        road_users=recorded_road_users(bundle.log),
        plans=recorded_plans(bundle.log),
        entries=[act_entry(message.content, header.tick_hz) for message in acts],
        latencies=bundle.manifest.summary.get("latency_us"),
        camera=_camera(resolved),
    )


def _camera(resolved: ResolvedSession) -> DrawCamera | None:
    """Return what draws the session's camera; None where it has none, or this machine no OpenGL for it."""
    bridge = resolved.session.outputs.bridge
    if bridge is None or bridge.camera is None:
        return None
    try:
        return drawn_camera(view_job(resolved), bridge.camera)
    except WorkerError:
        return None


def _told(recording: Recording, columns: tuple[str, ...], ticks: int) -> Iterator[tuple[Ticks, Array]]:
    done = 0
    for block in recording.blocks(columns):
        yield block.ticks, block.vectors
        done += len(block.ticks)
        print(f"{done / max(ticks, 1):.4f}", flush=True)


def main(arguments: list[str]) -> int:
    """Write the scene of a bundle; the exit code is 0, or 2 with one line of reason."""
    if arguments[:1] == [ATTACHED]:
        follow_parent(None)
        arguments = arguments[1:]
    if len(arguments) != 1:
        print("usage: python -m simconsole.evaluation.report.scene_export BUNDLE", file=sys.stderr)
        return 2
    try:
        write(Path(arguments[0]))
    except SimConsoleError as problem:
        print(problem, file=sys.stderr)
        return problem.exit_code
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
