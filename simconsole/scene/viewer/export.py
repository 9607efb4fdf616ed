"""A whole drive to scene.rrd, block by block."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final, Generic, TypeVar

import numpy as np

from simconsole.processes.lifetimes import undone
from simconsole.scene.entities import Array, world_shapes
from simconsole.scene.timeline import Entry, Ticks
from simconsole.scene.viewer.job import Job
from simconsole.scene.viewer.scene_writer import SceneWriter
from simconsole.values.host.files import replaced
from simconsole.values.planned_path import PlannedPath
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import NS_PER_S
from simconsole.world.traffic.road_users import NOBODY_AT_ALL, RoadUsersAt

Timed = TypeVar("Timed")
DrawCamera = Callable[[Snapshot, RoadUsersAt], bytes]
PICTURES_HZ: Final = 2
"""Of a camera, which are drawn again: the log has none."""
PART_TICKS: Final = 2048
"""Ticks whose shapes are in memory at a time."""


def export(
    job: Job,
    blocks: Iterable[tuple[Ticks, Array]],
    path: Path,
    road_users: Iterable[RoadUsersAt] = (),
    plans: Iterable[PlannedPath] = (),
    entries: Sequence[Entry] = (),
    latencies: Mapping[str, Any] | None = None,
    camera: DrawCamera | None = None,
) -> None:
    """Write a drive to `path` with rerun. Call it only in a process that nothing else depends on.

    Args:
        job: course, car and columns.
        blocks: ticks [n] and state vectors [n, columns], in order; one is in memory at a time.
        path: the file to write.
        road_users: of each step of traffic, in order; those of one block are in memory at a time.
        plans: of controllers, in order; those of one block are in memory at a time.
        entries: of the log beside those that follow from the state vectors.
        latencies: the drive's latency statistics, if there are any.
        camera: draws what a camera sees at a tick among road users, as JPEG; the columns are then all of a vector.

    Raises:
        WorkerError: the file cannot be written whole.
    """
    from simconsole.scene.viewer.rerun_view import RerunView

    world = None if job.drawing is None else world_shapes(job.drawing)
    with replaced(path) as draft, undone(lambda: draft.unlink(missing_ok=True)):
        view = RerunView(draft, job, world)
        writer = SceneWriter(job, view)
        steps = _Ahead(road_users, lambda users: users.tick)
        planned = _Ahead(plans, lambda plan: plan.t_ns * job.tick_hz // NS_PER_S)
        newest = NOBODY_AT_ALL
        for ticks, vectors in _in_parts(blocks):
            last = int(ticks[-1]) if len(ticks) else -1
            shown = steps.until(last)
            writer.add(ticks, vectors, shown, planned.until(last))
            if camera is not None:
                for row in np.flatnonzero(ticks % max(1, job.tick_hz // PICTURES_HZ) == 0).tolist():
                    tick = int(ticks[row])
                    newest = next((users for users in reversed(shown) if users.tick <= tick), newest)
                    view.add_picture(tick, camera(Snapshot(tick, job.tick_hz, vectors[row]), newest))
            view.settle()  # what rerun has queued for a slow disk would grow in memory
        view.add_entries(entries)
        if latencies:
            view.add_latencies(0, latencies)
        view.close()


class _Ahead(Generic[Timed]):
    """Takes what belongs to each block from what comes in order, and reads one further."""

    def __init__(self, timed: Iterable[Timed], tick_of: Callable[[Timed], int]) -> None:
        self._rest, self._tick_of = iter(timed), tick_of
        self._next = next(self._rest, None)

    def until(self, tick: int) -> list[Timed]:
        """Return what comes next, up to a tick."""
        found = []
        while self._next is not None and self._tick_of(self._next) <= tick:
            found.append(self._next)
            self._next = next(self._rest, None)
        return found


def _in_parts(blocks: Iterable[tuple[Ticks, Array]]) -> Iterator[tuple[Ticks, Array]]:
    for ticks, vectors in blocks:
        for start in range(0, len(ticks), PART_TICKS):
            part = slice(start, start + PART_TICKS)
            yield ticks[part], vectors[part]
