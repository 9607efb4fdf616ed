import math

import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.values.signals import FAR
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.road_world import roads_of
from simconsole.world.rules.owing import BESIDE_M, Owing
from simconsole.world.rules.right_of_way import NOTHING_OWED
from simconsole.world.traffic.road_users import Box
from tests.world.rules.test_right_of_way import crossing, somebody


@pytest.mark.parametrize(
    ("beside_m", "turned_rad", "owes"), [(0.0, 0.0, True), (BESIDE_M + 1.0, 0.0, False), (0.0, 2.0, False)]
)
def test_vehicle_owes_on_its_route_only(beside_m: float, turned_rad: float, owes: bool) -> None:
    world = open_world(load_world("urban_signals"))
    roads = roads_of(world)
    assert roads is not None
    foot = crossing()
    place = world.route.at(foot.line_m - 22.0)
    ego = Box(
        x_m=place.x_m - beside_m * math.sin(place.yaw_rad),
        y_m=place.y_m + beside_m * math.cos(place.yaw_rad),
        yaw_rad=place.yaw_rad + turned_rad,
        speed_mps=5.0,
        length_m=4.0,
        width_m=1.8,
    )
    owed = Owing(roads.road_map, roads.legs, world.route, 250).owed(ego, somebody(foot, 0.5), 0)
    if owes:
        assert owed == (pytest.approx(20.0, abs=0.1), 0.0)
    else:
        assert owed == NOTHING_OWED
        assert owed.yield_m == FAR
