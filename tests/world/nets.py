"""Road maps that nobody made by hand: netgenerate's, and small ones written out."""

import subprocess
from functools import cache
from pathlib import Path

from simconsole.world.roads.road_map import RoadMap
from simconsole.world.sumo.net_reader import read_net
from simconsole.world.sumo.netconvert import netconvert

GRID = ("--grid", "--grid.number", "8", "--grid.length", "120", "--default.lanenumber", "2", "--turn-lanes", "1")
CITY = (*GRID, "--default-junction-type", "traffic_light", "--sidewalks.guess", "--crossings.guess")
"""Some 450 edges with 64 signals, 3 lanes before each, sidewalks and crossings."""
TOWN = ("--rand", "--rand.iterations", "120", "--seed", "5", "--tls.guess", "--sidewalks.guess", "--crossings.guess")
"""Some 340 edges that meet at all angles."""
SMALL = ("--grid", "--grid.number", "3", "--grid.length", "80", "--tls.guess")

STRAIGHT = """<net version="1.20">
 <location netOffset="0.00,0.00" convBoundary="0,0,200,0" origBoundary="0,0,200,0" projParameter="!"/>
 <edge id=":B_0" function="internal">
  <lane id=":B_0_0" index="0" speed="13.89" length="10" shape="95,-1.6 105,-1.6"/>
 </edge>
 <edge id="AB" from="A" to="B" priority="1">
  <lane id="AB_0" index="0" speed="13.89" length="95" shape="0,-1.6 95,-1.6"/>
 </edge>
 <edge id="BC" from="B" to="C" priority="1">
  <lane id="BC_0" index="0" speed="8.33" length="95" shape="105,-1.6 200,-1.6"/>
 </edge>
 <junction id="A" type="dead_end" x="0" y="0" incLanes="" intLanes="" shape="0,0 0,-3.2"/>
 <junction id="B" type="priority" x="100" y="0" incLanes="AB_0" intLanes=":B_0_0" shape="95,0 105,0 105,-3.2 95,-3.2"/>
 <junction id="C" type="dead_end" x="200" y="0" incLanes="BC_0" intLanes="" shape="200,0 200,-3.2"/>
 <connection from="AB" to="BC" fromLane="0" toLane="0" via=":B_0_0" dir="s" state="M"/>
 <connection from=":B_0" to="BC" fromLane="0" toLane="0" dir="s" state="M"/>
</net>
"""
"""Two edges in a line, 95 m each, with a junction of 10 m between them."""


@cache
def generated(*options: str) -> bytes:
    """Return the network that netgenerate makes."""
    program = netconvert()
    assert program is not None, "SUMO's programs are missing: eclipse-sumo"
    words = [program.replace("netconvert", "netgenerate"), *options, "--output-file", "/dev/stdout"]
    done = subprocess.run([*words, "--no-warnings"], capture_output=True, check=True, cwd=Path("/"))
    start, end = done.stdout.index(b"<?xml"), done.stdout.rindex(b"</net>")
    return done.stdout[start : end + len(b"</net>")]


@cache
def generated_map(*options: str) -> RoadMap:
    """Return the map of it."""
    return read_net(generated(*options), "generated.net.xml")


def straight_map() -> RoadMap:
    """Return the map of STRAIGHT."""
    return read_net(STRAIGHT.encode(), "straight.net.xml")
