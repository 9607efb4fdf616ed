"""A drive to scene.live.rrd while it is driven, in a process of its own whose memory does not grow with the drive.

The file has no index, which rerun would collect until the end; scene.rrd, made from the log afterwards, has one.
"""

import os
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from simconsole.scene.entities import world_shapes
from simconsole.scene.lamp_shapes import LampChanges
from simconsole.scene.road_user_shapes import road_user_shapes
from simconsole.scene.timeline import Lane, Memory, piece
from simconsole.scene.viewer.job import Job
from simconsole.values.state_vector import Snapshot
from simconsole.world.traffic.road_users import RoadUsersAt

POLL_S = 0.01
LINK_LANE = "lanes/link"
QUIET = "warn,re_log_encoding::rrd::file_sink=error"
"""rerun's RUST_LOG: by default it warns of each file without an index."""


class Ports(NamedTuple):
    """What the scene needs of the world outside."""

    new_ticks: Callable[[], Sequence[Snapshot]]  # all ticks since the last call, oldest first; gaps are allowed
    stop: Callable[[], bool]  # True ends the recording
    road_users: Callable[[], Sequence[RoadUsersAt]] = tuple  # all steps of traffic since the last call
    link: Callable[[], str | None] = lambda: None  # how the rosbridge link stands; None where there is no bridge


def follow(ports: Ports, job: Job, path: Path) -> None:
    """Write ticks as they come until `ports.stop` says so; then what is left, and close the file.

    Args:
        ports: the ring and the end.
        job: course, car and columns.
        path: the file to write.

    Raises:
        WorkerError: the file cannot be written.
    """
    os.environ.setdefault("RUST_LOG", QUIET)
    from simconsole.scene.viewer.rerun_view import RerunView

    world = None if job.drawing is None else world_shapes(job.drawing)
    ground = None if job.drawing is None else job.drawing.ground
    view = RerunView(path, job.profile, job.dimensions, world, index=False)
    memory, lamps = Memory(), LampChanges(job.drawing, job.tick_hz)
    waiting: list[Snapshot] = []
    steps: list[RoadUsersAt] = []
    link, seen = Lane(LINK_LANE, [], []), ""
    written_s = time.monotonic()
    running = True
    while running:
        # Asked before reading, so that ticks from just before the end are still read.
        running = not ports.stop()
        waiting += ports.new_ticks()
        steps += ports.road_users()
        state = ports.link()
        if waiting and state is not None and state != seen:
            # The link changes in wall time and is in no state vector: it is logged at the newest known tick.
            seen = state
            link.times_ns.append(waiting[-1].t_ns)
            link.states.append(state)
        if waiting and (not running or time.monotonic() - written_s >= job.profile.chunk_s):
            vectors = np.array([snapshot.vector for snapshot in waiting])
            ticks = np.array([snapshot.tick for snapshot in waiting], dtype=np.int64)
            added, memory = piece(vectors, job.columns, ticks, job.tick_hz, job.profile.rate_hz, memory)
            view.add(added._replace(lanes=(*added.lanes, link)))
            if (changed := lamps.until(waiting[-1].tick)) is not None:
                view.add_lamps(changed)
            if steps:
                view.add_road_users(road_user_shapes(steps, job.tick_hz, ground))
                steps.clear()
            view.settle()
            link = Lane(LINK_LANE, [], [])
            waiting.clear()
            written_s = time.monotonic()
        if running:
            time.sleep(POLL_S)
    view.close()
