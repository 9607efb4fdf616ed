"""The plan of a course: parts by their names, and what is refused."""

import pytest

from simconsole.profiles.course_plan import CoursePlan, Curve, PlannedIntersection, Straight
from simconsole.profiles.files.loader import parse
from tests.profiles.refused import refusal

HEAD = "schema: 1\ntitle: t\nlane_width_m: 3.5\nspeed_limit_kmh: 50\nlength_m: 600\nelements:\n"
FREE = "- {element: straight, length_m: free}\n"
CURVE = "- {element: curve, radius_m: 20, angle_deg: 90}\n"


def test_each_element_is_of_the_kind_that_it_names() -> None:
    crossing = "- {element: straight, length_m: 50, features: [{feature: intersection, at_m: 20, signalled: false}]}\n"
    first, second, third = parse(HEAD + FREE + CURVE + crossing, CoursePlan, "f.yaml").elements
    assert first == Straight(length_m="free")
    assert isinstance(second, Curve)
    assert third == Straight(length_m=50.0, features=(PlannedIntersection(at_m=20.0, signalled=False),))


@pytest.mark.parametrize(
    ("last", "told"),
    [
        ("- {element: straight, length_m: long}\n", "elements[2].length_m: "),
        ("- {element: straight, length_m: 0}\n", "elements[2].length_m: value 0: "),
        ("- {element: curve, radius_m: 7, angle_deg: 90}\n", "elements[2].radius_m: value 7: "),
        ("- {element: curve, radius_m: 8, angle_deg: 181}\n", "elements[2].angle_deg: value 181: "),
        ("- {element: roundabout, radius_m: 18, entry_radius_m: 25, turn_deg: -91}\n", "elements[2].turn_deg: "),
        ("- {element: bridge}\n", "bridge"),
        ("- {element: straight, length_m: 9, features: [{feature: crossing, at_m: -1}]}\n", "at_m: value -1: "),
        ("- {element: straight, length_m: 9, radius_m: 9}\n", "elements[2].radius_m: value 9: unknown key"),
    ],
)
def test_what_cannot_be_meant_is_refused(last: str, told: str) -> None:
    assert told in refusal(HEAD + FREE + CURVE + last, CoursePlan)


def test_a_plan_has_elements() -> None:
    assert "elements: " in refusal(HEAD.replace("elements:", "elements: []"), CoursePlan)


def test_an_open_course_has_no_length_of_its_own() -> None:
    plan = parse(HEAD.replace("length_m: 600\n", "") + CURVE, CoursePlan, "f.yaml")
    assert plan.length_m is None
