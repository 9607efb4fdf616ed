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
from simconsole.session.worker_programs import CAMERA, SNAPSHOTS, VIEW_JOB, RoadUsersRing, snapshot_of

LOOK_S: Final = 0.002
NICE: Final = 10
"""The core, and the display of a person who drives, come first."""


class CameraWorker(Worker, frozen=True, kw_only=True):
    """Draws the camera's pictures by EGL, without a window."""

    profile: CameraProfile
    tick_hz: int
    has_traffic: bool = False

    def run(self, folder: Path, stop: Callable[[], bool]) -> None:
        """Draw until `stop`."""
        from simconsole.hud.driver_view.motion import shown_vehicle
        from simconsole.hud.driver_view.other_vehicles import at_moment
        from simconsole.hud.driver_view.scene import view_scene
        from simconsole.hud.gl.camera_picture import CameraPicture
        from simconsole.hud.gl.context import windowless_context
        from simconsole.session.view_job import load_view_job

        if sys.platform != "win32":
            with contextlib.suppress(OSError):  # not granted: then as it is
                os.nice(NICE)
        os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
        ring, slot = Ring.open(folder / SNAPSHOTS), ByteSlot.open(folder / CAMERA, writable=True)
        users = RoadUsersRing(folder) if self.has_traffic else None
        job = load_view_job(folder / VIEW_JOB)
        picture = CameraPicture(windowless_context(), view_scene(job.drawing, job.limit_kmh, job.size), self.profile)
        drawn = -1
        while not stop():
            record = ring.latest() if ring.newest else None
            due = -1 if record is None else int(record.stamp * self.profile.rate_hz / self.tick_hz)
            if record is None or due == drawn:
                time.sleep(LOOK_S)
                continue
            drawn = due
            snapshot = snapshot_of(record, self.tick_hz)
            shown = shown_vehicle(snapshot)
            if users is not None:
                shown = shown._replace(others=at_moment(users.newest(), shown.t_s, self.tick_hz))
            slot.write(snapshot.tick, picture.jpeg(shown))
