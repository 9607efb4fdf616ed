"""A whole drive to scene.rrd, block by block."""

from collections.abc import Iterable
from pathlib import Path

from simconsole.processes.lifetimes import undone
from simconsole.scene.entities import Array, world_shapes
from simconsole.scene.lamp_shapes import LampChanges
from simconsole.scene.road_user_shapes import road_user_shapes
from simconsole.scene.timeline import Memory, Ticks, piece
from simconsole.scene.viewer.job import Job
from simconsole.values.host.files import replaced
from simconsole.world.traffic.road_users import RoadUsersAt


def export(job: Job, blocks: Iterable[tuple[Ticks, Array]], path: Path, road_users: Iterable[RoadUsersAt] = ()) -> None:
    """Write a drive to `path` with rerun. Call it only in a process that nothing else depends on.

    Args:
        job: course, car and columns.
        blocks: ticks [n] and state vectors [n, columns], in order; one is in memory at a time.
        path: the file to write.
        road_users: of each step of traffic, in order; those of one block are in memory at a time.

    Raises:
        WorkerError: the file cannot be written whole.
    """
    from simconsole.scene.viewer.rerun_view import RerunView

    world = None if job.drawing is None else world_shapes(job.drawing)
    with replaced(path) as draft, undone(lambda: draft.unlink(missing_ok=True)):
        view = RerunView(draft, job.profile, job.dimensions, world)
        memory, lamps = Memory(), LampChanges(job.drawing, job.tick_hz)
        steps = iter(road_users)
        step = next(steps, None)
        for ticks, vectors in blocks:
            added, memory = piece(vectors, job.columns, ticks, job.tick_hz, job.profile.rate_hz, memory)
            view.add(added)
            if len(ticks) and (changed := lamps.until(int(ticks[-1]))) is not None:
                view.add_lamps(changed)
            shown: list[RoadUsersAt] = []
            while step is not None and len(ticks) and step.tick <= ticks[-1]:
                shown.append(step)
                step = next(steps, None)
            if shown:
                view.add_road_users(
                    road_user_shapes(shown, job.tick_hz, None if job.drawing is None else job.drawing.ground)
                )
        view.close()
