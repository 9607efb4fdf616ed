"""SUMO's traffic round the ego: a real SUMO of this version, in this process."""

import math
import signal
from collections.abc import Callable
from contextlib import ExitStack
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.values.errors import ProfileError
from simconsole.values.signals import SignalState
from simconsole.world.kinds.worlds import open_world
from simconsole.world.route import Route
from simconsole.world.sumo_traffic import ego as ego_module
from simconsole.world.sumo_traffic.ego import CLEAR_M, EGO, has_jumped
from simconsole.world.traffic.road_users import NOBODY, Box, RoadUser, RoadUserKind, users
from tests.world.sumo_traffic.on_sumo import LENGTH_M, NET, around, box, configuration, sumo_traffic

ROAD0 = '<route id="r" edges="road0 road1 road2"/>'
STEP_S = 0.04


@cache
def route() -> Route:
    """Return the route of the map: it is asked at thousands of places."""
    return open_world(load_world("urban_signals")).route


def on_route(s_m: float, speed_mps: float = 0.0) -> Box:
    place = route().at(s_m)
    return box(place.x_m, place.y_m, place.yaw_rad, speed_mps)


def only(traffic_users: np.ndarray) -> RoadUser:
    (found,) = users(traffic_users)
    return found


def test_ego_is_in_sumo_exactly_where_it_is_in_the_console() -> None:
    """Trap 3 too: over the whole route and beyond its end, off the road and standing, SUMO never takes it over."""
    length_m = route().length_m
    ways = [on_route(s_m, 20.0) for s_m in np.arange(0.0, length_m, 0.8)]
    last = ways[-1]
    ways += [last._replace(x_m=last.x_m + 0.8 * math.cos(last.yaw_rad) * k, speed_mps=20.0) for k in range(300)]
    ways += [box(60.0, -40.0 + 0.1 * k, 1.2) for k in range(200)]  # a meadow, then over the road
    with sumo_traffic(ways[0], vehicles=10) as traffic:
        for way in ways:
            traffic.step(way)
            assert traffic.ego_error_m == 0.0
            assert EGO in traffic._sumo.vehicle.getIDList()
        angle_deg = traffic._sumo.vehicle.getAngle(EGO)
    assert angle_deg == pytest.approx(90.0 - math.degrees(1.2))
    assert traffic.lost is None


def test_ego_that_drives_on_after_the_end_of_its_route_in_sumo_stays_exactly_there(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The world's route is a loop; in SUMO it is repeated up to LONG_M, here once only, and driven half again."""
    monkeypatch.setattr(ego_module, "LONG_M", 1.0)
    length_m = route().length_m
    ways = [on_route(s_m % length_m, 80.0) for s_m in np.arange(0.0, 1.5 * length_m, 3.2)]
    with sumo_traffic(ways[0], vehicles=10) as traffic:
        for way in ways:
            traffic.step(way)
            assert traffic.ego_error_m == 0.0
            assert EGO in traffic._sumo.vehicle.getIDList()
    assert traffic.lost is None


def test_own_seed_step_begin_and_end_of_a_configuration(tmp_path: Path) -> None:
    """Seed and step are the session's; it begins when it says; and its end ends nothing."""
    flow = '<flow id="f" begin="100" end="200" probability="0.3"><route edges="road0 road1 road2"/></flow>'
    path = Path(configuration(tmp_path, flow, ACTUATED))
    seen = []
    for seed, own in ((1, 5), (1, 6), (2, 5)):
        own_times = '<time><begin value="100"/><end value="103"/><step-length value="1"/></time>'
        own_seed = f'<random_number><seed value="{own}"/></random_number>'
        text = path.read_text().partition("<time>")[0].replace("</configuration>", "")
        path.write_text(f"{text}{own_times}{own_seed}</configuration>")
        with sumo_traffic(box(-60.0), seed=seed, config=str(path), warm_up_s=2.0, radius_m=1500.0) as traffic:
            assert traffic._sumo.simulation.getTime() == pytest.approx(102.0 + STEP_S)
            place = next(k for k, one in enumerate(traffic.road_map.signals) if one.id == "junction0")
            rows = [traffic.step(box(-60.0)).tobytes() for _ in range(200)]
            at_s = (102.0 + 201 * STEP_S) % 13.0
            left_s = 4.0 - at_s if at_s < 4.0 else 7.0 - at_s if at_s < 7.0 else 13.0 - at_s
            assert traffic.signals.shown(place, 4 * 200).change_s[0] == pytest.approx(left_s, abs=2 * STEP_S)
            assert traffic.lost is None
            assert len(traffic.road_users()) > 0
        seen.append(rows)
    assert seen[0] == seen[1] != seen[2]


def test_follower_stops_behind_a_parked_ego_at_its_minimum_gap(tmp_path: Path) -> None:
    """Trap 1: by the bumpers, not by the middles or the rear axle."""
    follower = '<vType id="t" minGap="2.5" length="5"/><vehicle id="f" type="t" depart="0" departPos="10">'
    config = configuration(tmp_path, f'{follower}<route edges="road0 road1 road2"/></vehicle>')
    with sumo_traffic(box(150.0), config=config, warm_up_s=0.0) as traffic:
        for _ in range(750):
            found = traffic.step(box(150.0))
        behind = only(found)
    assert behind.speed_mps == 0.0
    gap_m = 150.0 - 0.5 * LENGTH_M - (behind.x_m + 0.5 * behind.length_m)
    assert 2.5 <= gap_m < 2.6


def test_others_look_where_they_drive(tmp_path: Path) -> None:
    """Trap 2: through a bend, yaw is the direction of the way from step to step."""
    config = configuration(tmp_path, f'{ROAD0}<vehicle id="v" route="r" depart="0" departSpeed="10" departPos="200"/>')
    with sumo_traffic(box(-60.0), config=config, warm_up_s=0.0, radius_m=1000.0) as traffic:
        tables = [only(traffic.step(box(-60.0))) for _ in range(500)]
    moved = [pair for pair in pairwise(tables) if pair[1].speed_mps > 3.0]
    turned = [
        math.remainder(math.atan2(now.y_m - was.y_m, now.x_m - was.x_m) - now.yaw_rad, math.tau) for was, now in moved
    ]
    assert max(now.yaw_rad for now in tables) > 0.4, "it drives through a bend"
    assert np.abs(turned).max() < 0.1
    speeds = [math.hypot(now.x_m - was.x_m, now.y_m - was.y_m) / STEP_S - now.speed_mps for was, now in moved]
    assert np.abs(speeds).max() < 0.5


def test_nobody_is_near_where_the_ego_comes_and_nobody_is_surprised() -> None:
    """Trap 5: it stands in the middle of dense traffic all at once."""
    start = on_route(250.0)
    with sumo_traffic(start, vehicles=150, warm_up_s=30.0) as traffic:
        speeds: dict[float, float] = {user.id: user.speed_mps for user in users(traffic.road_users())}
        near = [math.hypot(user.x_m - start.x_m, user.y_m - start.y_m) for user in users(traffic.road_users())]
        hardest = 0.0
        for _ in range(100):
            for user in users(traffic.step(start)):
                hardest = max(hardest, (speeds.get(user.id, 0.0) - user.speed_mps) / STEP_S)
                speeds[user.id] = user.speed_mps
    assert len(near) > 5
    assert min(near) > CLEAR_M - 6.0
    assert hardest < 5.0, "who brakes brakes as for anybody who stands there"


def test_nobody_is_surprised_by_an_ego_that_jumps_and_it_goes_on_exactly() -> None:
    """Trap 5: an operator's restart, and steps that were left out, put it elsewhere all at once."""
    ways = [on_route(250.0 + 0.4 * k, 10.0) for k in range(50)]
    ways += [on_route(900.0)] * 50  # set back to another place, where it stands
    ways += [on_route(900.0 + 0.4 * k, 10.0) for k in range(25)]
    ways += [on_route(960.0 + 0.4 * k, 10.0) for k in range(25)]  # 50 m were left out
    speeds: dict[float, float] = {}
    hardest, seen = 0.0, 0
    with sumo_traffic(ways[0], vehicles=150, pedestrians=20, warm_up_s=30.0) as traffic:
        for before, way in pairwise(ways):
            found = users(traffic.step(way))
            assert traffic.ego_error_m == 0.0
            jumped = math.hypot(way.x_m - before.x_m, way.y_m - before.y_m) > 5.0
            for user in found:
                if user.kind == RoadUserKind.PEDESTRIAN:
                    continue  # they stop at once
                if jumped:
                    assert math.hypot(user.x_m - way.x_m, user.y_m - way.y_m) > CLEAR_M - 6.0
                if math.hypot(user.x_m - way.x_m, user.y_m - way.y_m) < 100.0:
                    hardest = max(hardest, (speeds.get(user.id, 0.0) - user.speed_mps) / STEP_S)
                speeds[user.id] = user.speed_mps
            seen += any(user.kind == RoadUserKind.PEDESTRIAN for user in found)
        assert traffic._sumo.vehicle.getSpeed(EGO) == pytest.approx(10.0, abs=0.5)
        assert traffic.lost is None
    assert hardest < 5.0
    assert seen > 100, "people round it are asked for anew"


def test_which_ways_are_jumps() -> None:
    at = box(10.0, speed_mps=14.0)
    assert not has_jumped(at, at._replace(x_m=10.0 + 14.0 * STEP_S), STEP_S)
    assert not has_jumped(at._replace(speed_mps=0.0), at._replace(x_m=10.7), STEP_S), "pushed aside"
    assert has_jumped(at, at._replace(x_m=10.0 + 4 * 14.0 * STEP_S), STEP_S), "three steps were left out"


def test_others_neither_tremble_nor_snap_round() -> None:
    """Trap 4, where lanes cannot be changed: nobody moves across the way that they head, or turns at once."""
    start = on_route(250.0)
    with sumo_traffic(start, vehicles=100, radius_m=2000.0, warm_up_s=20.0) as traffic:
        tables = [{user.id: user for user in users(traffic.step(start))} for _ in range(400)]
    _are_steady(tables)


def _are_steady(tables: list[dict[float, RoadUser]]) -> None:
    pairs = [(was[name], now[name]) for was, now in pairwise(tables) for name in was.keys() & now.keys()]
    assert len(pairs) > 5000
    for was, now in pairs:
        turned = math.remainder(now.yaw_rad - was.yaw_rad, math.tau)
        yaw, (x_m, y_m) = was.yaw_rad + 0.5 * turned, (now.x_m - was.x_m, now.y_m - was.y_m)
        assert abs(turned) < 0.3
        assert abs(y_m * math.cos(yaw) - x_m * math.sin(yaw)) < 0.5
        along_m = x_m * math.cos(yaw) + y_m * math.sin(yaw)
        assert abs(along_m - 0.5 * STEP_S * (was.speed_mps + now.speed_mps)) < 0.5


class Counted:
    """A domain of SUMO's whose calls are counted."""

    def __init__(self, domain: Any, count: Callable[[], None]) -> None:
        self._domain, self._count = domain, count

    def __getattr__(self, name: str) -> Any:
        self._count()
        return getattr(self._domain, name)


def test_a_step_asks_the_same_however_many_there_are(monkeypatch: pytest.MonkeyPatch) -> None:
    counts = []
    for vehicles in (5, 150):
        with sumo_traffic(box(100.0), vehicles=vehicles, radius_m=1500.0) as traffic:
            calls: list[int] = []
            for domain in ("vehicle", "person", "trafficlight", "poi", "simulation"):
                counted = Counted(getattr(traffic._sumo, domain), lambda calls=calls: calls.append(1))  # type: ignore[misc]
                monkeypatch.setattr(traffic._sumo, domain, counted)
            seen = len(traffic.step(box(100.0)))
            counts.append((seen, len(calls)))
            monkeypatch.undo()
    assert counts[1][0] > 100 > counts[0][0]
    assert counts[0][1] == counts[1][1] == 5


def test_people_walk_among_the_vehicles() -> None:
    with sumo_traffic(box(100.0), vehicles=20, pedestrians=20, radius_m=1500.0) as traffic:
        first = users(traffic.step(box(100.0)))
        for _ in range(100):
            last = users(traffic.step(box(100.0)))
    kinds = {user.kind for user in last}
    assert {RoadUserKind.PEDESTRIAN, RoadUserKind.CAR} <= kinds
    places = {user.id: user for user in first}
    walked = [
        math.hypot(user.x_m - places[user.id].x_m, user.y_m - places[user.id].y_m)
        for user in last
        if user.kind == RoadUserKind.PEDESTRIAN and user.id in places
    ]
    assert 2.0 < max(walked) < 10.0  # in four seconds


def test_who_is_struck_comes_to_rest_and_stays(tmp_path: Path) -> None:
    person = '<person id="v" depart="0" departPos="50"><walk from="road1" to="road2"/></person>'
    vehicle = '<vehicle id="v" route="r" depart="0" departSpeed="10" departPos="50"/>'
    config = configuration(tmp_path, f"{ROAD0}{vehicle}{person}")
    with sumo_traffic(box(-60.0), config=config, warm_up_s=1.0, radius_m=1500.0) as traffic:
        car, walker = sorted(users(traffic.step(box(-60.0))), key=lambda user: user.kind)
        assert car.id != walker.id, "a vehicle and a person of one name are two"
        assert walker.kind == RoadUserKind.PEDESTRIAN
        traffic.push(car.id, -2.0)
        traffic.push(walker.id, 0.0)
        struck = next(user for user in users(traffic.step(box(-60.0))) if user.id == car.id)
        assert struck.speed_mps == pytest.approx(car.speed_mps - 2.0, abs=0.01)
        for _ in range(100):
            found = {user.id: user for user in users(traffic.step(box(-60.0)))}
    stopped_m = found[car.id].x_m - struck.x_m
    assert found[car.id].speed_mps == 0.0
    assert stopped_m == pytest.approx(struck.speed_mps**2 / 12.0, rel=0.1)
    assert found[walker.id].speed_mps == 0.0


ACTUATED = (
    '<tlLogic id="junction0" type="static" programID="own" offset="0">'
    '<phase duration="4" state="GGGGGGGGGGGGrrrr"/><phase duration="3" state="yyyyyyyyyyyyrrrr"/>'
    '<phase duration="6" state="rrrrrrrrrrrrGGGG"/></tlLogic>'
)


def test_signals_are_those_that_sumo_runs(tmp_path: Path) -> None:
    config = configuration(tmp_path, ROAD0, ACTUATED)
    road_map = around(box(0.0)).road_map
    place = next(k for k, signal in enumerate(road_map.signals) if signal.id == "junction0")
    changes = 0
    with sumo_traffic(box(100.0), config=config, warm_up_s=0.0) as traffic:
        for k in range(1, 400):
            traffic.step(box(100.0))
            at_s, letters = k * STEP_S % 13.0, traffic._sumo.trafficlight.getRedYellowGreenState("junction0")
            shown = traffic.signals.shown(place, 4 * k)
            state = traffic.signals.state(place, 0, 4 * k)
            assert state == {"G": SignalState.PROTECTED_MOVEMENT_ALLOWED, "y": 7, "r": 3}[letters[0]]
            assert shown.states[0] == state
            left_s = 4.0 - at_s if at_s < 4.0 else 7.0 - at_s if at_s < 7.0 else 13.0 - at_s
            assert min(abs(shown.change_s[0] - left_s), shown.change_s[0]) < 2 * STEP_S
            changes += traffic.signals.changed() is not None
    assert changes == 4, "at the start, and at each change in 16 s"


def test_network_of_another_map_is_refused(tmp_path: Path) -> None:
    config = configuration(tmp_path, "", net=NET.with_name("country.net.xml"))
    with (
        pytest.raises(ProfileError, match=r"sumo\.config: value .*own\.sumocfg: one on the world's own map"),
        sumo_traffic(box(0.0), config=config),
    ):
        pass
    with sumo_traffic(box(0.0)) as traffic:  # the first one has ended
        assert traffic.lost is None


def test_what_sumo_says_of_a_bad_configuration_is_told(tmp_path: Path) -> None:
    config = configuration(tmp_path, '<vehicle id="v" depart="0"><route edges="nowhere"/></vehicle>')
    with (
        pytest.raises(ProfileError, match=r"environment\.traffic\.sumo: SUMO: .*nowhere"),
        sumo_traffic(box(0.0), config=config, backend="traci"),
    ):
        pass


def test_second_simulation_in_a_process_is_refused_and_leaves_the_first_alone() -> None:
    with sumo_traffic(box(100.0), vehicles=5) as traffic:
        with pytest.raises(ProfileError, match=r"sumo\.backend: value libsumo: traci, where a process has more"):
            sumo_traffic(box(0.0)).__enter__()
        before_s = traffic._sumo.simulation.getTime()
        traffic.step(box(100.0))
        assert traffic._sumo.simulation.getTime() == pytest.approx(before_s + STEP_S)


def test_ego_is_handed_back_before_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    with sumo_traffic(box(100.0), vehicles=5) as traffic:
        traffic.step(box(100.0))
        sumo, stack = traffic._sumo, traffic._stack
        monkeypatch.setattr(traffic, "_stack", ExitStack())  # SUMO runs on
        traffic.close()
        for _ in range(3):
            sumo.simulationStep()
        assert EGO not in sumo.vehicle.getIDList()
        assert EGO not in sumo.poi.getIDList()
        stack.close()


@pytest.mark.parametrize("name", ["SIGKILL", "SIGSTOP"])
def test_drive_goes_on_without_a_sumo_that_is_gone_or_hangs(name: str) -> None:
    with sumo_traffic(box(100.0), vehicles=30, radius_m=1500.0, backend="traci", timeout_s=2.0) as traffic:
        assert len(traffic.step(box(100.0))) > 5
        assert traffic.process is not None
        traffic.process.send_signal(getattr(signal, name))
        for _ in range(3):
            found = traffic.step(box(100.0))
        assert found is NOBODY
        assert traffic.lost is not None
    assert traffic.process.returncode is not None


def test_equal_bits_through_traci_and_libsumo() -> None:
    seen = []
    for backend in ("libsumo", "traci"):
        with sumo_traffic(box(100.0), seed=7, vehicles=60, pedestrians=10, radius_m=1500.0, backend=backend) as traffic:
            seen.append([traffic.step(box(100.0 + 0.2 * k)).tobytes() for k in range(150)])
    assert seen[0] == seen[1]
    assert len(set(seen[0])) == 150
