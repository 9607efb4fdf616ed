"""Cars, a ball and a robot on one plane, without a server: who follows, sees and strikes whom; each replays alone."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.profiles.session import SessionProfile
from simconsole.profiles.validation import convert
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.manifest import read_manifest
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.recording.recorded_road_users import recorded_road_users
from simconsole.session.fleet.fleet_drive import drive_fleet
from simconsole.session.fleet.members import members
from simconsole.session.lifecycle import DriveResult
from simconsole.session.resolution import load_session, resolve
from simconsole.tick.assembly import assemble
from simconsole.values.errors import ProfileError
from simconsole.values.host.jit import compiled
from simconsole.values.signals import Event, Mode

SCRIPT = """schema: 1
points:
  - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 0.5, clutch: 1}
  - {time_s: 0.7, gear: 1}
  - {time_s: 1.0, throttle: 0.35, clutch: 1}
  - {time_s: 3.0, clutch: 0, throttle: 0.35}
"""
SESSION = """schema: 1
scenario:
  vehicle: hatchback
  duration_s: 8
  seat: chaser
  platforms:
    - {name: parked, vehicle: light_van, start: {x_m: 14.0, y_m: 0.3}}
    - {name: chaser, start: {}}
    - {name: ball, vehicle: ball, start: {x_m: 2.0, y_m: 20.0}}
    - {name: robot, vehicle: turtlebot3_burger, start: {x_m: 17.0, y_m: 6.0}}
outputs: {bridge: null, hud: null, scene: null, report: false}
devices: {driver: "script:script.yaml"}
mode: {pacing: free}
"""
PERIOD_TICKS = 5


class Driven:
    def __init__(self, folder: Path) -> None:
        folder.mkdir(exist_ok=True)
        (folder / "script.yaml").write_text(SCRIPT)
        (folder / "session.yaml").write_text(SESSION)
        self.resolved = resolve(load_session(str(folder / "session.yaml")))
        self.result: DriveResult = drive_fleet(self.resolved, folder / "bundle")
        self.folders = {"chaser": folder / "bundle", **{n: folder / "bundle" / n for n in ("parked", "ball", "robot")}}
        self.tables = {name: open_bundle(own).log.table() for name, own in self.folders.items()}
        self.platforms = {name: assemble(part, compiled)[0].platform for name, part in members(self.resolved).items()}

    def column(self, name: str, column: str) -> np.ndarray:
        return self.tables[name].column(column)

    def strike(self) -> int:
        """The place in the tables of the first tick after the touch."""
        return int(np.flatnonzero(self.column("chaser", "impact.first_touch"))[0])


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Driven:
    return Driven(tmp_path_factory.mktemp("cars"))


def test_the_bundle_is_that_of_the_seat_in_which_alone_somebody_sits(driven: Driven) -> None:
    assert driven.result.platforms == ("parked", "ball", "robot")
    assert (driven.column("chaser", "arbitration.mode")[-100:] == Mode.MANUAL).all()
    assert (driven.column("parked", "sample.pedals_age_ticks") > 1000.0).all(), "nobody"
    assert read_manifest(driven.result.folder).ticks == 2000


def test_who_is_ahead_is_followed_by_the_gap_that_was_at_the_end_of_the_period_before(driven: Driven) -> None:
    chaser, parked = (driven.platforms[name] for name in ("chaser", "parked"))
    front = driven.column("chaser", "vehicle.x_m") + chaser.length_m - chaser.rear_overhang_m
    rear = driven.column("parked", "vehicle.x_m") - parked.rear_overhang_m
    begun = np.arange(500, driven.strike(), PERIOD_TICKS)
    told = driven.column("chaser", "ahead.lead_gap_m")
    assert told[begun] == pytest.approx((rear - front)[begun - 1], abs=0.02), "their headings differ by little"
    assert (told[begun] == told[begun + PERIOD_TICKS - 1]).all(), "the same throughout a period"
    assert (driven.column("parked", "ahead.lead_gap_m") > 100.0).all(), "nobody is before it"


def test_a_collision_pushes_both_at_one_moment_by_what_it_takes_from_the_other(driven: Driven) -> None:
    at = driven.strike()
    assert driven.column("parked", "impact.first_touch")[at] == 1.0
    momentum = []
    for name in ("chaser", "parked"):
        solid = driven.platforms[name].solid
        assert solid is not None
        assert int(driven.column(name, "events.events")[at]) & Event.COLLISION
        yaw = driven.column(name, "vehicle.yaw_rad")[at - 1]
        along, aside = (driven.column(name, f"impact.{axis}_mps")[at] for axis in ("vx", "vy"))
        east, north = along * np.cos(yaw) - aside * np.sin(yaw), along * np.sin(yaw) + aside * np.cos(yaw)
        momentum.append((solid.mass_kg * east, solid.mass_kg * north))
    assert momentum[0][0] < -1000.0, "N s"
    assert np.sum(momentum, axis=0) == pytest.approx((0.0, 0.0), abs=1e-6)
    assert driven.column("parked", "vehicle.vx_mps")[at + PERIOD_TICKS] > 0.3


def test_all_others_are_a_stream_of_road_users(driven: Driven) -> None:
    last = list(recorded_road_users(open_bundle(driven.folders["ball"]).log))[-1]
    assert last.users[:, 0].tolist() == [0.0, 1.0, 3.0]
    place = last.tick - 1
    for number, name in enumerate(("chaser", "parked")):
        platform = driven.platforms[name]
        x, y, yaw = (driven.column(name, f"vehicle.{axis}")[place] for axis in ("x_m", "y_m", "yaw_rad"))
        ahead_m = 0.5 * platform.length_m - platform.rear_overhang_m
        told = last.users[number, [2, 3, 4, 6, 7]]
        there = (x + ahead_m * np.cos(yaw), y + ahead_m * np.sin(yaw), yaw, platform.length_m, platform.width_m)
        assert told == pytest.approx(there, abs=1e-9)


def test_a_robot_is_told_of_the_circle_of_a_car_that_is_next_to_it(driven: Driven) -> None:
    van = driven.platforms["parked"]
    front_m = 14.0 + van.length_m - van.rear_overhang_m - 0.5 * van.width_m
    told = [driven.column("robot", f"others.{axis}_1_m")[0] for axis in ("x", "y", "radius")]
    assert told == pytest.approx((min(17.0, front_m), 0.3, 0.5 * van.width_m))
    assert not any(column.startswith("others.") for column in driven.tables["chaser"].columns)


def test_each_chain_replays_alone(driven: Driven) -> None:
    for folder in driven.folders.values():
        found = replay_bundle(folder)
        assert found.hashes_equal, found.differences
    assert verify(driven.result.folder) == []


def test_two_drives_are_equal(driven: Driven, tmp_path: Path) -> None:
    again = Driven(tmp_path / "again")
    digests = [[read_manifest(folder).digest for folder in one.folders.values()] for one in (driven, again)]
    assert digests[0] == digests[1]
    assert len(set(digests[0])) == 4


def test_a_seat_is_in_a_platform() -> None:
    plain: dict[str, Any] = {"schema": 1, "scenario": {"platforms": [{"name": "a"}], "seat": "b"}}
    with pytest.raises(ProfileError, match="seat: value b: the name of a platform, of a"):
        convert(plain, SessionProfile, "test")
