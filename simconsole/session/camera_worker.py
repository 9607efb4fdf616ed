"""The worker that draws what a camera on the vehicle sees, in a process of its own, for the bridge's camera topics.

It takes the newest tick whenever a picture is due; ticks that came meanwhile are never drawn, and a picture that was
not read is replaced by the next: nobody waits for it.
"""

import contextlib
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final

from simconsole.processes.byte_slot import ByteSlot
from simconsole.processes.shared_memory import Ring
from simconsole.processes.worker import Worker
from simconsole.profiles.bridge import CameraProfile
from simconsole.session.view.view_job import ViewJob, load_view_job
from simconsole.session.worker_programs import CAMERA, SNAPSHOTS, VIEW_JOB, RoadUsersRing, snapshot_of
from simconsole.values.state_vector import Snapshot
from simconsole.world.traffic.road_users import NOBODY_AT_ALL, RoadUsersAt

LOOK_S: Final = 0.002
NICE: Final = 10
"""The core, and the display of a person who drives, come first."""


DrawCamera = Callable[[Snapshot, RoadUsersAt], bytes]
"""Returns what the camera sees at a tick, as JPEG."""


def drawn_camera(job: ViewJob, profile: CameraProfile) -> DrawCamera:
    """Return what draws a camera's pictures by EGL, without a window.

    Raises:
        WorkerError: this machine has no OpenGL without a window.
    """
    from simconsole.hud.driver_view.motion import shown_vehicle
    from simconsole.hud.driver_view.other_vehicles import at_moment
    from simconsole.hud.gl.camera_picture import CameraPicture
    from simconsole.hud.gl.context import windowless_context

    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
    picture = CameraPicture(windowless_context(), job.scene(), profile)

    def draw(snapshot: Snapshot, users: RoadUsersAt) -> bytes:
        shown = shown_vehicle(snapshot)
        others = at_moment(users, shown.t_s, snapshot.tick_hz)
        return picture.jpeg(shown._replace(others=others, signals=users.signals))

    return draw


class CameraWorker(Worker, frozen=True, kw_only=True):
    """Draws the camera's pictures by EGL, without a window."""

    profile: CameraProfile
    tick_hz: int
    has_traffic: bool = False

    def run(self, folder: Path, stop: Callable[[], bool]) -> None:
        """Draw until `stop`."""
        if sys.platform != "win32":
            with contextlib.suppress(OSError):  # not granted: then as it is
                os.nice(NICE)
        ring, slot = Ring.open(folder / SNAPSHOTS), ByteSlot.open(folder / CAMERA, writable=True)
        users = RoadUsersRing(folder) if self.has_traffic else None
        draw = drawn_camera(load_view_job(folder / VIEW_JOB), self.profile)
        drawn = -1
        while not stop():
            record = ring.latest() if ring.newest else None
            due = -1 if record is None else int(record.stamp * self.profile.rate_hz / self.tick_hz)
            if record is None or due == drawn:
                time.sleep(LOOK_S)
                continue
            drawn = due
            snapshot = snapshot_of(record, self.tick_hz)
            slot.write(snapshot.tick, draw(snapshot, NOBODY_AT_ALL if users is None else users.newest()))
