"""Actions as acts: how fast, how far aside, along which way."""

import math
from typing import Any

import pytest

from simconsole.evaluation.openscenario.actions import STEP_MPS2, private_action
from simconsole.evaluation.openscenario.reading import Source
from simconsole.values.errors import ProfileError
from simconsole.world.sumo.xml_guard import Element
from tests.evaluation.openscenario.elements import LEAD, element, place

LANE_M = 3.5


def speed(shape: str, dimension: str, value: str) -> Element:
    dynamics = element("SpeedActionDynamics", dynamicsShape=shape, dynamicsDimension=dimension, value=value)
    target = element("SpeedActionTarget", element("AbsoluteTargetSpeed", value="5"))
    return element("LongitudinalAction", element("SpeedAction", dynamics, target))


def lane_change(lanes: str, shape: str = "cubic", of: str = "Lead", dimension: str = "time") -> Element:
    dynamics = element("LaneChangeActionDynamics", dynamicsShape=shape, dynamicsDimension=dimension, value="4")
    target = element("LaneChangeTarget", element("RelativeTargetLane", entityRef=of, value=lanes))
    return element("LateralAction", element("LaneChangeAction", dynamics, target, targetLaneOffset="0.2"))


def trajectory(*vertices: Element) -> Element:
    path = element("Trajectory", element("Shape", element("Polyline", *vertices)), closed="false")
    return element("RoutingAction", element("FollowTrajectoryAction", path))


def vertex(time: float, where: Element) -> Element:
    return element("Vertex", where, time=str(time))


def act_of(source: Source, action: Element) -> dict[str, Any] | None:
    return private_action(source, element("PrivateAction", action), LEAD, LANE_M)


@pytest.mark.parametrize(
    ("words", "how"),
    [
        (("step", "time", "0"), {"accel_mps2": STEP_MPS2}),
        (("linear", "rate", "2.5"), {"accel_mps2": 2.5}),
        (("linear", "time", "4"), {"over_s": 4.0}),
        (("linear", "time", "0"), {"accel_mps2": STEP_MPS2}),
    ],
)
def test_a_speed_is_reached_at_once_by_a_rate_or_over_a_time(
    words: tuple[str, str, str], how: dict[str, float]
) -> None:
    assert act_of(Source("a.xosc"), speed(*words)) == {"speed_kmh": pytest.approx(18.0), **how}


def test_a_lane_to_the_right_is_a_negative_way_aside_and_a_line_is_driven_as_a_curve() -> None:
    source = Source("a.xosc")
    found = act_of(source, lane_change("-1", shape="linear"))
    assert found == {"lateral_m": pytest.approx(0.2 - LANE_M), "relative": True, "over_s": 4.0}
    assert [(one.why, one.changes) for one in source.left] == [("driven as cubic", False)]


@pytest.mark.parametrize(
    ("action", "left"),
    [
        (speed("cubic", "time", "4"), "SpeedActionDynamics"),
        (lane_change("1", of="Ego"), "RelativeTargetLane"),
        (lane_change("1", dimension="distance"), "LaneChangeActionDynamics"),
        (element("VisibilityAction"), "VisibilityAction"),
    ],
)
def test_what_is_not_understood_is_noted_and_no_act(action: Element, left: str) -> None:
    source = Source("a.xosc")
    assert act_of(source, action) is None
    assert [(one.element, one.changes) for one in source.left] == [(left, True)]


def test_the_middle_follows_a_trajectory_along_its_way_or_its_headings() -> None:
    vertices = (vertex(0.0, place(0, 0)), vertex(2.0, place(0, 10)), vertex(4.0, place(10, 10, h="0.5")))
    found = act_of(Source("a.xosc"), trajectory(*vertices))
    assert found is not None
    first, second, third = found["trajectory"]
    assert (first["x_m"], first["y_m"]) == pytest.approx((0.0, 1.4)), "to the north, as its way"
    assert (second["x_m"], second["y_m"]) == pytest.approx((1.4, 10.0)), "to the east, where it goes from there"
    assert (third["x_m"], third["y_m"]) == pytest.approx((10 + 1.4 * math.cos(0.5), 10 + 1.4 * math.sin(0.5)))
    assert ("yaw_deg" in second, third["yaw_deg"]) == (False, pytest.approx(math.degrees(0.5)))


@pytest.mark.parametrize(
    ("vertices", "told"),
    [
        ((vertex(0.0, place(0, 0)),), "1 <Vertex> in it: 2 to 1000"),
        ((vertex(1.0, place(0, 0)), vertex(1.0, place(9, 0))), "time: value 1: later than the vertex before"),
    ],
)
def test_a_trajectory_that_goes_nowhere_is_refused(vertices: tuple[Element, ...], told: str) -> None:
    with pytest.raises(ProfileError, match=told):
        act_of(Source("a.xosc"), trajectory(*vertices))
