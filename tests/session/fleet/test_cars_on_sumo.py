"""Several platforms of ours in one SUMO: each sees SUMO's road users and the others, once; each replays alone."""

import os
import signal
import sys
from pathlib import Path

import numpy as np
import pytest

from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.manifest import read_manifest
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.recording.log_header import SIGNALS
from simconsole.recording.recorded_road_users import recorded_road_users
from simconsole.session.fleet.fleet_drive import drive_fleet
from simconsole.session.fleet.members import members
from simconsole.session.resolution import load_session, resolve
from simconsole.tick.assembly import assemble
from simconsole.values.errors import ProfileError
from simconsole.values.host.jit import compiled
from simconsole.values.state_vector import Snapshot
from simconsole.world.traffic.road_users import RoadUsersAt

SCRIPT = """schema: 1
points:
  - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 0.5, clutch: 1}
  - {time_s: 0.7, gear: 1}
  - {time_s: 1.0, throttle: 0.5, clutch: 1}
  - {time_s: 2.2, clutch: 0, throttle: 0.5}
"""
SESSION = """schema: 1
environment: {world: urban_signals, traffic: {seed: 3, period_ms: PERIOD, sumo: {vehicles: 40, pedestrians: 5, MORE}}}
scenario:
  vehicle: hatchback
  duration_s: DURATION
  platforms:
    - {name: driven}
    - {name: parked, vehicle: light_van, start: {x_m: 40.0}}
    - {name: ball, vehicle: ball, start: {x_m: 120.0}}
outputs: {bridge: null, hud: null, scene: null, report: false}
devices: {driver: "script:script.yaml"}
mode: {pacing: free}
"""
PERIOD_TICKS = 10


class Driven:
    def __init__(self, folder: Path, more: str = "radius_m: 800", duration_s: float = 4.0, period_ms: int = 40) -> None:
        folder.mkdir(exist_ok=True)
        text = SESSION.replace("MORE", more).replace("DURATION", str(duration_s)).replace("PERIOD", str(period_ms))
        (folder / "script.yaml").write_text(SCRIPT)
        (folder / "session.yaml").write_text(text)
        self.resolved = resolve(load_session(str(folder / "session.yaml")))
        self.bundle = folder / "bundle"

    def drive(self, killed_at_s: float = 1e9) -> "Driven":
        """Drive; SUMO's process is killed then."""
        killed = list[int]()

        def show(snapshot: Snapshot) -> None:
            if snapshot.t_s >= killed_at_s and not killed:
                killed.append(own_sumo())
                os.kill(killed[0], signal.SIGKILL)

        drive_fleet(self.resolved, self.bundle, show=show)
        return self

    def folders(self) -> list[Path]:
        return [self.bundle, self.bundle / "parked", self.bundle / "ball"]

    def digests(self) -> list[str]:
        return [read_manifest(folder).digest for folder in self.folders()]


def own_sumo() -> int:
    """The program SUMO that this process has started."""
    processes = [int(one) for one in Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()]
    (found,) = [one for one in processes if b"--remote-port" in Path(f"/proc/{one}/cmdline").read_bytes()]
    return found


def steps(folder: Path) -> list[RoadUsersAt]:
    return list(recorded_road_users(open_bundle(folder).log))


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Driven:
    return Driven(tmp_path_factory.mktemp("on_sumo")).drive()


def test_each_sees_the_other_platforms_once_and_the_same_road_users_of_sumos(driven: Driven) -> None:
    recorded = [steps(folder) for folder in driven.folders()]
    tables = [open_bundle(folder).log.table() for folder in driven.folders()]
    platforms = [assemble(part, compiled)[0].platform for part in members(driven.resolved).values()]
    assert {len(some) for some in recorded} == {100}, (
        "at the begin, and each 40 ms; the last one is of the tick that never came"
    )
    for of_all in zip(*recorded, strict=True):
        for number, (at, platform, table) in enumerate(zip(of_all, platforms, tables, strict=True)):
            others = {float(one) for one in range(3)} - {float(number)}
            ids = at.users[:, 0]
            assert set(ids[ids < 3.0]) == others
            assert len(set(ids)) == len(ids)
            if at.tick:
                place = [table.column(f"vehicle.{name}")[at.tick - 1] for name in ("x_m", "y_m", "yaw_rad")]
                ahead_m = 0.5 * platform.length_m - platform.rear_overhang_m
                middle = place[0] + ahead_m * np.cos(place[2]), place[1] + ahead_m * np.sin(place[2])
                away_m = np.hypot(at.users[:, 2] - middle[0], at.users[:, 3] - middle[1])
                as_long = np.abs(at.users[:, 6] - platform.length_m) < 0.01
                assert not (as_long & (away_m < 1.0)).any(), "nobody is where it is itself, in its size"
        known = {row[0]: row.tolist() for row in of_all[0].users}
        assert all(
            known[row[0]] == row.tolist() for at in of_all for row in at.users if row[0] >= 3 and row[0] in known
        )
        assert len(of_all[0].users) > 10
    moved = np.hypot(*(tables[0].column(f"vehicle.{axis}")[-1] - tables[0].column(f"vehicle.{axis}")[0]
                       for axis in ("x_m", "y_m")))  # fmt: skip
    assert moved > 1.0


def test_each_goes_by_sumos_signals_and_is_exactly_where_it_is(driven: Driven) -> None:
    for folder in driven.folders():
        summary = read_manifest(folder).summary["traffic"]
        assert summary["ego_error_m"] == 0.0
        assert "lost" not in summary
        assert list(open_bundle(folder).log.messages(SIGNALS))
        assert (open_bundle(folder).log.table().column("ahead.approach") != 0.0).all(), "never the map's own programs"


def test_each_chain_replays_alone_without_sumo(driven: Driven, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("libsumo", "traci"):
        monkeypatch.setitem(sys.modules, name, None)
    for folder in driven.folders():
        found = replay_bundle(folder)
        assert found.hashes_equal, found.differences
    assert verify(driven.bundle) == []


def test_equal_drives_through_both_back_ends(driven: Driven, tmp_path: Path) -> None:
    other = Driven(tmp_path / "traci", "radius_m: 800, backend: traci").drive()
    assert other.digests() == driven.digests()
    assert len(set(other.digests())) == 3


def test_all_drive_on_without_a_sumo_that_is_gone_and_see_each_other(tmp_path: Path) -> None:
    killed = Driven(tmp_path / "killed", "radius_m: 800, backend: traci, timeout_s: 2", 2.0).drive(killed_at_s=1.0)
    for number, folder in enumerate(killed.folders()):
        lost = open_bundle(folder).log.table().column("ahead.traffic_lost")
        first = int(np.flatnonzero(lost)[0])
        assert 250 <= first <= 250 + PERIOD_TICKS + 1
        assert lost[first:].all()
        some = steps(folder)
        assert len(some[0].users) > 10
        assert set(some[-1].users[:, 0]) == {float(one) for one in range(3)} - {float(number)}
        assert read_manifest(folder).summary["traffic"]["lost"]
        assert replay_bundle(folder).hashes_equal


def test_a_period_of_sumos_is_a_whole_number_of_control_periods(tmp_path: Path) -> None:
    with pytest.raises(ProfileError, match=r"period_ms: value 52: of several platforms a whole number of control"):
        Driven(tmp_path, period_ms=52).drive()
    assert not (tmp_path / "bundle").exists()
