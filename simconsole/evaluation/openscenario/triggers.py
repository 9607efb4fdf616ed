"""Triggers of an OpenSCENARIO file as those of an actor's act."""

from collections.abc import Mapping
from typing import Any, Final

from simconsole.evaluation.openscenario.entities import Entity, position
from simconsole.evaluation.openscenario.reading import Source
from simconsole.world.sumo.xml_guard import Element

_MORE: Final = {"greaterThan": "more", "greaterOrEqual": "more"}
_LESS: Final = {"lessThan": "less", "lessOrEqual": "less"}
_EDGES: Final = {"rising": "rising", "none": "none", "falling": "", "risingOrFalling": ""}
DAY_S: Final = 86_400.0


class Names:
    """Who is who in the file: the console's vehicle, and the actors."""

    def __init__(self, source: Source, ego: str, known: Mapping[str, Entity]) -> None:
        self._source, self._ego, self._known = source, ego, known

    def of(self, element: Element) -> str | None:
        """Return the actor of an entityRef, None for the console's vehicle.

        Raises:
            ProfileError: there is no such entity.
        """
        name = self._source.text(element, "entityRef")
        if name == self._ego:
            return None
        if name not in self._known:
            raise self._source.error(element, f"entityRef: value {name!a}: an entity of the file")
        return self._known[name].label


def conditions(source: Source, element: Element | None, names: Names) -> dict[str, Any] | None:
    """Return a trigger as plain values: at most one condition, and times before which it is not looked at.

    None: it is not understood, and noted. No trigger at all is one that comes at once.

    Raises:
        ProfileError: it cannot be read.
    """
    if element is None or not element.children:
        return {"at_s": 0.0}
    if len(element.children) > 1 and element.children[0].name == "ConditionGroup":
        source.refuse(element.children[1], "not understood: one group of conditions, that is no `or`")
        return None
    group = source.only(element, "ConditionGroup")
    before_s, found = 0.0, []
    for condition in source.children(group, "Condition"):
        delay_s = source.number(condition, "delay", 0.0, DAY_S, 0.0)
        one = _condition(source, condition, names)
        one = None if one is None else _with_edge(source, condition, one, len(group.children) == 1)
        if one is None:
            return None
        if "at_s" in one and len(group.children) > 1:
            before_s = max(before_s, one["at_s"] + delay_s)
        else:
            found.append({**one, "delay_s": delay_s} if delay_s else one)
    if len(found) > 1:
        source.refuse(group, "not understood: one condition beside those of time")
        return None
    if not found:
        return {"at_s": before_s}
    return {**found[0], "not_before_s": before_s} if before_s else found[0]


def _with_edge(source: Source, element: Element, found: dict[str, Any], alone: bool) -> dict[str, Any] | None:
    """Return a condition with its edge; None: an edge that its trigger has not, and noted.

    A time rises once. A speed below a limit has risen. All others are or are not, and rise if asked to.
    """
    edge = source.choice(element, "conditionEdge", _EDGES, "none")
    if not edge:
        source.refuse(element, "not understood: conditionEdge rising or none")
    elif "at_s" in found:
        if edge == "none" or alone:
            return found
        source.refuse(element, "not understood: conditionEdge none, of a time beside another condition")
    elif "below_mps" in found:
        if edge == "rising":
            return found
        source.refuse(element, "not understood: conditionEdge rising, of a speed below a limit")
    else:
        return {**found, "rising": True} if edge == "rising" else found
    return None


def only_time(source: Source, element: Element | None, names: Names) -> float | None:
    """Return when a trigger comes that knows nothing but simulated time; None: it is another, and noted."""
    found = conditions(source, element, names)
    if found is None:
        return None
    if element is not None and "at_s" not in found:
        source.refuse(element, "not understood here: a SimulationTimeCondition")
        return None
    return float(found["at_s"]) + float(found.get("delay_s", 0.0))


def _condition(source: Source, element: Element, names: Names) -> dict[str, Any] | None:
    kind = source.one(element)
    if kind.name == "ByValueCondition":
        inner = source.one(kind)
        if inner.name != "SimulationTimeCondition":
            source.refuse(inner)
            return None
        source.choice(inner, "rule", _MORE)
        return {"at_s": source.number(inner, "value", 0.0, DAY_S)}
    if kind.name != "ByEntityCondition":
        source.refuse(kind)
        return None
    who, what = None, None
    for child in source.children(kind, "TriggeringEntities", "EntityCondition"):
        if child.name == "EntityCondition":
            what = source.one(child)
        else:
            source.choice(child, "triggeringEntitiesRule", {"any": "any", "all": "all"})
            who = source.only(child, "EntityRef")
    if who is None or what is None:
        raise source.error(kind, "a <TriggeringEntities> and an <EntityCondition> in it")
    found = _of_entity(source, what, names)
    if found is None:
        return None
    label = names.of(who)
    return found if label is None else {**found, "of": label}


def _of_entity(source: Source, element: Element, names: Names) -> dict[str, Any] | None:
    name = element.name
    if name == "SpeedCondition":
        if "direction" in element.attributes:
            source.refuse(element, "not understood: a speed without a direction")
            return None
        passed = source.choice(element, "rule", {**_MORE, **_LESS})
        lowest = 0.0 if passed == "more" else 0.001
        value = source.number(element, "value", lowest, 100.0)
        return {"above_mps" if passed == "more" else "below_mps": value}
    if name == "TraveledDistanceCondition":
        return {"at_distance_m": source.number(element, "value", 0.0, 1e6)}
    if name == "ReachPositionCondition":
        place = position(source, source.only(element, "Position"))
        radius_m = source.number(element, "tolerance", 0.001, 1000.0)
        return None if place is None else {"near": {"x_m": place.x_m, "y_m": place.y_m, "radius_m": radius_m}}
    if name == "DistanceCondition":
        source.choice(element, "rule", _LESS)
        if not _is_straight(source, element, "euclidianDistance"):
            return None
        place = position(source, source.only(element, "Position"))
        radius_m = source.number(element, "value", 0.001, 1000.0)
        return None if place is None else {"near": {"x_m": place.x_m, "y_m": place.y_m, "radius_m": radius_m}}
    if name == "RelativeDistanceCondition":
        source.choice(element, "rule", _LESS)
        if not _is_straight(source, element):
            return None
        limit: dict[str, Any] = {"gap_below_m": source.number(element, "value", 0.001, 150.0)}
        return {**limit, **_other(source, element, element, names)}
    if name == "TimeHeadwayCondition":
        source.choice(element, "rule", _LESS)
        limit = {"headway_below_s": source.number(element, "value", 0.001, 60.0)}
        return {**limit, **_other(source, element, element, names)}
    if name == "TimeToCollisionCondition":
        source.choice(element, "rule", _LESS)
        target = source.one(source.only(element, "TimeToCollisionConditionTarget"))
        if target.name != "EntityRef":
            source.refuse(target, "not understood: an EntityRef")
            return None
        limit = {"collision_below_s": source.number(element, "value", 0.001, 60.0)}
        return {**limit, **_other(source, element, target, names)}
    source.refuse(element)
    return None


def _is_straight(source: Source, element: Element, default: str | None = None) -> bool:
    """Return whether a distance is that of two points, and not one along a road or a vehicle."""
    if source.text(element, "relativeDistanceType", default) in ("cartesianDistance", "euclidianDistance"):
        return True
    source.refuse(element, "not understood: relativeDistanceType euclidianDistance or cartesianDistance")
    return False


def _other(source: Source, element: Element, named: Element, names: Names) -> dict[str, Any]:
    """Return the other one of a gap, and whether it is measured from bumper to bumper."""
    free = source.choice(element, "freespace", {"true": "true", "1": "true", "false": "", "0": ""}, "false")
    other = names.of(named)
    found: dict[str, Any] = {} if other is None else {"to": other}
    return {**found, "bumper_to_bumper": True} if free else found
