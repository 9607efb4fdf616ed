"""Vehicles of traffic that tests put where they want them."""

import numpy as np

from simconsole.values.host.jit import plain
from simconsole.world import traffic_columns as at
from simconsole.world.people.people import People
from simconsole.world.roads.road_map import Array, RoadMap
from simconsole.world.traffic.junctions import GIVE_WAY, LINE, Turn
from simconsole.world.traffic.network import Network, Numbers
from simconsole.world.traffic.paths import middle_at
from simconsole.world.traffic.road_users import Box


def lane_called(road_map: RoadMap, name: str) -> int:
    return next(place for place, lane in enumerate(road_map.lanes) if lane.id == name)


def path_on(*lanes: int, connections: tuple[int, ...] = ()) -> Numbers:
    path = np.zeros(at.PATH, np.int64)
    path[at.COUNT] = len(lanes)
    path[at.DRAW] = 1
    path[at.LANES : at.LANES + len(lanes)] = lanes
    path[at.CONNECTIONS : at.GRANTS] = -1
    path[at.CONNECTIONS : at.CONNECTIONS + len(connections)] = connections
    return path


def vehicle_on(net: Network, path: Numbers, s_m: float, speed_mps: float) -> Array:
    values = np.zeros(at.VALUES)
    values[at.X : at.SINE + 1] = middle_at(net, path, s_m)
    values[at.SPEED], values[at.LENGTH], values[at.WIDTH] = speed_mps, 4.0, 1.8
    values[at.S], values[at.SPEED_SHARE], values[at.TIME_GAP], values[at.CHANGED] = s_m, 1.0, 1.2, 1.0
    return values


def turn_of(road_map: RoadMap, vehicles: int) -> Turn:
    lines = np.full((vehicles, LINE), -1.0)
    lights = np.full(len(road_map.connections), GIVE_WAY, np.int64)
    granted, kept_free = (np.zeros(len(road_map.connections), np.int64) for _ in range(2))
    crossed = People(road_map, 0, 1, plain).crossed
    return Turn(lines=lines, granted=granted, lights=lights, kept_free=kept_free, crossed=crossed)


def box(x_m: float, y_m: float, yaw_rad: float = 0.0, speed_mps: float = 0.0) -> Box:
    return Box(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad, speed_mps=speed_mps, length_m=4.5, width_m=1.8)
