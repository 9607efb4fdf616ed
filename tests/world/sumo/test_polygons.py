import pytest

from simconsole.values.errors import ProfileError
from simconsole.world.sumo.polygons import read_polygons

TEXT = b"""<additional>
<poly id="a" type="building" shape="0,0 4,0 4,3"/>
<poly id="b" type="landuse" shape="0,0 4,0 4,3"/>
<poly id="c" type="cone" shape="0,0 x,0 4,3"/>
<poly id="d" type="building.house" geo="1" shape="16,48 16,49 17,48"/>
</additional>"""


def test_buildings_are_read_and_what_is_wrong_is_told() -> None:
    outlines, skipped = read_polygons(TEXT, "f.poly.xml")
    assert [outline.tolist() for outline in outlines] == [[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]]]
    assert [part.place for part in skipped] == ["4", "5"]


def test_what_is_no_such_file_is_refused() -> None:
    with pytest.raises(
        ProfileError, match=r"^f\.poly\.xml: line 1: <net>: value net: <additional> as the first element$"
    ):
        read_polygons(b"<net/>", "f.poly.xml")
