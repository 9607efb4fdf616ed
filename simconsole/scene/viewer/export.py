"""A whole drive to scene.rrd, in a process of its own: `python -m simconsole.scene.viewer.export JOB.npz SCENE.rrd`.

With `--attached` before them, as the console starts it, it ends with whoever holds its standard input.
"""

import subprocess
import sys
from pathlib import Path
from typing import Final

from simconsole.processes.lifetimes import ATTACHED, end, follow_parent, spawn, undone
from simconsole.processes.shared_memory import temporary_folder
from simconsole.scene.entities import world_shapes
from simconsole.scene.timeline import Memory, piece
from simconsole.scene.viewer.job import Job, load_job, save_job
from simconsole.values.errors import SimConsoleError, WorkerError
from simconsole.values.host.files import replaced

PIECE_S: Final = 60.0
"""Length of the pieces a drive is written in: bounds the memory, not the speed."""


def export(job: Job, path: Path) -> None:
    """Write `job` to `path` with rerun. Call it only in a process that nothing else depends on.

    Raises:
        WorkerError: the file cannot be written whole.
    """
    from simconsole.scene.viewer.rerun_view import RerunView

    world = None if job.drawing is None else world_shapes(job.drawing)
    with replaced(path) as draft, undone(lambda: draft.unlink(missing_ok=True)):
        view = RerunView(draft, job.profile, job.dimensions, world)
        memory = Memory()
        step = max(1, round(PIECE_S * job.tick_hz))
        for start in range(0, len(job.ticks), step):
            stop = start + step
            added, memory = piece(
                job.vectors[start:stop], job.columns, job.ticks[start:stop], job.tick_hz, job.profile.rate_hz, memory
            )
            view.add(added)
        view.close()


def export_apart(job: Job, path: Path, deadline_s: float = 60.0) -> None:
    """Run `export` in a process of its own and wait for it, but never longer than `deadline_s`.

    Raises:
        WorkerError: it failed or took too long; what it said is in the message.
    """
    with temporary_folder() as folder, (folder / "said").open("w+b") as said:
        job_path = folder / "job.npz"
        save_job(job_path, job)
        arguments = ["-m", "simconsole.scene.viewer.export", ATTACHED, str(job_path), str(path)]
        try:
            process = spawn(arguments, stderr=said.fileno())
        except OSError as error:
            raise WorkerError(f"{path}: the scene was not written: {error.strerror}") from None
        try:
            process.wait(deadline_s)
        except subprocess.TimeoutExpired:
            raise WorkerError(f"{path}: the scene was not written within {deadline_s:g} s") from None
        finally:
            end([process], 0.0)
        said.seek(0)
        lines = said.read().decode("utf-8", "replace").strip().splitlines()
    if process.returncode != 0:
        reason = (lines or [f"exit status {process.returncode}"])[-1]
        raise WorkerError(f"{path}: the scene was not written: {reason}")


def main(arguments: list[str]) -> int:
    """Export a job file; the exit code is 0, or 2 with one line of reason."""
    if arguments[:1] == [ATTACHED]:
        follow_parent(None)
        arguments = arguments[1:]
    if len(arguments) != 2:
        print("usage: python -m simconsole.scene.viewer.export JOB.npz SCENE.rrd", file=sys.stderr)
        return 2
    try:
        export(load_job(Path(arguments[0])), Path(arguments[1]))
    except SimConsoleError as problem:
        print(problem, file=sys.stderr)
        return problem.exit_code
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
