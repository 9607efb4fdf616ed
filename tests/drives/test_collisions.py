"""A car that nobody holds back drives into a vehicle that stands on its lane."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.evaluation.metrics.rule_metrics import plain_events
from simconsole.evaluation.metrics.table import recorded_drive
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.recorded_road_users import recorded_road_users
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, resolve
from simconsole.values.signals import Event
from tests.world.nets import STRAIGHT

SCRIPT = """schema: 1
points:
  - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 1.0, clutch: 1}
  - {time_s: 1.2, gear: 1, throttle: 0.0}
  - {time_s: 1.8, throttle: 0.35, clutch: 1}
  - {time_s: 4.0, clutch: 0}
  - {time_s: 6.4, throttle: 0.35, clutch: 0}
  - {time_s: 6.6, throttle: 0.0, clutch: 1}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("collision")
    (path / "map.net.xml").write_text(STRAIGHT)
    (path / "script.yaml").write_text(SCRIPT)
    (path / "world.yaml").write_text(
        "schema: 1\nkind: roads\ntitle: one road\nmap: {name: map.net.xml}\nroute: {by: edges, edges: [AB, BC]}\n"
    )
    (path / "session.yaml").write_text(
        "schema: 1\nenvironment: {world: world.yaml, traffic: {vehicles: 0, parked: 0, lead: {gap_m: 18, "
        "speeds: [{speed_kmh: 0}]}}}\nscenario: {vehicle: hatchback, duration_s: 16}\n"
        f"devices: {{driver: 'script:{path / 'script.yaml'}'}}\nmode: {{pacing: free}}\n"
        "outputs: {hud: null, scene: null, report: false, bridge: null}\n"
    )
    return drive(resolve(load_session(str(path / "session.yaml"))), path / "bundle").folder


def test_collision_takes_speed_at_once_and_is_one_event(folder: Path) -> None:
    table = open_bundle(folder).log.table(
        ("events.events", "vehicle.vx_mps", "impact.first_touch", "impact.vx_mps", "rules.collision")
    )
    events, speed, first, change, told = (table.column(name) for name in table.columns)
    (at,) = np.flatnonzero(events.astype(int) & int(Event.COLLISION)).tolist()
    assert np.flatnonzero(first).tolist() == [at]
    assert speed[at - 1] > 2.0
    print(f"measured: {speed[at - 1]:.2f} m/s before, {speed[at]:.2f} m/s after")
    assert speed[at] - speed[at - 1] == pytest.approx(change[at], abs=0.05)
    assert 0.35 < speed[at] / speed[at - 1] < 0.55, "two cars of about one weight share the speed"
    assert told[at : at + 100].all()
    assert not told[at - 1]


def test_who_is_struck_rolls_on_and_comes_to_rest(folder: Path) -> None:
    speeds = [float(at.users[0, 5]) for at in recorded_road_users(open_bundle(folder).log)]
    assert max(speeds) > 0.9
    assert speeds[-1] == 0.0


def test_report_and_replay_know_of_it(folder: Path) -> None:
    bundle = open_bundle(folder)
    assert [event["rule"] for event in plain_events(recorded_drive(bundle.log))] == ["collision"]
    assert replay_bundle(folder).hashes_equal


HOUSE_M = 25.0  # its front


@pytest.fixture(scope="module")
def against_house(folder: Path) -> Path:
    path = folder.parent
    house = f"{HOUSE_M},-9 40,-9 40,9 {HOUSE_M},9"
    (path / "map.poly.xml").write_text(f'<additional><poly id="h" type="building.house" shape="{house}"/></additional>')
    world = (path / "world.yaml").read_text().replace("title: one", "polygons: {name: map.poly.xml}\ntitle: walled")
    (path / "walled.yaml").write_text(world)
    session = (path / "session.yaml").read_text()
    start, end = session.index("{world"), session.index("\nscenario")
    (path / "walled_session.yaml").write_text(f"{session[:start]}{{world: walled.yaml}}{session[end:]}")
    return drive(resolve(load_session(str(path / "walled_session.yaml"))), path / "walled").folder


def test_a_house_turns_the_car_back_and_is_one_event(against_house: Path) -> None:
    names = ("events.events", "vehicle.vx_mps", "vehicle.x_m", "obstacle.touches", "obstacle.vx_mps", "rules.collision")
    table = open_bundle(against_house).log.table(names)
    events, speed, place, touches, change, told = (table.column(name) for name in names)
    at = int(np.flatnonzero(touches)[0])
    assert np.flatnonzero(told)[0] == at, "shown at once"
    assert np.flatnonzero(events.astype(int) & int(Event.COLLISION)).tolist() == [at + 1], "one event, in the next tick"
    assert speed[at - 1] > 2.0
    print(f"measured: {speed[at - 1]:.2f} m/s before, {speed[at]:.2f} m/s after")
    assert change[at] == pytest.approx(-1.1 * speed[at - 1], rel=0.02)
    assert speed[at] == pytest.approx(-0.1 * speed[at - 1], abs=0.1)
    front = place + (HOUSE_M - place[at - 1])
    assert front.max() < HOUSE_M + 0.05
    assert told[at : at + 100].all()


def test_report_and_replay_know_of_the_house(against_house: Path) -> None:
    assert [event["rule"] for event in plain_events(recorded_drive(open_bundle(against_house).log))] == ["collision"]
    assert replay_bundle(against_house).hashes_equal


def test_ticks_one_by_one_strike_the_house_alike(against_house: Path) -> None:
    session = resolve(load_session(str(against_house.parent / "walled_session.yaml")))
    alone = drive(session, against_house.parent / "alone", watch=lambda snapshot: False)
    assert alone.digest == open_bundle(against_house).manifest.digest
