"""Several vehicles of the console's in one SUMO: each is there exactly, once, for SUMO's vehicles and not for ours."""

import math
from pathlib import Path

import numpy as np

from simconsole.profiles.files.world_files import load_world
from simconsole.world.kinds.worlds import open_world
from simconsole.world.sumo_traffic.ego import CLEAR_M, EGO
from simconsole.world.traffic.road_users import Box, RoadUser, users
from tests.world.sumo_traffic.on_sumo import LENGTH_M, box, configuration, sumo_traffic

PLATFORMS = 3


def on_route(s_m: float, speed_mps: float = 0.0) -> Box:
    place = open_world(load_world("urban_signals")).route.at(s_m)
    return box(place.x_m, place.y_m, place.yaw_rad, speed_mps)


def away_m(user: RoadUser, ego: Box) -> float:
    return math.hypot(user.x_m - ego.x_m, user.y_m - ego.y_m)


def test_each_is_exactly_where_it_is_and_none_of_ours_comes_back_as_one_of_sumos() -> None:
    """One drives, one stands close behind it at first, one comes over a meadow and jumps between the others."""
    ways = [(on_route(260.0 + 0.4 * k, 10.0), on_route(250.0), box(60.0, -40.0 + 0.1 * k, 1.2)) for k in range(150)]
    ways += [(ways[-1][0], ways[-1][1], on_route(270.0)) for _ in range(50)]
    with sumo_traffic(*ways[0], vehicles=100, pedestrians=10, warm_up_s=20.0, radius_m=800.0) as traffic:
        seen = 0
        for way in ways:
            traffic.step_all(way)
            assert traffic.ego_error_m == 0.0
            tables = [users(traffic.road_users(number)) for number in range(PLATFORMS)]
            seen += min(map(len, tables))
            for table in tables:
                assert all(user.id >= PLATFORMS for user in table)
                assert all(away_m(user, ego) > 0.5 for user in table for ego in way)
            same = {user.id: user for user in tables[0]}
            assert all(same[user.id] == user for user in tables[1] if user.id in same), "one road user is one"
        names = {name for name in traffic._sumo.vehicle.getIDList() if name.startswith(EGO)}
        near = [away_m(user, ways[-1][2]) for user in users(traffic.road_users(2))]
    assert names == {EGO, f"{EGO}1", f"{EGO}2"}
    assert seen > 10 * len(ways)
    assert min(near) > CLEAR_M - 10.0, "where one comes all at once, nobody of SUMO's is near"
    assert traffic.lost is None


def test_followers_stop_behind_each_of_ours_at_their_minimum_gap(tmp_path: Path) -> None:
    kind = '<vType id="t" minGap="2.5" length="5"/>'
    lanes = "".join(
        f'<vehicle id="{name}" type="t" depart="0" departPos="{at}"><route edges="road0 road1 road2"/></vehicle>'
        for name, at in (("hind", 10), ("fore", 70))
    )
    stand = box(60.0), box(150.0)
    with sumo_traffic(*stand, config=configuration(tmp_path, kind + lanes), warm_up_s=0.0) as traffic:
        for _ in range(600):
            traffic.step_all(stand)
        behind = sorted(users(traffic.road_users(0)), key=lambda user: user.x_m)
    assert np.array_equal(traffic.road_users(0), traffic.road_users(1))
    gaps_m = [
        ego.x_m - 0.5 * LENGTH_M - user.x_m - 0.5 * user.length_m for ego, user in zip(stand, behind, strict=True)
    ]
    assert all(user.speed_mps == 0.0 for user in behind)
    assert all(2.5 <= gap_m < 2.6 for gap_m in gaps_m), gaps_m
