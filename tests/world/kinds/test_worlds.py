from pathlib import Path

import pytest

from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.world import RoadsProfile
from simconsole.values.errors import ProfileError
from simconsole.world.kinds.worlds import open_map, open_world, route_length_m, route_points
from tests.world.nets import STRAIGHT

SQUARE = '<additional><poly id="a" type="building.house" shape="0,10 5,10 5,15 0,15"/><x/></additional>'


@pytest.mark.parametrize("name", ["urban", "urban_signals", "motorway", "country", "skid_pad"])
def test_every_shipped_world_gives_a_route_and_a_drawing(name: str) -> None:
    world = open_world(load_world(name))
    assert world.route.length_m > 800.0
    assert len(world.drawing.surfaces) > 50
    assert len(world.drawing.path) > 800
    assert world.route.closed == (name == "urban")
    profile = load_world(name)
    if isinstance(profile, RoadsProfile):
        assert open_map(profile).report.skipped == ()
        assert Path(profile.map.name).stat().st_size < 1_000_000


def test_the_arena_is_a_world_like_the_others() -> None:
    world = open_world(load_world("arena"))
    assert world.route.length_m > 20.0
    assert len(world.drawing.walls) > 5
    assert route_points(load_world("arena"))[0] == (0.8, 0.8, pytest.approx(0.6747, abs=1e-3))


def test_urban_network_has_what_the_course_has() -> None:
    course, network = (open_world(load_world(name)).route for name in ("urban", "urban_signals"))
    assert network.length_m == pytest.approx(course.length_m, rel=0.002)
    kinds = [mark.kind for mark in network.landmarks]
    assert {kind: kinds.count(kind) for kind in set(kinds)} == {"roundabout": 1, "traffic lights": 1, "crossing": 6}


def test_country_road_has_hills_and_skid_pad_has_cones() -> None:
    country, pad = (load_world(name) for name in ("country", "skid_pad"))
    assert isinstance(country, RoadsProfile)
    assert isinstance(pad, RoadsProfile)
    heights = [height for lane in open_map(country).lanes for height in lane.line[:, 2].tolist()]
    assert max(heights) - min(heights) > 30.0
    assert [thing.kind for thing in open_map(pad).obstacles] == ["cone"] * 28


def test_nothing_is_the_route_of_no_world() -> None:
    assert route_points(None) == ()
    assert route_length_m(None) == 0.0


def test_one_world_is_built_once() -> None:
    assert open_world(load_world("urban")) is open_world(load_world("urban"))


def test_polygons_lie_beside_the_map_and_their_report_joins_its(tmp_path: Path) -> None:
    far = STRAIGHT.replace("-1.6", "5340000.4")
    (tmp_path / "m.net.xml").write_text(far)
    (tmp_path / "m.poly.xml").write_text(SQUARE.replace(",1", ",534000"))
    (tmp_path / "w.yaml").write_text(
        "schema: 1\nkind: roads\ntitle: t\nmap: {name: m.net.xml}\npolygons: {name: m.poly.xml}\n"
        "route: {by: random, seed: 1}\n"
    )
    profile = load_world(str(tmp_path / "w.yaml"))
    assert isinstance(profile, RoadsProfile)
    found = open_map(profile)
    assert [thing.outline.tolist() for thing in found.obstacles] == [[[0.0, 0.0], [5.0, 0.0], [5.0, 5.0], [0.0, 5.0]]]
    assert [part.element for part in found.report.skipped] == ["x"]


def test_map_that_changes_after_it_was_named_is_refused(tmp_path: Path) -> None:
    (tmp_path / "m.net.xml").write_text(STRAIGHT)
    (tmp_path / "w.yaml").write_text(
        "schema: 1\nkind: roads\ntitle: t\nmap: {name: m.net.xml}\nroute: {by: random, seed: 1}\n"
    )
    profile = load_world(str(tmp_path / "w.yaml"))
    (tmp_path / "m.net.xml").write_text(STRAIGHT.replace("13.89", "27.78"))
    with pytest.raises(ProfileError, match="value with another sha256"):
        open_world(profile)
