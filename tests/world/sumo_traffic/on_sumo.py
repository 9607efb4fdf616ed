"""SUMO's traffic on the urban course with signals, for tests."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from simconsole.profiles.files.world_files import load_world, read_map
from simconsole.profiles.traffic import SumoProfile, TrafficProfile
from simconsole.profiles.world import RoadsProfile
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.road_world import roads_of
from simconsole.world.sumo_traffic.sumo_traffic import SumoTraffic, Surroundings
from simconsole.world.traffic.road_users import Box
from tests.paths import ROOT

HZ = 100
NET = ROOT / "profiles" / "worlds" / "urban_signals.net.xml"
LENGTH_M = 4.4


def box(x_m: float, y_m: float = 0.0, yaw_rad: float = 0.0, speed_mps: float = 0.0) -> Box:
    return Box(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad, speed_mps=speed_mps, length_m=LENGTH_M, width_m=1.8)


def around(*egos: Box, world: str = "urban_signals") -> Surroundings:
    profile = load_world(world)
    assert isinstance(profile, RoadsProfile)
    roads = roads_of(open_world(profile))
    assert roads is not None
    return Surroundings(
        road_map=roads.road_map, net=read_map(profile.map), legs=roads.legs, tick_hz=HZ, egos=egos, duration_s=120.0
    )


@contextmanager
def sumo_traffic(*egos: Box, seed: int = 1, period_ms: int = 40, **sumo: Any) -> Iterator[SumoTraffic]:
    profile = TrafficProfile(seed=seed, period_ms=period_ms, sumo=SumoProfile(**{"vehicles": 0, **sumo}))
    traffic = SumoTraffic(profile, around(*egos))
    try:
        yield traffic
    finally:
        traffic.close()


def configuration(folder: Path, routes: str, additional: str = "", net: Path = NET) -> str:
    """Write a configuration of SUMO's with these routes and additional elements; return its name."""
    (folder / "own.rou.xml").write_text(f"<routes>{routes}</routes>")
    (folder / "own.add.xml").write_text(f"<additional>{additional}</additional>")
    path = folder / "own.sumocfg"
    path.write_text(
        f'<configuration><input><net-file value="{net}"/><route-files value="own.rou.xml"/>'
        '<additional-files value="own.add.xml"/></input></configuration>'
    )
    return str(path)
