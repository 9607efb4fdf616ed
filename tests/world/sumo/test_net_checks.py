import pytest

from simconsole.world.sumo.net_checks import MAX_POINTS, Unfit, check, name, number, points, whole
from simconsole.world.sumo.xml_guard import Element


def element(tag: str = "lane", *children: Element, **attributes: str) -> Element:
    return Element(tag, 1, attributes, list(children))


@pytest.mark.parametrize("text", ["nan", "inf", "", "x", "1e999", "-0.1", "10.1"])
def test_number_is_finite_and_in_its_range(text: str) -> None:
    with pytest.raises(Unfit, match=r"^a: value .*: 0 to 10$"):
        number(element(a=text), "a", 0.0, 10.0)


def test_number_may_have_a_default() -> None:
    assert number(element(), "a", 0.0, 10.0, 3.2) == 3.2
    assert number(element(a="4"), "a", 0.0, 10.0, 3.2) == 4.0


@pytest.mark.parametrize("text", ["-1", "1.0", "\u0661", "999999999999999999", "", "101"])
def test_whole_number_is_one(text: str) -> None:
    with pytest.raises(Unfit, match="a whole number, 0 to 100"):
        whole(element(a=text), "a", 100)


@pytest.mark.parametrize("text", ["", "a b", "a" * 201, "a\u202eb"])
def test_name_is_one(text: str) -> None:
    with pytest.raises(Unfit, match="a name of 1 to 200 characters"):
        name(element(a=text), "a")


@pytest.mark.parametrize("text", ["1,1", "1,1 2", "1,1 2,nan", "1,1 1e8,0", "1,2,3,4 5,6", "1,1 " * (MAX_POINTS + 1)])
def test_points_are_points(text: str) -> None:
    with pytest.raises(Unfit):
        points(element(a=text), "a", 2)


def test_points_may_have_heights() -> None:
    assert points(element(a="1,2 3,4,5"), "a", 2) == [(1.0, 2.0), (3.0, 4.0, 5.0)]


LANE = {"id": "a_0", "index": "0", "speed": "10", "length": "5", "shape": "0,0 5,0"}
EDGE = {"id": "a", "from": "b", "to": "c"}


def test_whole_edge_passes_and_one_wrong_lane_takes_it_all() -> None:
    check(element("edge", element("lane", **LANE), **EDGE))
    with pytest.raises(Unfit, match="lane index: value 0: 1"):
        check(element("edge", element("lane", **LANE), element("lane", **LANE), **EDGE))


@pytest.mark.parametrize("lane", [{"shape": "1,1 1,1"}, {"width": "0"}, {"index": "7"}, {"speed": "-1"}, {"id": ""}])
def test_lane_that_cannot_be_used(lane: dict[str, str]) -> None:
    with pytest.raises(Unfit):
        check(element("edge", element("lane", **{**LANE, **lane}), **EDGE))


def test_lane_inside_a_junction_may_have_no_length() -> None:
    inside = element("lane", **{**LANE, "shape": "1,1 1,1"})
    check(element("edge", inside, id=":b_0", function="internal"))


def test_phases_of_a_program_have_as_many_letters() -> None:
    program = {"id": "a", "programID": "0", "type": "static", "offset": "0"}
    check(element("tlLogic", element("phase", duration="5", state="rG"), **program))
    for state in ("rGr", "", "q!"):
        other = element("phase", duration="5", state=state)
        with pytest.raises(Unfit):
            check(element("tlLogic", element("phase", duration="5", state="rG"), other, **program))
