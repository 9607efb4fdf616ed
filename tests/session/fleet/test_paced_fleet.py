"""Several platforms by the clock: two persons at wheels of their own, and robots that a ROS program drives."""

import os
import signal
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from simconsole.devices.force_feedback.motor import Capability
from simconsole.devices.haptics import back_ends
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.profiles.session import SessionProfile
from simconsole.profiles.validation import convert
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.manifest import read_manifest
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.session.fleet.fleet_drive import drive_fleet
from simconsole.session.resolution import resolve
from simconsole.session.worker_programs import LATENCY
from simconsole.values.signals import Mode
from simconsole.values.state_vector import Snapshot
from tests.ports import free_port
from tests.session.fleet.fleet_client import FleetClient
from tests.session.fleet.test_fleet_drive import session_of

WINDOW = {"width_px": 320, "height_px": 240, "rate_hz": 10}
MOST_S = 120.0
"""Ends a drive that would never end; each ends itself long before."""
WHEELS = {"a": "t500rs_th8rs", "b": "g29"}


def two_cars() -> SessionProfile:
    """Two persons, each with a wheel and a window."""
    plain: dict[str, Any] = {
        "schema": 1,
        "environment": {"world": "urban"},
        "scenario": {
            "duration_s": MOST_S,
            "platforms": [
                {"name": "a"},
                {"name": "b", "driver": "sdl", "cockpit": WHEELS["b"], "hud": {**WINDOW, "language": "german"}},
            ],
        },
        "outputs": {"hud": WINDOW, "scene": None, "sound": None, "report": False},
        "devices": {"driver": "sdl", "cockpit": WHEELS["a"]},
    }
    return convert(plain, SessionProfile, "test")


class Motor:
    """A wheel's motor that notes its levels."""

    capability = Capability("noted", constant=True)

    def __init__(self) -> None:
        self.levels: list[float] = []

    def write(self, level: float) -> None:
        self.levels.append(level)

    def start(self) -> None:
        """Nothing."""

    def stop(self) -> None:
        """Nothing."""

    def close(self) -> None:
        """Nothing."""


class TwoPersons:
    """A drive in which each turns the wheel to a side of their own until both windows have shown it."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.bundle = folder / "bundle"
        self.motors: dict[int, Motor] = {}
        monkeypatch.setattr(back_ends, "open_motor", self._open_motor)
        self.cockpits = {name: VirtualCockpit(load("devices", WHEELS[name], CockpitProfile)) for name in WHEELS}
        try:
            self.result = drive_fleet(resolve(two_cars()), self.bundle, show=self._show)
        finally:
            for cockpit in self.cockpits.values():
                cockpit.close()
        self.tables = {"a": open_bundle(self.bundle).log.table(), "b": open_bundle(self.bundle / "b").log.table()}

    def _open_motor(self, number: int, identity: tuple[int, int], force: Any) -> Motor:
        return self.motors.setdefault(identity[0], Motor())

    def _show(self, first: Snapshot) -> None:
        if first.tick == 50:
            for name, turned in (("a", 0.2), ("b", -0.3)):
                centred = first.sample._replace(wheel_axis=turned, throttle_axis=1.0, brake_axis=1.0, clutch_axis=1.0)
                self.cockpits[name].write(centred._replace(wheel_buttons=0.0, shifter_buttons=0.0))
        if first.tick > 150 and first.tick % 25 == 0 and len(list(self._shown())) == 2:
            os.kill(os.getpid(), signal.SIGINT)

    def _shown(self) -> Iterator[Path]:
        """What the windows have noted of the states that reached them."""
        return Path("/dev/shm").glob(f"simconsole-{os.getpid()}-*/{LATENCY}.hud.json")


def test_two_persons_drive_by_the_clock_each_with_wheel_motor_and_window(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    driven = TwoPersons(tmp_path, monkeypatch)
    assert driven.result.interrupted, "both windows have drawn"
    assert driven.result.summary["real_time_factor"] < 1.05
    a, b = driven.tables.values()
    assert len(a) == len(b)
    assert a.column("sample.wheel_axis")[150] == pytest.approx(0.2, abs=1e-3)
    assert b.column("sample.wheel_axis")[150] == pytest.approx(-0.3, abs=1e-3)
    assert a.column("driver.hand_wheel_rad")[150] * b.column("driver.hand_wheel_rad")[150] < 0.0
    levels = [motor.levels for motor in driven.motors.values()]
    assert [any(level for level in each) for each in levels] == [True, True], "each motor turns its own wheel back"
    for name, folder in (("a", driven.bundle), ("b", driven.bundle / "b")):
        manifest = read_manifest(folder)
        assert manifest.summary["worker_restarts"] == {"hud": 0}, name
        assert [one.usb_id for one in manifest.provenance.devices] != []
        assert replay_bundle(folder).hashes_equal
    assert verify(driven.bundle) == []


def test_a_program_drives_robots_by_the_clock_over_one_server(tmp_path: Path) -> None:
    port = free_port()
    plain = {"mode": {"tick_hz": 100, "pacing": "realtime", "control_period_ms": 20}}
    session = session_of(port, MOST_S, **plain)
    client = FleetClient(f"ws://127.0.0.1:{port}", [(0.1, 0.0), (0.0, 0.0), (0.0, 1.0)])
    thread = threading.Thread(target=client.run)

    def show(first: Snapshot) -> None:
        if first.tick % 10 == 0 and first.vehicle.x_m > 0.65:
            os.kill(os.getpid(), signal.SIGINT)

    thread.start()
    result = drive_fleet(resolve(session), tmp_path / "bundle", show=show)
    thread.join()
    assert result.interrupted, "it has driven 5 cm"
    for name, folder in zip(("tb3_1", "tb3_2"), (tmp_path / "bundle" / name for name in result.platforms), strict=True):
        table = open_bundle(folder).log.table()
        assert Mode.AUTONOMOUS in table.column("arbitration.mode"), name
        assert (table.column("ros.refused") == 0.0).all()
        assert replay_bundle(folder).hashes_equal
    turned = open_bundle(tmp_path / "bundle" / "tb3_2").log.table().column("vehicle.yaw_rad")
    assert abs(turned).max() > 0.1
    assert client.heard["/clock"] > 10
    assert replay_bundle(tmp_path / "bundle").hashes_equal
