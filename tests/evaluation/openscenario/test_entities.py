"""Entities: their names as actors, their kinds and sizes, and where their middles are."""

import math

import pytest

from simconsole.evaluation.openscenario.entities import Place, actor, entities, position
from simconsole.evaluation.openscenario.reading import Source
from simconsole.values.errors import ProfileError
from simconsole.world.sumo.xml_guard import Element
from tests.evaluation.openscenario.elements import LEAD, element, place


def vehicle(name: str, *more: Element, category: str = "car") -> Element:
    size = element("Dimensions", length="4.5", width="1.8", height="1.5")
    box = element("BoundingBox", element("Center", x="1.4", y="0", z="0.75"), size)
    return element("ScenarioObject", element("Vehicle", box, vehicleCategory=category), *more, name=name)


def test_each_entity_is_an_actor_with_a_name_of_its_own() -> None:
    source = Source("a.xosc")
    found = entities(source, element("Entities", vehicle("car 1"), vehicle("car?1", category="truck"), vehicle("2")))
    assert [(name, one.label, one.kind) for name, one in found.items()] == [
        ("car 1", "car_1", "car"),
        ("car?1", "car_1_1", "van"),
        ("2", "_2", "car"),
    ]
    assert found["car 1"][3:] == (4.5, 1.8, 1.5, 1.4)
    assert source.left == []


def test_who_controls_it_is_noted_and_changes_nothing() -> None:
    source = Source("a.xosc")
    controlled = vehicle("Lead", element("ObjectController", element("Controller", name="theirs")))
    assert list(entities(source, element("Entities", controlled))) == ["Lead"]
    assert [(one.element, one.changes) for one in source.left] == [("ObjectController", False)]


@pytest.mark.parametrize(
    ("objects", "told"),
    [
        ((vehicle("Lead"), vehicle("Lead")), "name: value 'Lead': another name for each"),
        ((element("ScenarioObject", name="Lead"),), "a <Vehicle> or a <Pedestrian> in it"),
        ((vehicle("Lead", category="tram"),), "vehicleCategory: value tram: "),
        (
            (element("ScenarioObject", element("Vehicle", vehicleCategory="car"), name="Lead"),),
            "0 <BoundingBox> in it: one",
        ),
    ],
)
def test_what_is_no_entity_is_refused(objects: tuple[Element, ...], told: str) -> None:
    with pytest.raises(ProfileError) as error:
        entities(Source("a.xosc"), element("Entities", *objects))
    assert told in str(error.value)


def test_an_actor_stands_where_the_middle_of_its_box_is() -> None:
    made = actor(LEAD, Place(40.0, 2.0, 1.5 * math.pi), 10.0)
    assert (made["x_m"], made["y_m"], made["yaw_deg"]) == pytest.approx((40.0, 2.0 - 1.4, -90.0))
    assert made["speed_kmh"] == pytest.approx(36.0)
    assert actor(LEAD, Place(40.0, 2.0, None), 0.0)["x_m"] == pytest.approx(41.4), "it looks along x"


def test_a_position_on_a_road_is_noted() -> None:
    source = Source("a.xosc")
    assert position(source, place(3.0, -4.0)) == Place(3.0, -4.0, None)
    assert position(source, place(3.0, -4.0, h="0.5")) == Place(3.0, -4.0, 0.5)
    assert position(source, element("Position", element("LanePosition", s="3"))) is None
    assert [one.element for one in source.left] == ["LanePosition"]
