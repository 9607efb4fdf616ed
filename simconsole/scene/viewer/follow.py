"""A drive to scene.live.rrd while it is driven, in a process of its own whose memory does not grow with the drive.

Viewers read that file, however late they come, and reach no process of the drive: none of them can hold it up. What
comes faster than it can be shown is lost, the oldest first, for the rings that it is read from hold a few seconds.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from simconsole.processes.notices import Notice
from simconsole.scene.entities import world_shapes
from simconsole.scene.lanes import LINK_LANE, Lane
from simconsole.scene.timeline import Entry
from simconsole.scene.viewer.job import Job
from simconsole.scene.viewer.scene_writer import SceneWriter
from simconsole.values.planned_path import PlannedPath
from simconsole.values.state_vector import Snapshot
from simconsole.world.traffic.road_users import RoadUsersAt

POLL_S = 0.05
LATENCIES_S = 1.0


class Shot(NamedTuple):
    """A picture of the camera, as JPEG, of a tick."""

    tick: int
    jpeg: bytes


class Ports(NamedTuple):
    """What the scene needs of the world outside."""

    new_ticks: Callable[[], Sequence[Snapshot]]  # all ticks since the last call, oldest first; gaps are allowed
    stop: Callable[[], bool]  # True ends the recording
    road_users: Callable[[], Sequence[RoadUsersAt]] = tuple  # all steps of traffic since the last call
    plans: Callable[[], Sequence[PlannedPath]] = tuple  # of controllers since the last call
    link: Callable[[], str | None] = lambda: None  # how the rosbridge link stands; None where there is no bridge
    camera: Callable[[], Shot | None] = lambda: None  # the newest picture
    latencies: Callable[[], Mapping[str, Any]] = dict  # latency statistics, by hop
    entries: Callable[[], Sequence[Entry]] = tuple  # lines for the log since the last call
    notices: Callable[[], Sequence[Notice]] = tuple  # of the processes beside the drive, since the last call
    clock_s: Callable[[], float] = time.monotonic


def follow(ports: Ports, job: Job, path: Path) -> None:
    """Append ticks as they come until `ports.stop` says so; then what is left, and close the file.

    Args:
        ports: the ring and the end.
        job: course, car and columns.
        path: the file; what an earlier process of the same drive has written is kept.

    Raises:
        WorkerError: the file cannot be written.
    """
    from simconsole.scene.viewer.rerun_view import RerunView

    world = None if job.drawing is None else world_shapes(job.drawing)
    view = RerunView(path, job, world, live=True)
    writer, beside = SceneWriter(job, view), _Beside(ports, view)
    waiting: list[Snapshot] = []
    steps: list[RoadUsersAt] = []
    plans: list[PlannedPath] = []
    written_s = ports.clock_s()
    running = True
    while running:
        # Asked before reading, so that ticks from just before the end are still read.
        running = not ports.stop()
        waiting += ports.new_ticks()
        steps += ports.road_users()
        plans += ports.plans()
        if waiting and (not running or ports.clock_s() - written_s >= job.profile.chunk_s):
            ticks = np.array([snapshot.tick for snapshot in waiting], dtype=np.int64)
            writer.add(ticks, np.array([snapshot.vector for snapshot in waiting]), steps, plans)
            beside.add(waiting[-1])
            view.settle()
            waiting.clear()
            steps.clear()
            plans.clear()
            written_s = ports.clock_s()
        if running:
            time.sleep(POLL_S)
    view.close()


class _Beside:
    """What lives in wall time and is in no state vector: it is shown at the newest known tick."""

    def __init__(self, ports: Ports, view: Any) -> None:
        self._ports, self._view = ports, view
        self._link, self._shown_tick, self._told_s = "", -1, -LATENCIES_S

    def add(self, newest: Snapshot) -> None:
        """Show what has changed."""
        ports, view = self._ports, self._view
        state = ports.link()
        if state is not None and state != self._link:
            self._link = state
            view.add_lane(Lane(LINK_LANE, [newest.t_ns], [state]))
        shot = ports.camera()
        if shot is not None and shot.tick != self._shown_tick:
            self._shown_tick = shot.tick
            view.add_picture(shot.tick, shot.jpeg)
        if ports.clock_s() - self._told_s >= LATENCIES_S:
            self._told_s = ports.clock_s()
            if latencies := ports.latencies():
                view.add_latencies(newest.t_ns, latencies)
        said = [Entry(newest.t_ns, notice.level, notice.text) for notice in ports.notices()]
        view.add_entries([*ports.entries(), *said])
