"""A road map as lines and areas in `map` for whoever draws it: what lies near the route."""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Final

import numpy as np

from simconsole.world.drawing import Drawing
from simconsole.world.drawing_layers import STEP_M, DrawingLayers, Frame, Light, LightProgram, add_zebra, box
from simconsole.world.roads.road_map import (
    BUILDING,
    CONE,
    CROSSING,
    ROAD,
    TREE,
    WALL,
    Array,
    Connection,
    Lane,
    RoadMap,
    active,
)
from simconsole.world.route import Route

NEAR_M: Final = 250.0
"""What lies further from the route is not drawn: a city has too much of it."""
HEIGHTS_M: Final = {BUILDING: 8.0, CONE: 0.75, TREE: 5.0, WALL: 1.8}
"""Of what the map's files have no height."""
_CHUNK_M: Final = 12.0
_STOP_LINE_M: Final = 0.5
_POST_M: Final = 0.9
_SPARSE_M: Final = 20.0
_STRAIGHT: Final = "s"
_LEADS_AHEAD: Final = ("s", "l", "L", "R")
"""Where the right side of the road after the junction is before those who come."""
_POST_APART_M: Final = 0.3


def draw_roads(road_map: RoadMap, route: Route) -> Drawing:
    """Return everything there is to draw near a route."""
    layers = DrawingLayers()
    near = _Near(route)
    for edge in road_map.edges:
        lanes = [road_map.lanes[place] for place in edge.lanes]
        if not near.to(lanes[0].line[:, :2]):
            continue
        if edge.function == ROAD:
            _add_road(layers, lanes)
        elif edge.function == CROSSING:
            _add_crossing(layers, lanes[0])
    for junction in road_map.junctions:
        if len(junction.outline) > 2 and near.to(junction.outline):
            layers.surfaces.append(junction.outline)
    for place, link in _signalled(road_map).items():
        _add_stop(layers, road_map, place, link, near)
    walls = []
    for kind, outline in road_map.obstacles:
        if near.to(outline):
            closed = np.vstack((outline, outline[:1]))
            layers.edges.append(closed)
            walls.append(np.column_stack((closed, np.full(len(closed), HEIGHTS_M[kind]))))
    return Drawing(
        surfaces=tuple(layers.surfaces),
        islands=tuple(layers.islands),
        edges=tuple(layers.edges),
        centre_lines=tuple(layers.centre_lines),
        zebras=tuple(layers.zebras),
        stop_lines=tuple(layers.stop_lines),
        lights=tuple(layers.lights),
        path=route.offset(0.0, 0.0, route.length_m, STEP_M),
        walls=tuple(walls),
    )


class _Near:
    """Tells what lies near a route."""

    def __init__(self, route: Route) -> None:
        self._points = route.offset(0.0, 0.0, route.length_m, _SPARSE_M)

    def to(self, line: Array) -> bool:
        """Return whether one of the points [N, 2], or the middle of them, lies near the route."""
        spots = np.vstack((line, line.mean(axis=0)))
        away = np.hypot(*(spots[:, None, :] - self._points[None, :, :]).transpose(2, 0, 1))
        return float(away.min()) < NEAR_M


def _add_road(layers: DrawingLayers, lanes: list[Lane]) -> None:
    for lane in lanes:
        layers.surfaces += _strip(lane)
    layers.edges.append(beside(lanes[0].line[:, :2], -0.5 * lanes[0].width_m))
    layers.edges.append(beside(lanes[-1].line[:, :2], 0.5 * lanes[-1].width_m))
    for lane, other in pairwise(lanes):
        line = beside(lane.line[:, :2], 0.5 * lane.width_m)
        (layers.centre_lines if lane.drivable and other.drivable else layers.edges).append(line)


def beside(line: Array, lateral_m: float) -> Array:
    """Return the line `lateral_m` left of a line [N, 2], mitred at its corners."""
    steps = np.diff(line, axis=0)
    headings = np.arctan2(steps[:, 1], steps[:, 0])
    turned = np.remainder(np.diff(headings) + math.pi, math.tau) - math.pi
    inner = headings[:-1] + 0.5 * turned
    yaw = np.concatenate((headings[:1], inner, headings[-1:]))
    mitre = np.concatenate(((1.0,), 1.0 / np.maximum(np.cos(0.5 * turned), 0.5), (1.0,)))
    normal = np.stack((-np.sin(yaw), np.cos(yaw)), axis=1)
    return np.asarray(line + normal * (lateral_m * mitre)[:, None])


def _strip(lane: Lane) -> Iterator[Array]:
    """Yield the area of a lane as polygons of at most 12 m, nearly convex."""
    line = _dense(lane.line[:, :2])
    right, left = beside(line, -0.5 * lane.width_m), beside(line, 0.5 * lane.width_m)
    for at in range(len(line) - 1):
        yield np.stack((right[at], right[at + 1], left[at + 1], left[at]))


def _dense(line: Array) -> Array:
    """Return a line with points at most 12 m apart."""
    parts = [line[:1]]
    for one, other in pairwise(line):
        count = max(1, math.ceil(float(np.hypot(*(other - one))) / _CHUNK_M))
        parts.append(one + (other - one) * (np.arange(1, count + 1) / count)[:, None])
    return np.vstack(parts)


def _add_crossing(layers: DrawingLayers, lane: Lane) -> None:
    """Draw a zebra; the lane of a crossing leads over the road, its width along it."""
    start, end = lane.line[0, :2], lane.line[-1, :2]
    x, y = (0.5 * (start + end)).tolist()
    across = math.atan2(*(end - start)[::-1].tolist())
    half = 0.5 * lane.width_m
    add_zebra(layers, Frame(x, y, across - 0.5 * math.pi), -half, half, 0.5 * lane.length_m)


def _signalled(road_map: RoadMap) -> dict[int, Connection]:
    """Return the lanes that end before a signal, and of each the movement that its light is for: straight on if any."""
    found: dict[int, Connection] = {}
    for one in road_map.connections:
        if one.signal >= 0 and road_map.lanes[one.from_lane].drivable:
            known = found.get(one.from_lane)
            if known is None or (one.direction == _STRAIGHT and known.direction != _STRAIGHT):
                found[one.from_lane] = one
    return found


def _program(road_map: RoadMap, link: Connection) -> LightProgram:
    signal = road_map.signals[link.signal]
    program = active(signal)
    return LightProgram(
        signal=signal.id,
        link=link.link,
        offset_s=program.offset_s,
        durations_s=tuple(phase.duration_s for phase in program.phases),
        letters="".join(phase.state[link.link : link.link + 1] or "O" for phase in program.phases),
    )


def _add_stop(layers: DrawingLayers, road_map: RoadMap, place: int, link: Connection, near: _Near) -> None:
    lane = road_map.lanes[place]
    end = lane.line[-1, :2]
    if not near.to(end[None, :]):
        return
    yaw = math.atan2(*(end - lane.line[-2, :2])[::-1].tolist())
    frame = Frame(float(end[0]), float(end[1]), yaw)
    half = 0.5 * lane.width_m
    layers.stop_lines.append(frame.out(box(-_STOP_LINE_M, 0.0, 0.2 - half, half - 0.2)))
    for x, y in (_beside(road_map, lane, frame), *_beyond(road_map, link)):
        light = Light(x, y, yaw, _program(road_map, link))
        if all(math.dist(light[:2], other[:2]) > _POST_APART_M or other.yaw_rad != yaw for other in layers.lights):
            layers.lights.append(light)


def _beside(road_map: RoadMap, lane: Lane, frame: Frame) -> tuple[float, float]:
    """Return a post's place on the right of a road, at a place of one of its lanes."""
    outer = road_map.lanes[road_map.edges[lane.edge].lanes[0]]
    aside = 0.5 * outer.width_m + _POST_M + lane.width_m * (lane.number - outer.number)
    x, y = frame.out(np.array(((0.0, -aside),)))[0].round(3).tolist()
    return x, y


def _beyond(road_map: RoadMap, link: Connection) -> Iterator[tuple[float, float]]:
    """Yield the place of the post beyond the junction, for who waits at the line and has the first one beside them."""
    if link.direction in _LEADS_AHEAD:
        lane = road_map.lanes[link.to_lane]
        start, after = lane.line[0, :2], lane.line[1, :2]
        yaw = math.atan2(*(after - start)[::-1].tolist())
        yield _beside(road_map, lane, Frame(float(start[0]), float(start[1]), yaw))
