"""Controllers of an OpenSCENARIO file: when that of the console's vehicle is switched on."""

from typing import Any, Final

from simconsole.evaluation.openscenario.entities import UNUSED
from simconsole.evaluation.openscenario.reading import Source
from simconsole.world.sumo.xml_guard import Element

BOOLEANS: Final = {"true": "true", "1": "true", "false": "", "0": ""}
_AXES: Final = ("lateral", "longitudinal")
_OWN: Final = {"at_s", "at_distance_m", "near", "above_mps", "below_mps", "delay_s"}
"""Triggers that mean the same of an event of the console as of an act: those of its vehicle alone."""


def is_activation(action: Element) -> bool:
    """Return whether a <PrivateAction> does nothing but switch a controller."""
    kinds = [child.name for child in action.children]
    inner = [part.name for child in action.children for part in child.children]
    return kinds == ["ActivateControllerAction"] or (kinds, inner) == (
        ["ControllerAction"],
        ["ActivateControllerAction"],
    )


def switched(source: Source, element: Element) -> bool | None:
    """Return whether a <ControllerAction>, or an <ActivateControllerAction> alone, switches a controller on or off.

    None: neither, or noted as not understood. Which controller it is changes nothing, and is noted.

    Raises:
        ProfileError: it cannot be read.
    """
    if element.name == "ActivateControllerAction":
        return _both(source, element, "{}")
    found: bool | None = None
    for part in source.children(
        element, "AssignControllerAction", "ActivateControllerAction", "OverrideControllerValueAction"
    ):
        if part.name == "AssignControllerAction":
            source.note(part, UNUSED)
            now = (
                _both(source, part, "activate{}")
                if any(name.startswith("activate") for name in part.attributes)
                else None
            )
        elif part.name == "ActivateControllerAction":
            now = _both(source, part, "{}")
        else:
            now = None
            for value in part.children:
                if source.choice(value, "active", BOOLEANS):
                    source.refuse(value)
        found = found if now is None else now
    return found


def _both(source: Source, element: Element, named: str) -> bool | None:
    """Return whether both axes are switched on or off; None: only one of them, or one each, and noted."""
    names = [named.format(axis if named == "{}" else axis.capitalize()) for axis in _AXES]
    on = {source.choice(element, name, BOOLEANS) for name in names if name in element.attributes}
    if len(on) != 1 or not all(name in element.attributes for name in names):
        source.refuse(element, f"not understood: {' and '.join(names)}, both true or both false")
        return None
    return bool(on.pop())


def console_event(source: Source, action: Element, trigger: dict[str, Any]) -> dict[str, Any] | None:
    """Return a <PrivateAction> that switches the controller of the console's vehicle as an event of a scenario.

    None: it is not understood, and noted.

    Raises:
        ProfileError: it cannot be read.
    """
    on = switched(source, source.one(action))
    if on is None:
        return None
    if not on:
        source.refuse(action, "not understood: a controller that is switched on: nobody else drives after it")
        return None
    # From standstill: neither a speed nor a distance that was driven is so when it is first looked at.
    rises = trigger.get("above_mps", 0.0) > 0.0 or trigger.get("at_distance_m", 0.0) > 0.0
    own = {key: value for key, value in trigger.items() if key != "rising" or not rises}
    if own.keys() - _OWN:
        source.refuse(
            action, "not understood: a time, or the speed, the way or the place of the console's vehicle alone"
        )
        return None
    return {**own, "event": "request_autonomous"}
