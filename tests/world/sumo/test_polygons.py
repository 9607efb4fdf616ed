import numpy as np
import pytest

from simconsole.values.errors import ProfileError
from simconsole.world.sumo.polygons import TRUNK_M, read_polygons

TEXT = b"""<additional>
<poly id="a" type="building" shape="0,0 4,0 4,3"/>
<poly id="b" type="landuse" shape="0,0 4,0 4,3"/>
<poly id="c" type="cone" shape="0,0 x,0 4,3"/>
<poly id="d" type="building.house" geo="1" shape="16,48 16,49 17,48"/>
<poly id="e" type="barrier.fence" shape="0,9 4,9 4,12"/>
<poi id="f" type="natural.tree" x="7" y="8"/>
<poi id="g" type="shop" x="7" y="8"/>
<poi id="h" type="wall" x="7" y="8"/>
<poly id="i" type="wall" shape="0,0 90000,0"/>
</additional>"""


def test_buildings_are_read_and_what_is_wrong_is_told() -> None:
    things, skipped = read_polygons(TEXT, "f.poly.xml")
    assert [thing.kind for thing in things] == ["building", "wall", "tree"]
    assert things[0].outline.tolist() == [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]]
    assert things[1].outline.tolist() == [[0.0, 9.0], [4.0, 9.0], [4.0, 12.0], [4.0, 9.0]], "there and back"
    assert np.hypot(*(things[2].outline - (7.0, 8.0)).T) == pytest.approx(np.full(8, TRUNK_M))
    assert [part.place for part in skipped] == ["4", "5", "9", "10"]
    assert skipped[-1].reason == "shape: value of 180000 m round it: at most 100000"


def test_outlines_of_all_things_together_have_an_end() -> None:
    one = '<poly type="building" shape="0,0 24000,0 24000,24000 0,24000"/>'
    things, skipped = read_polygons(f"<additional>{one * 150}</additional>".encode(), "f.poly.xml")
    assert len(things) == 104, "10,000 km of 96 km each"
    assert len(skipped) == 46


def test_what_is_no_such_file_is_refused() -> None:
    with pytest.raises(
        ProfileError, match=r"^f\.poly\.xml: line 1: <net>: value net: <additional> as the first element$"
    ):
        read_polygons(b"<net/>", "f.poly.xml")
