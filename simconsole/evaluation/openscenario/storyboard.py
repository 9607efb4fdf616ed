"""The storyboard of an OpenSCENARIO file: how everybody begins, and what they do when."""

from collections.abc import Iterator, Mapping
from typing import Any, Final, NamedTuple

from simconsole.evaluation.openscenario.actions import private_action, speed_target
from simconsole.evaluation.openscenario.controllers import BOOLEANS, console_event, is_activation, switched
from simconsole.evaluation.openscenario.entities import UNUSED, Entity, Place, position
from simconsole.evaluation.openscenario.reading import DECLARATIONS, Source
from simconsole.evaluation.openscenario.triggers import Names, conditions, only_time
from simconsole.world.sumo.xml_guard import Element

_ONCE: Final = 1.0
_PRIORITIES: Final = {"override": "replaces", "overwrite": "replaces", "skip": "", "parallel": ""}
"""Whether an event replaces those of its maneuver that run; so do our acts."""


class Beginning(NamedTuple):
    """How an entity begins."""

    place: Place | None
    speed_mps: float
    active: bool = True  # its controller


class Told(NamedTuple):
    """A storyboard as plain values."""

    beginnings: dict[str, Beginning]  # by entity
    acts: dict[str, list[dict[str, Any]]]  # likewise; those of the console's vehicle are events of the scenario
    end_s: float | None


def storyboard(source: Source, element: Element, ego: str, known: Mapping[str, Entity], lane_m: float) -> Told:
    """Return what a <Storyboard> tells; what is not understood is noted in `source`.

    Raises:
        ProfileError: it cannot be read.
    """
    names = Names(source, ego, known)
    beginnings: dict[str, Beginning] = {}
    acts: dict[str, list[dict[str, Any]]] = {name: [] for name in known}
    end_s = None
    for child in source.children(element, "Init", "Story", "StopTrigger"):
        if child.name == "Init":
            beginnings = _beginnings(source, child, ego, known)
        elif child.name == "StopTrigger":
            end_s = only_time(source, child, names) if child.children else None
        else:
            with source.scope(child):
                for name, act in _story(source, child, names, ego, known, lane_m):
                    acts[name].append(act)
    return Told(beginnings, acts, end_s)


def _beginnings(source: Source, element: Element, ego: str, known: Mapping[str, Entity]) -> dict[str, Beginning]:
    found: dict[str, Beginning] = {}
    for child in source.children(source.only(element, "Actions"), "Private"):
        name = source.text(child, "entityRef")
        if name not in known:
            raise source.error(child, f"entityRef: value {name!a}: an entity of the file")
        before = found.get(name, Beginning(None, 0.0))
        for action in source.children(child, "PrivateAction"):
            before = _begins(source, source.one(action), before)
            if name != ego and is_activation(action):
                source.note(action, UNUSED)
        found[name] = before
    return found


def _begins(source: Source, element: Element, before: Beginning) -> Beginning:
    if element.name == "TeleportAction":
        return before._replace(place=position(source, source.only(element, "Position")) or before.place)
    if element.name == "LongitudinalAction":
        action = source.one(element)
        if action.name == "SpeedAction":
            targets = [child for child in action.children if child.name == "SpeedActionTarget"]
            if len(targets) != 1:
                raise source.error(action, f"{len(targets)} <SpeedActionTarget> in it: one")
            return before._replace(speed_mps=speed_target(source, targets[0]) or 0.0)
        source.refuse(action)
        return before
    if element.name in ("ControllerAction", "ActivateControllerAction"):
        on = switched(source, element)
        return before if on is None else before._replace(active=on)
    source.refuse(element)
    return before


def _story(
    source: Source, element: Element, names: Names, ego: str, known: Mapping[str, Entity], lane_m: float
) -> Iterator[tuple[str, dict[str, Any]]]:
    for act in source.children(element, "Act", DECLARATIONS):
        if act.name == DECLARATIONS:
            continue
        groups, begins_s = [], 0.0
        for child in source.children(act, "ManeuverGroup", "StartTrigger", "StopTrigger"):
            if child.name == "ManeuverGroup":
                groups.append(child)
            elif child.name == "StartTrigger":
                begins_s = only_time(source, child, names) or 0.0
            elif child.children:
                source.refuse(child, "not understood: an act that runs to its end")
        for group in groups:
            for name, event in _events(source, group, ego, known):
                for found in _acts(source, event, None if name == ego else known[name], names, lane_m, begins_s):
                    yield name, found


def _later(act: dict[str, Any], begins_s: float) -> dict[str, Any]:
    """Return an act that is not looked at before its own time and that of the act it is in."""
    if "at_s" in act:
        return {**act, "at_s": max(float(act["at_s"]), begins_s)}
    before_s = max(float(act.get("not_before_s", 0.0)), begins_s)
    return {**act, "not_before_s": before_s} if before_s else act


def _events(source: Source, element: Element, ego: str, known: Mapping[str, Entity]) -> Iterator[tuple[str, Element]]:
    """Yield the events of a group of maneuvers for each of its actors that the scenario moves."""
    actors: list[str] = []
    if source.number(element, "maximumExecutionCount", 1.0, 1e6, _ONCE) != _ONCE:
        source.refuse(element, "not understood: maximumExecutionCount 1")
    for child in source.children(element, "Actors", "Maneuver"):
        if child.name == "Actors":
            if source.choice(child, "selectTriggeringEntities", BOOLEANS, "false"):
                source.refuse(child, "not understood: actors by name")
            for named in source.children(child, "EntityRef"):
                name = source.text(named, "entityRef")
                if name == ego and not _only_switches(element):
                    source.refuse(named, "the console's vehicle is driven from its seat, or by a controller")
                elif name not in known:
                    raise source.error(named, f"entityRef: value {name!a}: an entity of the file")
                else:
                    actors.append(name)
            continue
        events = [event for event in source.children(child, "Event", DECLARATIONS) if event.name == "Event"]
        with source.scope(child):
            for event in events:
                if not source.choice(event, "priority", _PRIORITIES, "override") and len(events) > 1:
                    source.refuse(event, "not understood: priority override, of several events")
                    continue
                yield from ((name, event) for name in actors)


def _only_switches(group: Element) -> bool:
    """Return whether nothing happens in a group of maneuvers but that a controller is switched on or off."""
    events = [event for maneuver in group.children for event in maneuver.children if event.name == "Event"]
    actions = [action for event in events for action in event.children if action.name == "Action"]
    return all(is_activation(one) for action in actions for one in action.children)


def _acts(
    source: Source, element: Element, entity: Entity | None, names: Names, lane_m: float, begins_s: float
) -> Iterator[dict[str, Any]]:
    """Yield what an event does: acts of an actor, or without an `entity` what happens to the console's vehicle."""
    if source.number(element, "maximumExecutionCount", 1.0, 1e6, _ONCE) != _ONCE:
        source.refuse(element, "not understood: maximumExecutionCount 1")
    trigger: dict[str, Any] | None = {"at_s": 0.0}
    actions = []
    for child in source.children(element, "Action", "StartTrigger"):
        if child.name == "StartTrigger":
            trigger = conditions(source, child, names)
        else:
            actions.append(source.one(child))
    for action in actions:
        if action.name != "PrivateAction":
            source.refuse(action)
            continue
        when = {} if trigger is None else _later(trigger, begins_s)
        if entity is None:
            found = console_event(source, action, when)
        else:
            found = private_action(source, action, entity, lane_m)
        if found is not None and trigger is not None:
            yield found if entity is None else {**when, **found}
