"""Controllers: which elements switch one, and when that is an event of the console."""

from typing import Any

import pytest

from simconsole.evaluation.openscenario.controllers import console_event, is_activation, switched
from simconsole.evaluation.openscenario.reading import Source
from simconsole.world.sumo.xml_guard import Element
from tests.evaluation.openscenario.elements import element


def activation(lateral: str, longitudinal: str) -> Element:
    return element("ActivateControllerAction", lateral=lateral, longitudinal=longitudinal)


def assigned(**attributes: str) -> Element:
    return element("ControllerAction", element("AssignControllerAction", **attributes))


@pytest.mark.parametrize(
    ("action", "on"),
    [
        (activation("true", "1"), True),
        (activation("false", "0"), False),
        (element("ControllerAction", activation("true", "true")), True),
        (assigned(activateLateral="true", activateLongitudinal="true"), True),
        (assigned(), None),
    ],
)
def test_a_controller_is_switched_on_both_axes(action: Element, on: bool | None) -> None:
    source = Source("a.xosc")
    assert switched(source, action) is on
    assert not [one for one in source.left if one.changes]


@pytest.mark.parametrize(
    "action",
    [
        activation("true", "false"),
        element("ActivateControllerAction", lateral="true"),
        assigned(activateLateral="true"),
    ],
)
def test_half_a_controller_is_noted(action: Element) -> None:
    source = Source("a.xosc")
    assert switched(source, action) is None
    assert all(one.why.startswith("not understood: ") for one in source.left if one.changes)
    assert any(one.changes for one in source.left)


def test_only_a_switch_alone_is_an_activation() -> None:
    on = activation("true", "true")
    assert is_activation(element("PrivateAction", on))
    assert is_activation(element("PrivateAction", element("ControllerAction", on)))
    assert not is_activation(element("PrivateAction", element("ControllerAction", on, on)))
    assert not is_activation(element("PrivateAction", element("LongitudinalAction")))


@pytest.mark.parametrize(
    ("trigger", "event"),
    [
        ({"at_s": 3.0}, {"at_s": 3.0}),
        ({"above_mps": 5.0, "rising": True}, {"above_mps": 5.0}),
        ({"above_mps": 0.0, "rising": True}, None),
        ({"gap_below_m": 10.0}, None),
        ({"at_s": 3.0, "not_before_s": 5.0}, None),
    ],
)
def test_the_consoles_controller_is_asked_for_by_its_own_vehicle_alone(
    trigger: dict[str, Any], event: dict[str, Any] | None
) -> None:
    source = Source("a.xosc")
    found = console_event(source, element("PrivateAction", activation("true", "true")), trigger)
    assert found == (None if event is None else {**event, "event": "request_autonomous"})
    assert [one.element for one in source.left] == ([] if event else ["PrivateAction"])


def test_nobody_drives_after_a_controller_that_is_switched_off() -> None:
    source = Source("a.xosc")
    assert console_event(source, element("PrivateAction", activation("false", "false")), {"at_s": 3.0}) is None
    assert "switched on" in source.left[0].why
