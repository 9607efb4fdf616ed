"""A whole drive to scene.rrd, in a process of its own: `python -m simconsole.scene.export JOB.npz SCENE.rrd`."""

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Final

from simconsole.errors import SimConsoleError, StationError
from simconsole.files import replaced
from simconsole.scene.entities import world_shapes
from simconsole.scene.job import Job, load_job, save_job
from simconsole.scene.timeline import Memory, piece

PIECE_S: Final = 60.0
"""Length of the pieces a drive is written in: bounds the memory, not the speed."""


def export(job: Job, path: Path) -> None:
    """Write `job` to `path` with rerun. Call it only in a process that nothing else depends on.

    Raises:
        StationError: the file cannot be written whole.
    """
    from simconsole.scene.rerun_view import RerunView

    world = None if job.drawing is None else world_shapes(job.drawing)
    with replaced(path) as draft:
        view = RerunView(draft, job.profile, job.dimensions, world)
        memory = Memory()
        step = max(1, round(PIECE_S * job.tick_hz))
        for start in range(0, len(job.ticks), step):
            end = start + step
            added, memory = piece(
                job.rows[start:end], job.columns, job.ticks[start:end], job.tick_hz, job.profile.rate_hz, memory
            )
            view.add(added)
        view.close()


def export_apart(job: Job, path: Path, deadline_s: float = 60.0) -> None:
    """Run `export` in a process of its own and wait for it, but never longer than `deadline_s`.

    Raises:
        StationError: it failed or took too long; what it said is in the message.
    """
    with tempfile.TemporaryDirectory(prefix="simconsole-scene-") as folder:
        job_path = Path(folder) / "job.npz"
        save_job(job_path, job)
        command = [sys.executable, "-m", "simconsole.scene.export", str(job_path), str(path)]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=deadline_s, check=False)
        except subprocess.TimeoutExpired:
            raise StationError(f"{path}: the scene was not written within {deadline_s:g} s") from None
    if done.returncode != 0:
        said = (done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[-1]
        raise StationError(f"{path}: the scene was not written: {said}")


def main(arguments: list[str]) -> int:
    """Export a job file; the exit code is 0, or 2 with one line of reason."""
    if len(arguments) != 2:
        print("usage: python -m simconsole.scene.export JOB.npz SCENE.rrd", file=sys.stderr)
        return 2
    try:
        export(load_job(Path(arguments[0])), Path(arguments[1]))
    except SimConsoleError as problem:
        print(problem, file=sys.stderr)
        return problem.exit_code
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
