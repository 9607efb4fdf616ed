"""People of our demand as a real SUMO moves them: on pavements and crossings, and nowhere else."""

import subprocess
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from simconsole.world.roads.road_map import CROSSING, ROAD
from simconsole.world.sumo.net_reader import read_net
from simconsole.world.sumo_traffic.demand import demand
from simconsole.world.sumo_traffic.engines import sumo_program
from simconsole.world.sumo_traffic.walks import pavements_of, walks
from tests.world.nets import TOWN, generated, straight_map
from tests.world.sumo_traffic.on_sumo import NET

CLEAR_M = 1.0
"""From the middle of a lane, which is 3.2 m wide at least. In generated towns corners reach into turning ways."""
SECONDS = 240


def places(net: bytes, folder: Path, count: int) -> list[tuple[str, str, float, float]]:
    """Who was where in each second: name, edge, x, y (SUMO's m)."""
    road_map = read_net(net, "map")
    (folder / "map.net.xml").write_bytes(net)
    text = demand(road_map, vehicles=0, pedestrians=count, seed=7, horizon_s=float(SECONDS))
    (folder / "people.rou.xml").write_text(text)
    program = sumo_program()
    assert program is not None
    options = ["--step-length", "1", "--end", str(SECONDS), "--fcd-output", "fcd.xml", "--no-step-log"]
    options += ["--xml-validation", "never", "--xml-validation.net", "never", "--xml-validation.routes", "never"]
    words = [program, "-n", "map.net.xml", "-r", "people.rou.xml", *options]
    ran = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    assert not ran.stderr
    return [
        (str(one.get("id")), str(one.get("edge")), float(str(one.get("x"))), float(str(one.get("y"))))
        for one in ElementTree.parse(folder / "fcd.xml").getroot().iter("person")
    ]


@pytest.mark.parametrize("kind", ["urban", "town"])
def test_nobody_walks_on_the_carriageway_but_over_crossings(tmp_path: Path, kind: str) -> None:
    net = NET.read_bytes() if kind == "urban" else generated(*TOWN)
    road_map = read_net(net, "map")
    crossings = {edge.id for edge in road_map.edges if edge.function == CROSSING}
    driven = []
    for lane in road_map.lanes:
        if lane.drivable and (kind == "urban" or road_map.edges[lane.edge].function == ROAD):
            way = np.concatenate(((0.0,), np.cumsum(np.hypot(*np.diff(lane.line[:, :2], axis=0).T))))
            at = np.linspace(0.0, way[-1], int(way[-1]) + 2)
            driven.append(np.column_stack([np.interp(at, way, lane.line[:, axis]) for axis in (0, 1)]))
    on_lanes = np.vstack(driven) + road_map.moved_m
    on_lanes = on_lanes[np.argsort(on_lanes[:, 0])]
    found = places(net, tmp_path, 40)
    crossed, last = 0, {name for name, *_ in found[-40:]}
    assert len(last) == 40, "nobody has come to an end"
    for _, edge, x, y in found[::4]:
        if edge in crossings:
            crossed += 1
        else:
            first, end = np.searchsorted(on_lanes[:, 0], (x - CLEAR_M, x + CLEAR_M), side="left")
            assert (np.hypot(*(on_lanes[first : end + 1] - (x, y)).T) > CLEAR_M).all(), (edge, x, y)
    assert crossed > 12


def test_people_turn_round_only_where_no_way_leads_on() -> None:
    road_map = read_net(NET.read_bytes(), NET.name)
    ways = pavements_of(road_map)
    names = {place: edge.id for place, edge in enumerate(road_map.edges)}
    ends = {"-junction0left", "junction0left", "-junction0right", "junction0right", "-junction1left", "junction1left"}
    ends |= {"-junction1right", "junction1right", "road3", "-road3", "road4", "-road4"}
    for seed in range(20):
        done = walks(ways, np.random.default_rng(seed), 3000.0)
        assert {names[walk.edges[-1]] for walk in done[:-1]} <= ends
        assert all(before.edges[-1] == after.edges[0] for before, after in pairwise(done))


def test_pavements_of_a_map_without_any() -> None:
    assert not pavements_of(straight_map()).pavements
    assert all(edge.function != CROSSING for edge in straight_map().edges if edge.function == ROAD)
