"""SUMO's worker, run in this process: the test is the core that it asks whether to stop."""

from collections.abc import Callable
from pathlib import Path

import msgspec
import pytest

from simconsole.processes.worker import WorkerSpec, load_worker
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.traffic import SumoProfile, TrafficProfile
from simconsole.profiles.world import RoadsProfile
from simconsole.session.resolution import load_session, resolve
from simconsole.session.sumo import sumo_worker
from simconsole.session.sumo.sumo_memory import How, SumoMemory
from simconsole.session.sumo.sumo_port import SumoPort
from simconsole.session.sumo.sumo_worker import MOST_AT_ONCE, SumoWorker
from simconsole.values.errors import ProfileError
from simconsole.world.traffic.road_users import RoadUser, users
from tests.world.sumo_traffic.on_sumo import HZ, around, box, sumo_traffic

START = box(100.0)
WORLD = load_world("urban_signals")


class Core:
    """A core beside a worker, as far as its traffic goes."""

    def __init__(self, folder: Path, **sumo: object) -> None:
        assert isinstance(WORLD, RoadsProfile)
        given = {"vehicles": 60, "pedestrians": 5, "radius_m": 1500.0, **sumo}
        self.profile = TrafficProfile(seed=3, sumo=SumoProfile(**given))  # type: ignore[arg-type]
        self.folder = folder
        self.port = SumoPort(self.profile, around(START).road_map, HZ, folder, START)
        self.worker = SumoWorker(traffic=self.profile, world=WORLD, tick_hz=HZ, ego=START, duration_s=120.0)
        self.memory = SumoMemory.open(folder)

    def run(self, turn: Callable[[int], bool]) -> None:
        """Run the worker; `turn` is called each time that it has answered everything, True ends it."""
        turns = 0

        def stop() -> bool:
            nonlocal turns
            said = self.memory.said.newest()
            if said is None or said.number == How.STARTING:
                return False
            turns += 1
            if turns == 1 and said.number == How.RUNS:
                self.port.wait(lambda: True)
                return False
            return turn(turns)

        self.worker.run(self.folder, stop)


def test_its_road_is_that_of_sumo_in_the_drives_own_process(tmp_path: Path) -> None:
    core = Core(tmp_path)
    seen: list[bytes] = []

    def turn(number: int) -> bool:
        seen.append(core.port.step(box(100.0 + 0.2 * len(seen))).tobytes())
        return len(seen) == 60

    core.run(turn)
    with sumo_traffic(START, seed=3, vehicles=60, pedestrians=5, radius_m=1500.0) as inline:
        egos = [START, *(box(100.0 + 0.2 * k) for k in range(59))]
        assert seen == [inline.step(ego).tobytes() for ego in egos]
        signals = inline.signals.now
    assert len(set(seen)) == 60
    assert core.port.signals.now == signals
    assert core.port.ego_error_m == 0.0
    assert core.port.lost is None


def test_late_steps_are_made_up_for_up_to_a_bound_and_times_of_signals_stay_those_of_the_drive(tmp_path: Path) -> None:
    core = Core(tmp_path, vehicles=0, pedestrians=0)
    late = 2 * MOST_AT_ONCE
    asked: list[object] = []

    def turn(number: int) -> bool:
        if not asked:
            asked.extend(core.port.step(START) for _ in range(late))
            return False
        core.port.step(START)
        asked.append(None)
        return len(asked) > late + 60

    core.run(turn)
    assert core.port.lost is None
    with sumo_traffic(START, seed=3, vehicles=0) as inline:
        for _ in range(60):
            inline.step(START)
        punctual = inline.signals.now
    stood_ticks = (late - MOST_AT_ONCE) * 4
    same = [
        (one.switch_tick, punctual[name].switch_tick)
        for name, one in core.port.signals.now.items()
        if one.phase == punctual[name].phase
    ]
    assert same
    assert all(mine == other + stood_ticks for mine, other in same)


def test_who_has_collided_comes_to_rest(tmp_path: Path) -> None:
    core = Core(tmp_path, pedestrians=0)
    speeds: list[RoadUser] = []

    def turn(number: int) -> bool:
        found = users(core.port.step(START))
        if not speeds:
            speeds.append(max(found, key=lambda user: user.speed_mps))
            core.port.push(speeds[0].id, -1.0)
        elif any(user.id == speeds[0].id for user in found):
            speeds.append(next(user for user in found if user.id == speeds[0].id))
        return len(speeds) == 120 or number > 300

    core.run(turn)
    assert speeds[0].speed_mps > 5.0
    assert speeds[3].speed_mps < speeds[0].speed_mps - 0.9
    assert speeds[-1].speed_mps == 0.0


def test_what_cannot_begin_is_refused_once(tmp_path: Path) -> None:
    (tmp_path / "bad.sumocfg").write_text('<configuration><input><net-file value="nowhere"/></input></configuration>')
    core = Core(tmp_path, config=str(tmp_path / "bad.sumocfg"))
    core.run(lambda number: True)
    said = core.memory.said.newest()
    assert said is not None
    assert said.number == How.REFUSED
    assert b"environment.traffic.sumo: SUMO: " in said.content


def test_a_process_that_is_started_again_says_that_traffic_is_lost(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    core = Core(tmp_path)
    core.memory.say(How.RUNS)
    core.worker.run(tmp_path, lambda: True)
    said = core.memory.said.newest()
    assert said is not None
    assert said.number == How.LOST
    assert "traffic has failed: its process has ended" in caplog.text
    assert len(core.port.step(START)) == 0
    assert core.port.lost == "its process has ended"


def test_a_sumo_that_crashed_while_it_loaded_is_not_started_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its process is gone without a word, libsumo in it; the next one finds that it had begun."""
    core, starts = Core(tmp_path), list[object]()

    def crash(*given: object) -> None:
        starts.append(given)
        raise SystemExit(139)

    monkeypatch.setattr(sumo_worker, "SumoTraffic", crash)
    with pytest.raises(SystemExit):
        core.worker.run(tmp_path, lambda: True)
    core.worker.run(tmp_path, lambda: True)
    assert len(starts) == 1
    with pytest.raises(ProfileError, match=r"sumo: SUMO: its process has ended: a simulation that starts"):
        core.port.wait(lambda: True)


def test_a_session_has_it_where_it_names_sumo() -> None:
    resolved = resolve(load_session("demo"))
    assert sumo_worker.sumo_worker(resolved, HZ, START) is None
    environment = msgspec.structs.replace(resolved.session.environment, traffic=TrafficProfile(sumo=SumoProfile()))
    session = msgspec.structs.replace(resolved.session, environment=environment)
    with_sumo = msgspec.structs.replace(resolved, session=session, world=WORLD)
    found = sumo_worker.sumo_worker(with_sumo, HZ, START)
    assert isinstance(found, SumoWorker)
    assert (found.traffic, found.world, found.tick_hz, found.ego) == (environment.traffic, WORLD, HZ, START)


def test_its_configuration_travels_as_json(tmp_path: Path) -> None:
    worker = Core(tmp_path).worker
    assert load_worker(WorkerSpec.of("sumo", worker)) == msgspec.structs.replace(worker, ego=tuple(START))
