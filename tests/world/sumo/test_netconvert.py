import subprocess
from pathlib import Path

import pytest

from simconsole.values.errors import ProfileError
from simconsole.world.sumo import netconvert as module
from simconsole.world.sumo.netconvert import build, convert, netconvert
from simconsole.world.sumo.plain_xml import PlainEdge, PlainNetwork, PlainNode
from tests.world.nets import SMALL, generated

OSM = b"""<osm version="0.6">
 <node id="1" lat="48.2000" lon="16.3700"/><node id="2" lat="48.2010" lon="16.3720"/>
 <node id="3" lat="48.2030" lon="16.3710"><tag k="highway" v="traffic_signals"/></node>
 <node id="4" lat="48.2035" lon="16.3750"/>
 <way id="10"><nd ref="1"/><nd ref="2"/><nd ref="3"/><tag k="highway" v="residential"/></way>
 <way id="11"><nd ref="3"/><nd ref="4"/><tag k="highway" v="residential"/></way>
</osm>"""


def opendrive(folder: Path) -> bytes:
    program, net, out = netconvert(), folder / "n.net.xml", folder / "n.xodr"
    assert program is not None
    net.write_bytes(generated(*SMALL))
    subprocess.run([program, "-s", str(net), "--opendrive-output", str(out)], check=True, capture_output=True)
    return out.read_bytes()


def test_opendrive_comes_in_with_its_losses(tmp_path: Path) -> None:
    done = convert(opendrive(tmp_path), "town.xodr")
    assert dict(done.road_map.report.counts)["lanes for cars"] >= 20
    assert any("signal programs" in loss for loss in done.losses)


def test_openstreetmap_comes_in_on_the_earth() -> None:
    done = convert(OSM, "vienna.osm")
    assert dict(done.road_map.report.counts)["lanes for cars"] == 2
    assert "+proj=utm +zone=33" in done.road_map.geo.projection
    assert any("guessed by netconvert" in loss for loss in done.losses)


@pytest.mark.parametrize(
    ("content", "name", "told"),
    [
        (OSM, "map.txt", "map.txt: file: value .txt: one of .osm, .xodr"),
        (OSM, "map.xodr", "map.xodr: line 1: <osm>: value osm: <OpenDRIVE> as the first element"),
        (b"<!DOCTYPE osm [<!ENTITY a 'b'>]><osm/>", "map.osm", "map.osm: line 1: <!DOCTYPE>: refused"),
        (b"<osm/>", "map.osm", "map.osm: "),
    ],
)
def test_what_cannot_be_converted_is_refused_in_one_line(content: bytes, name: str, told: str) -> None:
    with pytest.raises(ProfileError) as caught:
        convert(content, name)
    assert str(caught.value).startswith(told)
    assert "\n" not in str(caught.value)


def test_missing_program_is_told_with_its_cure(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "netconvert", lambda: None)
    with pytest.raises(ProfileError, match="install the extra `sumo`"):
        convert(OSM, "map.osm")


def test_program_is_found_without_the_path(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    found = netconvert()
    assert found is not None
    assert Path(found).is_file()


def test_equal_plans_give_equal_networks() -> None:
    edge = PlainEdge(id="e", start="a", end="b", line=((0.0, 0.0), (50.0, 0.0)), limit_mps=10.0, width_m=3.0)
    network = PlainNetwork((PlainNode("a", 0.0, 0.0), PlainNode("b", 50.0, 0.0)), (edge,))
    first = build(network, "n")
    assert first == build(network, "n")
    assert b"/tmp" not in first
    assert b'id="e_0"' in first
