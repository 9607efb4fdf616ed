"""The worker that lets the driver hear the drive."""

import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final

from simconsole.canbus.messages import wheel_columns
from simconsole.hud.driver_view.other_vehicles import at_moment
from simconsole.hud.sound.heard import Heard, Listener, SoundSettings
from simconsole.hud.sound.passing import audible
from simconsole.processes.shared_memory import Ring
from simconsole.processes.worker import Worker
from simconsole.profiles.vehicle import CarProfile
from simconsole.profiles.view import SoundProfile
from simconsole.session.worker_programs import SNAPSHOTS, RoadUsersRing, snapshot_of
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import WorkerError
from simconsole.values.units import NS_PER_S
from simconsole.world.traffic.road_users import RoadUser

STALE_S: Final = 0.5
"""Older ticks are not heard: a drive that stands still must not drone on."""
LOOK_S: Final = 0.2
EAR_SHARE: Final = 0.5
"""Where the driver's ears are, of the way from the rear axle to the front axle."""


def sound_settings(resolved: ResolvedSession, console: Console) -> SoundSettings:
    """Return what one must know of a session's vehicle to hear it."""
    profile, wheelbase_m = resolved.vehicle, console.platform.wheelbase_m
    if not isinstance(profile, CarProfile):
        return SoundSettings(cylinders=0, wheelbase_m=wheelbase_m)
    return SoundSettings(
        cylinders=profile.engine.cylinders,
        wheelbase_m=wheelbase_m,
        wheel_radius_m=profile.front.wheel_radius_m,
        wheels=wheel_columns(console.columns),
    )


class SoundWorker(Worker, frozen=True, kw_only=True):
    """Plays the drive on the driver's loudspeakers."""

    profile: SoundProfile
    settings: SoundSettings
    tick_hz: int
    has_traffic: bool = False

    def run(self, folder: Path, stop: Callable[[], bool]) -> None:
        """Play until `stop`; without a sound device say so once and wait for it."""
        from simconsole.hud.audio.player import play
        from simconsole.hud.audio.speakers import Speakers
        from simconsole.hud.sound.mix import Mixer

        try:
            speakers = Speakers(self.profile)
        except WorkerError as problem:
            print(f"{problem}; the drive goes on without sound", file=sys.stderr, flush=True)
            while not stop():
                time.sleep(LOOK_S)
            return
        try:
            play(self._ear(folder), Mixer(self.settings.cylinders, self.profile), speakers, stop, time.sleep)
        finally:
            speakers.close()

    def _ear(self, folder: Path) -> Callable[[], Heard]:
        ring = Ring.open(folder / SNAPSHOTS)
        road_users = RoadUsersRing(folder) if self.has_traffic else None
        listener = Listener(self.settings)
        ear_x_m = EAR_SHARE * self.settings.wheelbase_m

        def heard() -> Heard:
            record = ring.latest()
            if record is None or time.monotonic_ns() - record.second_stamp > STALE_S * NS_PER_S:
                return Heard()
            snapshot = snapshot_of(record, self.tick_hz)
            others: tuple[RoadUser, ...] = ()
            if road_users is not None:
                others = at_moment(road_users.newest(), snapshot.t_s, self.tick_hz)
            return listener(snapshot, audible(snapshot, others, ear_x_m))

        return heard
