"""Actions of an OpenSCENARIO file as the acts of an actor."""

import math
from typing import Any, Final

from simconsole.evaluation.openscenario.entities import Entity, Place, position
from simconsole.evaluation.openscenario.reading import Source
from simconsole.world.sumo.xml_guard import Element

MOST_MPS: Final = 69.0
STEP_MPS2: Final = 100.0
_SMOOTH: Final = ("cubic", "sinusoidal")


def speed_target(source: Source, element: Element) -> float | None:
    """Return the speed that a <SpeedActionTarget> asks for, in m/s; None: it is not understood, and noted."""
    target = source.one(element)
    if target.name != "AbsoluteTargetSpeed":
        source.refuse(target, "not understood: an AbsoluteTargetSpeed")
        return None
    return source.number(target, "value", 0.0, MOST_MPS)


def private_action(source: Source, element: Element, entity: Entity, lane_m: float) -> dict[str, Any] | None:
    """Return a <PrivateAction> as the plain values of an act, without its trigger; None: noted as not understood.

    Args:
        source: the file.
        element: the action.
        entity: whose.
        lane_m: how wide a lane is.

    Raises:
        ProfileError: it cannot be read.
    """
    kind = source.one(element)
    if kind.name not in ("LongitudinalAction", "LateralAction", "RoutingAction"):
        source.refuse(kind)
        return None
    action = source.one(kind)
    if action.name == "SpeedAction":
        return _speed(source, action)
    if action.name == "LaneChangeAction":
        return _lane_change(source, action, entity, lane_m)
    if action.name == "LaneOffsetAction":
        return _lane_offset(source, action)
    if action.name == "FollowTrajectoryAction":
        return _trajectory(source, action, entity)
    source.refuse(action)
    return None


def _two(source: Source, element: Element, first: str, second: str) -> tuple[Element, Element]:
    found = {child.name: child for child in source.children(element, first, second)}
    if len(found) != 2:
        raise source.error(element, f"a <{first}> and a <{second}> in it")
    return found[first], found[second]


def _speed(source: Source, element: Element) -> dict[str, Any] | None:
    dynamics, target = _two(source, element, "SpeedActionDynamics", "SpeedActionTarget")
    speed_mps = speed_target(source, target)
    shape = source.text(dynamics, "dynamicsShape")
    dimension = source.text(dynamics, "dynamicsDimension")
    if shape not in ("step", "linear") or dimension not in ("time", "rate"):
        source.refuse(dynamics, "not understood: dynamicsShape step, or linear by time or rate")
        return None
    if speed_mps is None:
        return None
    found: dict[str, Any] = {"speed_kmh": 3.6 * speed_mps, "accel_mps2": STEP_MPS2}
    if shape == "linear" and dimension == "rate":
        found["accel_mps2"] = source.number(dynamics, "value", 0.001, STEP_MPS2)
    elif shape == "linear":
        duration_s = source.number(dynamics, "value", 0.0, 600.0)
        if duration_s:
            found = {"speed_kmh": found["speed_kmh"], "over_s": duration_s}
    return found


def _lane_change(source: Source, element: Element, entity: Entity, lane_m: float) -> dict[str, Any] | None:
    dynamics, target = _two(source, element, "LaneChangeActionDynamics", "LaneChangeTarget")
    lane = source.one(target)
    if lane.name != "RelativeTargetLane":
        source.refuse(lane, "not understood: a RelativeTargetLane")
        return None
    if source.text(lane, "entityRef") != entity.name:
        source.refuse(lane, "not understood: a lane relative to the vehicle's own")
        return None
    if source.text(dynamics, "dynamicsDimension") != "time":
        source.refuse(dynamics, "not understood: dynamicsDimension time")
        return None
    if source.text(dynamics, "dynamicsShape") not in _SMOOTH:
        source.note(dynamics, "driven as cubic")
    offset_m = source.number(element, "targetLaneOffset", -20.0, 20.0, 0.0)
    lanes = source.number(lane, "value", -5.0, 5.0)
    return {
        "lateral_m": lanes * lane_m + offset_m,
        "relative": True,
        "over_s": source.number(dynamics, "value", 0.001, 600.0),
    }


def _lane_offset(source: Source, element: Element) -> dict[str, Any] | None:
    dynamics, target = _two(source, element, "LaneOffsetActionDynamics", "LaneOffsetTarget")
    goal = source.one(target)
    if goal.name != "AbsoluteTargetLaneOffset":
        source.refuse(goal, "not understood: an AbsoluteTargetLaneOffset")
        return None
    if "maxLateralAcc" in dynamics.attributes:
        source.note(dynamics, "maxLateralAcc: it takes 3 s")
    return {"lateral_m": source.number(goal, "value", -100.0, 100.0)}


def _trajectory(source: Source, element: Element, entity: Entity) -> dict[str, Any] | None:
    if source.number(element, "initialDistanceOffset", 0.0, 1e6, 0.0):
        source.refuse(element, "not understood: initialDistanceOffset")
        return None
    path: Element | None = None
    for child in source.children(element, "TrajectoryRef", "Trajectory", "TimeReference", "TrajectoryFollowingMode"):
        if child.name == "TrajectoryRef":
            path = source.only(child, "Trajectory")
        elif child.name == "Trajectory":
            path = child
        elif child.name == "TimeReference" and not _is_plain(source, child):
            return None
    if path is None:
        raise source.error(element, "a <Trajectory> in it")
    if source.choice(path, "closed", {"false": "", "0": "", "true": "true", "1": "true"}):
        source.refuse(path, "not understood: a trajectory that is closed")
        return None
    shape = source.one(source.only(path, "Shape"))
    if shape.name != "Polyline":
        source.refuse(shape, "not understood: a Polyline")
        return None
    return _vertices(source, shape, entity)


def _is_plain(source: Source, element: Element) -> bool:
    """Return whether times count from the beginning of the action, as they stand."""
    timing = source.one(element)
    plain = timing.name == "Timing" and source.text(timing, "domainAbsoluteRelative") == "relative"
    if not plain or source.number(timing, "scale", 0.0, 1e6) != 1.0 or source.number(timing, "offset", -1e6, 1e6):
        source.refuse(timing, "not understood: a Timing that is relative, by 1 and 0")
        return False
    return True


def _vertices(source: Source, element: Element, entity: Entity) -> dict[str, Any] | None:
    places: list[tuple[float, Place]] = []
    for vertex in source.children(element, "Vertex"):
        time_s = source.number(vertex, "time", 0.0, 86_400.0)
        if places and time_s <= places[-1][0]:
            raise source.error(vertex, f"time: value {time_s:g}: later than the vertex before")
        place = position(source, source.only(vertex, "Position"))
        if place is None:
            return None
        places.append((time_s, place))
    if not 2 <= len(places) <= 1000:
        raise source.error(element, f"{len(places)} <Vertex> in it: 2 to 1000")
    found = []
    for at, (time_s, place) in enumerate(places):
        one, two = (places[at], places[at + 1]) if at + 1 < len(places) else (places[at - 1], places[at])
        way = math.atan2(two[1].y_m - one[1].y_m, two[1].x_m - one[1].x_m)
        x_m, y_m = place.middle(entity.ahead_m, way if place.yaw_rad is None else place.yaw_rad)
        vertex_values: dict[str, Any] = {"time_s": time_s, "x_m": x_m, "y_m": y_m}
        if place.yaw_rad is not None:
            vertex_values["yaw_deg"] = math.degrees(math.remainder(place.yaw_rad, math.tau))
        found.append(vertex_values)
    return {"trajectory": found}
