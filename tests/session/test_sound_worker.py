"""A drive is heard on six loudspeakers of a device that is a file, and goes on where there is no device."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from simconsole.hud.sound.directions import BACK_LEFT, BACK_RIGHT, FRONT_LEFT
from simconsole.hud.sound.heard import Heard, SoundSettings
from simconsole.hud.sound.loops import RATE_HZ
from simconsole.processes.shared_memory import Ring
from simconsole.profiles.view import SoundProfile
from simconsole.session.resolution import load_session, resolve
from simconsole.session.sound_worker import SoundWorker, sound_settings
from simconsole.session.worker_programs import ROAD_USERS, ROAD_USERS_CAPACITY, SNAPSHOT_CAPACITY, SNAPSHOTS
from simconsole.tick.assembly import assemble
from simconsole.values.host.jit import plain
from simconsole.values.state_vector import PLATFORM_AT, Snapshot
from simconsole.world.traffic.road_users import RECORD_WIDTH, RoadUser, RoadUserKind, table, to_record
from tests.hud.test_view import TICK_HZ, snapshot
from tests.patience import stamp_ns

RPM = 2_400.0
SETTINGS = SoundSettings(cylinders=4, wheelbase_m=2.6)


def driving() -> Snapshot:
    return snapshot(vehicle__engine_radps=RPM * math.pi / 30.0, vehicle__engine_running=1.0, command__throttle=0.7)


def run_folder(folder: Path, shown: Snapshot, *users: RoadUser) -> Ring:
    ring = Ring.create(folder / SNAPSHOTS, PLATFORM_AT, SNAPSHOT_CAPACITY)
    ring.write(shown.vector[:PLATFORM_AT], shown.tick, stamp_ns())
    others = Ring.create(folder / ROAD_USERS, RECORD_WIDTH, ROAD_USERS_CAPACITY)
    others.write(to_record(table(users)), shown.tick)
    return ring


def ear(folder: Path) -> Callable[[], Heard]:
    return SoundWorker(profile=SoundProfile(), settings=SETTINGS, tick_hz=TICK_HZ, has_traffic=True)._ear(folder)


def test_the_engines_tone_is_in_what_the_loudspeakers_played(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "sound.raw"
    monkeypatch.setenv("SDL_AUDIODRIVER", "disk")
    monkeypatch.setenv("SDL_DISKAUDIOFILE", str(path))
    ring, shown = run_folder(tmp_path, driving()), driving()
    looks = 0

    def stop() -> bool:
        nonlocal looks
        looks += 1
        ring.write(shown.vector[:PLATFORM_AT], shown.tick + looks, stamp_ns())
        return path.exists() and path.stat().st_size > 3 * RATE_HZ * 12

    SoundWorker(profile=SoundProfile(), settings=SETTINGS, tick_hz=TICK_HZ).run(tmp_path, stop)
    sound = np.frombuffer(path.read_bytes()[: 12 * (path.stat().st_size // 12)], "<i2").reshape(-1, 6)
    for channel in (FRONT_LEFT, BACK_LEFT, BACK_RIGHT):
        column = sound[sound[:, channel] != 0, channel][-RATE_HZ:]
        spectrum = np.abs(np.fft.rfft(column * np.hanning(len(column))))
        assert spectrum.argmax() * RATE_HZ / len(column) == pytest.approx(RPM / 60.0 * 2.0, rel=0.01)


def test_without_a_device_it_is_said_once_and_the_worker_stays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("SDL_AUDIODRIVER", "dummy")
    monkeypatch.setattr("simconsole.session.sound_worker.LOOK_S", 0.0)
    looks = iter((False, False, False, True))
    worker = SoundWorker(profile=SoundProfile(device="gone"), settings=SETTINGS, tick_hz=TICK_HZ)
    worker.run(tmp_path, lambda: next(looks))
    assert next(looks, None) is None
    said = capfd.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1
    assert said.err.startswith("sound: no device 'gone': ")
    assert said.err.endswith("; the drive goes on without sound\n")


def test_others_are_heard_from_where_they_are(tmp_path: Path) -> None:
    user = RoadUser(
        id=3.0,
        kind=RoadUserKind.CAR,
        x_m=0.5 * SETTINGS.wheelbase_m,
        y_m=6.0,
        yaw_rad=0.0,
        speed_mps=0.0,
        length_m=4.4,
        width_m=1.8,
        height_m=1.5,
    )
    run_folder(tmp_path, driving(), user)
    (other,) = ear(tmp_path)().others
    assert (other.id, other.distance_m) == (3.0, 6.0)
    assert other.bearing_rad == pytest.approx(math.pi / 2.0)


def test_a_drive_that_stands_still_does_not_drone_on(tmp_path: Path) -> None:
    ring = run_folder(tmp_path, driving())
    assert ear(tmp_path)().engine_radps > 0.0
    ring.write(driving().vector[:PLATFORM_AT], 1, stamp_ns() - 600_000_000)
    assert ear(tmp_path)() == Heard()


@pytest.mark.parametrize(("session", "cylinders"), [("demo", 4), ("roll_a_ball", 0)])
def test_what_is_heard_of_a_vehicle_is_its_own(session: str, cylinders: int) -> None:
    resolved = resolve(load_session(session))
    settings = sound_settings(resolved, assemble(resolved, plain)[0])
    assert settings.cylinders == cylinders
    assert (settings.wheels is None) == (cylinders == 0)
    if settings.wheels is not None:
        columns = assemble(resolved, plain)[0].columns
        assert [columns[at] for at in settings.wheels] == [f"platform.{at}_radps" for at in ("fl", "fr", "rl", "rr")]
