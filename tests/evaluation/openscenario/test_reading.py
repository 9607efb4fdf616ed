import pytest

from simconsole.evaluation.openscenario.reading import Source, parts_of
from simconsole.values.errors import ProfileError
from simconsole.world.sumo.xml_guard import Element


def element(**attributes: str) -> Element:
    return Element("Thing", 7, attributes, [Element("Known", 8, {}, []), Element("Odd", 9, {}, [])])


def test_numbers_words_and_parameters_are_read() -> None:
    source = Source("a.xosc")
    source.parameters["speed"] = "5.5"
    assert source.number(element(v="3"), "v", 0.0, 9.0) == 3.0
    assert source.number(element(v="$speed"), "v", 0.0, 9.0) == 5.5
    assert source.number(element(), "v", 0.0, 9.0, 2.0) == 2.0
    assert source.choice(element(v="car"), "v", {"car": "c"}) == "c"


@pytest.mark.parametrize(
    ("value", "told"),
    [
        ("10", "v: value 10: a number from 0 to 9"),
        ("nan", "v: value nan: a number from 0 to 9"),
        ("x", "v: value x: a number"),
        ("$none", "v: value $none: no such parameter"),
        ("${1+2}", "v: value ${1+2}: a value or a parameter, no expression"),
        (None, "v: value missing"),
    ],
)
def test_what_is_no_such_number_is_named_with_its_line(value: str | None, told: str) -> None:
    with pytest.raises(ProfileError) as error:
        Source("a.xosc").number(element() if value is None else element(v=value), "v", 0.0, 9.0)
    assert str(error.value).startswith(f"a.xosc: line 7: <Thing>: {told}")


def test_unknown_children_are_noted() -> None:
    source = Source("a.xosc")
    assert [child.name for child in source.children(element(), "Known")] == ["Known"]
    assert [str(one) for one in source.left] == ["line 9: <Odd>: not understood"]
    with pytest.raises(ProfileError, match="<Thing>: 0 <Other> in it: one"):
        source.only(element(), "Other")


def test_a_file_is_taken_apart_and_bombs_are_refused() -> None:
    assert list(parts_of(b"<OpenSCENARIO><FileHeader/><Entities/></OpenSCENARIO>", "a.xosc")) == [
        "FileHeader",
        "Entities",
    ]
    with pytest.raises(ProfileError, match="comes twice"):
        parts_of(b"<OpenSCENARIO><FileHeader/><FileHeader/></OpenSCENARIO>", "a.xosc")
    with pytest.raises(ProfileError, match="<!DOCTYPE>: refused"):
        parts_of(b'<!DOCTYPE a [<!ENTITY b "c">]><OpenSCENARIO/>', "a.xosc")
    with pytest.raises(ProfileError, match="nested more than 40 deep"):
        parts_of(b"<OpenSCENARIO>" + b"<a>" * 50 + b"</a>" * 50 + b"</OpenSCENARIO>", "a.xosc")
