"""The autopilot and the simulated person keep behind a vehicle that drives by a script, and run into nobody."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, resolve
from simconsole.values.signals import Event, Mode
from tests.drives.random_courses import ASKS, SCRIPT
from tests.world.nets import TOWN, generated

LEAD = "{gap_m: 20, speeds: [{speed_kmh: 25}, {from_s: 7, speed_kmh: 0}, {from_s: 18, speed_kmh: 20}]}"
BY_ROS = (
    "features: {autopilot: world.yaml}\nmode: {pacing: lockstep, answer_timeout_s: 60}\n"
    f"devices: {{driver: '{ASKS}'}}\n"
)
BY_HAND = "devices: {driver: virtual, person: {sit_s: 0.5, along: route}}\nmode: {pacing: free}\n"
LINK = "{seed: 3, delay_ms: 40, localisation: {position_noise_m: 0.02, yaw_noise_deg: 0.2}}"


@pytest.mark.parametrize("driver", ["autopilot", "person"])
def test_behind_a_vehicle_that_stops_and_drives_on(driver: str, tmp_path: Path) -> None:
    (tmp_path / "map.net.xml").write_bytes(generated(*TOWN))
    (tmp_path / "world.yaml").write_text(
        "schema: 1\nkind: roads\ntitle: follow\nmap: {name: map.net.xml}\nroute: {by: random, seed: 3, length_m: 250}\n"
    )
    (tmp_path / "asks.yaml").write_text(SCRIPT)
    bridge = f"{{port: 0, link: {LINK}}}" if driver == "autopilot" else "null"
    (tmp_path / "session.yaml").write_text(
        f"schema: 1\nenvironment: {{world: world.yaml, traffic: {{vehicles: 0, parked: 0, lead: {LEAD}}}}}\n"
        "scenario: {vehicle: hatchback, duration_s: 24}\n"
        f"outputs: {{hud: null, scene: null, report: false, bridge: {bridge}}}\n"
        f"{BY_ROS if driver == 'autopilot' else BY_HAND}"
    )
    folder = drive(resolve(load_session(str(tmp_path / "session.yaml"))), tmp_path / "bundle").folder
    names = ("situation.lead_gap_m", "situation.lead_speed_mps", "vehicle.vx_mps")
    table = open_bundle(folder).log.table((*names, "events.events", "arbitration.mode", "ros.accel_mps2"))
    gap, lead, speed = (table.column(name) for name in names)
    assert not (table.column("events.events").astype(int) & int(Event.COLLISION)).any()
    assert gap.min() > 1.5
    stood = (lead < 0.01) & (speed < 0.02) & (np.maximum.accumulate(speed) > 1.0)
    print(f"measured: {driver}: gap at least {gap.min():.2f} m, behind a vehicle that stands {gap[stood].max():.2f} m")
    assert stood.any(), "it stops behind"
    assert gap[stood].max() < 8.0
    after = np.flatnonzero(stood)[-1]
    assert speed[after:].max() > 3.0, "and drives on"
    if driver == "autopilot":
        assert table.column("arbitration.mode")[-1] == Mode.AUTONOMOUS
        assert table.column("ros.accel_mps2").min() > -3.0
    assert replay_bundle(folder).hashes_equal
