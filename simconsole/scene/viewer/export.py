"""A whole drive to scene.rrd, block by block."""

from collections.abc import Iterable
from pathlib import Path

from simconsole.processes.lifetimes import undone
from simconsole.scene.entities import Array, world_shapes
from simconsole.scene.timeline import Memory, Ticks, piece
from simconsole.scene.viewer.job import Job
from simconsole.values.host.files import replaced


def export(job: Job, blocks: Iterable[tuple[Ticks, Array]], path: Path) -> None:
    """Write a drive to `path` with rerun. Call it only in a process that nothing else depends on.

    Args:
        job: course, car and columns.
        blocks: ticks [n] and state vectors [n, columns], in order; one is in memory at a time.
        path: the file to write.

    Raises:
        WorkerError: the file cannot be written whole.
    """
    from simconsole.scene.viewer.rerun_view import RerunView

    world = None if job.drawing is None else world_shapes(job.drawing)
    with replaced(path) as draft, undone(lambda: draft.unlink(missing_ok=True)):
        view = RerunView(draft, job.profile, job.dimensions, world)
        memory = Memory()
        for ticks, vectors in blocks:
            added, memory = piece(vectors, job.columns, ticks, job.tick_hz, job.profile.rate_hz, memory)
            view.add(added)
        view.close()
