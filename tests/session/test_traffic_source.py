"""Traffic in a drive: recorded as an input, equal for equal seeds, read again and not simulated in a replay."""

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from simconsole.evaluation.video.moments import moments
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.pack import pack
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.bundles.verification import verify
from simconsole.recording.recorded_road_users import recorded_road_users
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, override, resolve
from simconsole.session.traffic_source import TrafficSource, ego_box, open_traffic
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.values.errors import ProfileError
from simconsole.values.host.jit import compiled
from simconsole.values.signals import FAR
from simconsole.values.state_vector import Snapshot
from simconsole.world.kinds.worlds import open_world
from simconsole.world.traffic import traffic as modelled
from simconsole.world.traffic.leader import Leaders
from simconsole.world.traffic.road_users import Box, table, users
from tests.paths import ROOT
from tests.scene.viewer.test_export import contents

PERIOD_TICKS = 4  # 40 ms at 100 Hz


def session(seed: int = 1, **changes: object) -> ResolvedSession:
    """The ball at the beginning of the urban course with signals, among twelve vehicles, for four seconds."""
    world = {"world": "urban_signals", "traffic": {"vehicles": 12, "parked": 3, "seed": seed}, **changes}
    return resolve(
        override(
            load_session("roll_a_ball"),
            environment=world,
            scenario={"duration_s": 4.0, "start": None},
            features={"autopilot": None},
            outputs={"bridge": None, "hud": None, "scene": None, "report": False},
            mode={"pacing": "free"},
        )
    )


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return drive(session(), tmp_path_factory.mktemp("drives") / "first").folder


def test_every_step_lies_in_the_tick_that_could_know_of_it(driven: Path) -> None:
    bundle = open_bundle(driven)
    ticks = [at.tick for at in recorded_road_users(bundle.log)]
    assert ticks == list(range(0, bundle.manifest.ticks, PERIOD_TICKS))
    assert all(len(at.users) == 15 for at in recorded_road_users(bundle.log))
    assert verify(driven) == []


def test_equal_seeds_give_equal_logs_and_others_do_not(driven: Path, tmp_path: Path) -> None:
    again, other = drive(session(), tmp_path / "again").folder, drive(session(2), tmp_path / "other").folder
    assert (driven / "drive.log").read_bytes() == (again / "drive.log").read_bytes()
    tables = [[at.users.tobytes() for at in recorded_road_users(open_bundle(one).log)] for one in (driven, other)]
    assert tables[0] != tables[1]


def test_whom_the_vehicle_follows_is_an_input_from_the_tick_after_each_step_on(tmp_path: Path) -> None:
    lead = {"gap_m": 12.0, "speeds": [{"speed_kmh": 15.0}]}
    leading = session(traffic={"vehicles": 6, "lead": lead})
    bundle = open_bundle(drive(leading, tmp_path / "led").folder)
    assert leading.world is not None
    route, console = open_world(leading.world).route, assemble(leading, compiled)[0]
    leaders, table = Leaders(route), bundle.log.table()
    told = np.column_stack([table.column("ahead.lead_gap_m"), table.column("ahead.lead_speed_mps")])
    vectors = {record.tick: np.array(record.vector) for record in bundle.log}
    for at in recorded_road_users(bundle.log):
        if at.tick:
            vehicle = Snapshot(at.tick, console.tick_hz, vectors[at.tick]).vehicle
            found = leaders.find(ego_box(vehicle, console.platform), at.users)
            gap_and_speed = (found.lead_gap_m, found.lead_speed_mps)
            assert (told[at.tick : at.tick + PERIOD_TICKS] == gap_and_speed).all()
    assert (told[:, 0] < FAR).all(), "the leader is there from the first tick on"
    assert (table.column("situation.lead_gap_m") == told[:, 0]).all()
    contact_s = table.column("situation.time_to_collision_s")
    assert ((contact_s == FAR) | (contact_s > 0.0)).all()
    assert replay_bundle(bundle.folder).hashes_equal


def test_drive_that_is_watched_in_each_tick_records_the_same(driven: Path, tmp_path: Path) -> None:
    watched = drive(session(), tmp_path / "watched", lambda snapshot: False).folder
    assert (driven / "drive.log").read_bytes() == (watched / "drive.log").read_bytes()


def test_replay_reads_traffic_and_does_not_simulate_it(driven: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*args: object) -> None:
        raise AssertionError("simulated again")

    monkeypatch.setattr(modelled.Traffic, "__init__", never)
    found = replay_bundle(driven)
    assert found.good
    assert found.hashes_equal
    assert len(list(recorded_road_users(open_bundle(driven).log))) > 10


def test_packed_drive_has_the_same_road_users(driven: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(driven, tmp_path / "packed"))
    before = [at.users.tobytes() for at in recorded_road_users(open_bundle(folder).log)]
    pack(folder)
    assert [at.users.tobytes() for at in recorded_road_users(open_bundle(folder).log)] == before


def test_course_has_no_traffic() -> None:
    resolved = session(world="urban")
    with pytest.raises(ProfileError, match=r"environment\.traffic: needs an environment\.world that is a road map"):
        open_traffic(resolved, assemble(resolved, compiled)[0])


def test_period_is_a_whole_number_of_ticks() -> None:
    resolved = session(traffic={"period_ms": 33})
    with pytest.raises(ProfileError, match=r"environment\.traffic\.period_ms: value 33: a whole number of ticks of"):
        open_traffic(resolved, assemble(resolved, compiled)[0])


class _InTheWay:
    """Traffic whose only vehicle stands where the console's does, from its second step on."""

    def __init__(self) -> None:
        self.steps = 0

    def road_users(self) -> np.ndarray:
        return table([])

    def step(self, ego: Box) -> np.ndarray:
        self.steps += 1
        beside = 0.0 if self.steps > 1 else 50.0
        return np.array([(7.0, 1.0, ego.x_m + beside, ego.y_m, 0.3, 0.0, 4.5, 1.8, 1.5, 0.0, 0.0)])


def test_first_touch_of_a_road_user_is_one_event() -> None:
    console, state = assemble(session(), compiled)
    source = TrafficSource(_InTheWay(), console.platform, 1)  # type: ignore[arg-type]  # as far as a source needs it
    events = []
    for tick in range(1, 6):
        source.publish(Snapshot(tick, console.tick_hz, state.vector))
        events.append(source.take_impact().first_touch)
    assert events == [0.0, 1.0, 0.0, 0.0, 0.0]
    assert source.summary()["traffic"]["collisions"] == 1


def test_footprint_of_the_vehicle_lies_round_its_middle() -> None:
    console, state = assemble(session(), compiled)
    vehicle = Snapshot(0, console.tick_hz, state.vector).vehicle
    found = ego_box(vehicle, console.platform)
    assert found.length_m == console.platform.length_m
    away = np.hypot(found.x_m - vehicle.x_m, found.y_m - vehicle.y_m)
    assert away == pytest.approx(abs(0.5 * console.platform.length_m - console.platform.rear_overhang_m))


def test_whoever_is_shown_road_users_sees_those_of_the_start_first() -> None:
    console, state = assemble(session(), compiled)
    source = open_traffic(session(), console)
    assert source is not None
    seen: list[tuple[int, int]] = []
    source.show_to(lambda at: seen.append((at.tick, len(users(at.users)))))
    for tick in range(1, 2 * PERIOD_TICKS + 1):
        source.publish(Snapshot(tick, console.tick_hz, state.vector))
    assert seen == [(0, 15), (PERIOD_TICKS, 15), (2 * PERIOD_TICKS, 15)]


def test_scene_of_the_drive_has_every_step(driven: Path) -> None:
    program = [sys.executable, "-m", "simconsole.evaluation.report.scene_export", str(driven)]
    subprocess.run(program, check=True, capture_output=True, cwd=ROOT)
    steps = len(list(recorded_road_users(open_bundle(driven).log)))
    seen = contents(driven / "scene.rrd")
    assert seen["/world/road_users"] == seen["/map/road_users"] == steps + 1  # one for what holds throughout


def test_pictures_of_the_drive_have_everybody_at_their_moment(driven: Path) -> None:
    found = list(moments(open_bundle(driven).log, 1.0, 3.0, 10))
    assert [len(moment.shown.others) for moment in found] == [15] * len(found)
    first, last = ({user.id: user.x_m for user in moment.shown.others} for moment in (found[0], found[-1]))
    assert sum(abs(last[number] - x_m) > 1.0 for number, x_m in first.items()) > 3
