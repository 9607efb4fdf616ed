"""Networks from strangers: what fits is read, what does not is told, what is hostile is refused."""

import json
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from simconsole.values.errors import ProfileError
from simconsole.world.sumo.net_reader import MAX_TOLD, read_net
from tests.paths import ROOT
from tests.patience import PATIENCE_S
from tests.samples import Sample
from tests.world.nets import CITY, STRAIGHT, generated

BATCH = 10
CPU_S = 2.0
MEMORY_MB = 500.0


def changed(old: str, new: str) -> bytes:
    assert old in STRAIGHT
    return STRAIGHT.replace(old, new).encode()


def test_mutated_maps_are_refused_by_one_line_or_loaded(sample: Sample, tmp_path: Path) -> None:
    count = sample.of(10, 300)
    path = tmp_path / "city.net.xml"
    path.write_bytes(generated(*CITY))
    counts, most_cpu_s, memory_mb = Counter[str](), 0.0, 0.0
    for batch in range(count // BATCH):  # each ends long before what would hang for ever is ended
        words = [sys.executable, "-m", "tests.world.sumo.mutations", f"{sample.seed + batch}", f"{BATCH}", str(path)]
        done = subprocess.run(words, capture_output=True, text=True, cwd=ROOT, timeout=PATIENCE_S)
        assert done.returncode == 0, done.stderr
        seen = json.loads(done.stdout.splitlines()[-1])
        counts.update(seen["counts"])
        most_cpu_s, memory_mb = max(most_cpu_s, seen["most_cpu_s"]), max(memory_mb, seen["memory_mb"])
    print(f"measured: {count} mutated maps: {dict(counts)}, at most {most_cpu_s:.2f} s of CPU time, {memory_mb:.0f} MB")
    assert counts.total() == count
    assert counts["refused"] > 0
    assert counts["loaded with a report"] > 0
    assert most_cpu_s <= CPU_S
    assert memory_mb <= MEMORY_MB


def test_whole_map_leaves_nothing_out() -> None:
    found = read_net(STRAIGHT.encode(), "straight.net.xml")
    assert found.report.skipped == ()
    assert dict(found.report.counts)["lanes for cars"] == 2
    (one,) = found.connections
    assert [found.lanes[lane].id for lane in (one.from_lane, *one.via, one.to_lane)] == ["AB_0", ":B_0_0", "BC_0"]
    assert found.lanes[one.to_lane].limit_mps == 8.33


@pytest.mark.parametrize(
    ("old", "new", "line", "element", "reason"),
    [
        ('speed="8.33"', 'speed="nan"', "10", "edge", "speed: value nan: 0 to 200"),
        ('speed="8.33"', "", "10", "edge", "speed: value missing: 0 to 200"),
        ('id="BC" from', 'id="AB" from', "9", "edge", "id: value AB: a name that no other edge has"),
        ('shape="105,-1.6 200,-1.6"', 'shape="1,1 1,1"', "9", "edge", "shape: value 1,1 1,1: two different points"),
        ('toLane="0" via', 'toLane="7" via', "15", "connection", "not understood"),
        (
            'to="BC" fromLane="0" toLane="0" via',
            'to="D" fromLane="0" toLane="0" via',
            "15",
            "connection",
            "to: value D",
        ),
        ("</net>", "<taz/></net>", "17", "taz", "not an element that is read"),
    ],
)
def test_what_does_not_fit_is_left_out_and_told(old: str, new: str, line: str, element: str, reason: str) -> None:
    found = read_net(changed(old, new), "f.net.xml")
    told = [part for part in found.report.skipped if reason in part.reason]
    assert [part.element for part in told] == [element]
    assert any(lane.drivable for lane in found.lanes)


def test_report_stays_readable() -> None:
    content = changed("</net>", "<odd/>" * 5000 + "</net>")
    skipped = read_net(content, "f.net.xml").report.skipped
    assert len(skipped) == MAX_TOLD + 1
    assert skipped[-1].reason == f"{5000 - MAX_TOLD} more; all in all 5000 <odd>"
    many = changed("</net>", "".join(f"<odd{number}/>" for number in range(5000)) + "</net>")
    assert len(read_net(many, "f.net.xml").report.skipped[-1].reason) < 300


def test_map_without_a_lane_for_cars_is_refused() -> None:
    content = STRAIGHT.replace('speed="', 'disallow="all" speed="').encode()
    with pytest.raises(ProfileError, match=r"^f.net.xml: <net>: no lane for cars: at least one$"):
        read_net(content, "f.net.xml")


def test_places_far_from_the_origin_come_near() -> None:
    far = STRAIGHT.replace("-1.6", "5340000.4").replace("0,0.00", "0,0.00")
    found = read_net(far.encode(), "f.net.xml")
    assert found.moved_m == (0.0, 5_340_000.0)
    assert found.lanes[0].line[0].tolist() == pytest.approx([95.0, 0.4, 0.0])
    assert found.geo.offset_y_m == -5_340_000.0


def test_signals_have_programs_and_links() -> None:
    found = read_net(generated(*CITY), "city.net.xml")
    counts = dict(found.report.counts)
    assert counts["edges"] >= 400
    assert counts["signals"] >= 60
    assert counts["crossings"] > 100
    for signal in found.signals:
        links = {one.link for one in found.connections if one.signal >= 0 and found.signals[one.signal] is signal}
        for program in signal.programs:
            assert all(max(links) < len(phase.state) for phase in program.phases)
    assert any(edge.crossed for edge in found.edges)
