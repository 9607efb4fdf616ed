"""What one step of SUMO's traffic costs with 200 vehicles round the ego, and what of that is SUMO's and what ours.

Run: python benchmarks/sumo_step.py [--vehicles N] [--period MS] [--steps N] [--backend libsumo|traci]

On a grid of netgenerate's with 64 signals and two lanes a direction, the ego in its middle. Without `--vehicles` 50,
200 and 1000 vehicles; of them those within the radius are read, and a table holds at most 256. Demand is made for four
times as long, since ways end a little early; the least that was read in any step is printed.

Told are medians in processor time of this process and, behind traci, of SUMO's too (other programs on the machine do
not count, but for what they take of caches), and by the clock. The parts: SUMO's step with what it collects for the
subscription; the same demand's step where nothing is subscribed to; Python objects of what was collected; and the
rest, which is the console's: the ego put there, others smoothed and put into a table, signals. Behind traci the
parts are by the clock only, and objects are made in the step.
"""

import argparse
import math
import os
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, NamedTuple

from simconsole.profiles.traffic import SumoProfile, TrafficProfile
from simconsole.world.roads.road_map import ROAD
from simconsole.world.sumo.net_reader import read_net
from simconsole.world.sumo.netconvert import netconvert
from simconsole.world.sumo_traffic import sumo_traffic
from simconsole.world.sumo_traffic.sumo_traffic import SumoTraffic, Surroundings
from simconsole.world.traffic.road_users import CAPACITY, Box

_CITY: Final = (
    "--grid", "--grid.number", "8", "--grid.length", "120", "--default.lanenumber", "2",
    "--default-junction-type", "traffic_light",
)  # fmt: skip
_HZ: Final = 1000
_DOMAINS: Final = ("edge", "person", "poi", "route", "simulation", "trafficlight", "vehicle", "vehicletype")
_STEP, _OBJECTS, _WHOLE = "simulationStep", "getContextSubscriptionResults", "whole"


class Cost(NamedTuple):
    """What something took (ms)."""

    busy: float  # processor time
    clock: float

    def less(self, other: "Cost") -> "Cost":
        return Cost(self.busy - other.busy, self.clock - other.clock)


class Round(NamedTuple):
    """The steps of one drive."""

    seen: int  # read in each step at least
    steps: list[dict[str, Cost]]


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--vehicles", type=int, action="append")
    parser.add_argument("--period", type=int, default=50, help="ms from step to step")
    parser.add_argument("--steps", type=int, default=600)
    parser.add_argument("--backend", choices=["libsumo", "traci"], default="libsumo")
    given = parser.parse_args()
    net = _city()
    print(f"{given.steps} steps of {given.period} ms, {given.backend}; processor time, (by the clock):")
    for vehicles in given.vehicles or (50, 200, 1000):
        drives = [_driven(net, vehicles, given, subscribes=subscribes) for subscribes in (True, False)]
        print(f"  {vehicles} vehicles, {drives[0].seen} read at least")
        _tell(*drives, inline=given.backend == "libsumo")


def _tell(drive: Round, alone: Round, *, inline: bool) -> None:
    rest = [one[_WHOLE].less(one[_STEP]).less(one[_OBJECTS]) for one in drive.steps]
    lines = {
        "a whole step": [one[_WHOLE] for one in drive.steps],
        "SUMO's step": [one[_STEP] for one in drive.steps],
        "the same without a subscription": [one[_STEP] for one in alone.steps],
        "Python objects": [one[_OBJECTS] for one in drive.steps],
        "ours": rest,
    }
    for name, costs in lines.items():
        said = []
        for place, known in ((0, inline or name == "a whole step"), (1, True)):
            times = sorted(cost[place] for cost in costs)
            p99 = times[math.ceil(0.99 * len(times)) - 1]
            said.append(f"{statistics.median(times):6.2f} ms, p99 {p99:6.2f} ms" if known else f"{'-':>21s}")
        print(f"    {name:32s} median {said[0]} ({said[1]})")


def _city() -> bytes:
    program = netconvert()
    assert program is not None, "the extra `sumo`"
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "city.net.xml"
        words = [program.replace("netconvert", "netgenerate"), *_CITY, "--output-file", str(path)]
        subprocess.run(words, check=True, capture_output=True)
        return path.read_bytes()


class Meter:
    """Times the parts of one step after the other."""

    def __init__(self) -> None:
        self.steps: list[dict[str, Cost]] = []
        self.process: subprocess.Popen[bytes] | None = None

    def begin(self) -> None:
        self.steps.append(dict.fromkeys((_STEP, _OBJECTS, _WHOLE), Cost(0.0, 0.0)))

    def timed(self, part: str, call: Callable[..., Any], *given: Any) -> Any:
        if not self.steps:
            return call(*given)
        before = self._now()
        found = call(*given)
        own, now = self.steps[-1], self._now().less(before)
        own[part] = Cost(own[part].busy + now.busy, own[part].clock + now.clock)
        return found

    def _now(self) -> Cost:
        """Return the processor time of this process and of SUMO's, which is told in ticks of the system's clock."""
        busy_ms, clock_ms = 1e3 * time.process_time(), 1e3 * time.perf_counter()
        if self.process is None:
            return Cost(busy_ms, clock_ms)
        fields = Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        return Cost(busy_ms + 1e3 * (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK"), clock_ms)


class Watched:
    """SUMO, or a domain of its, with a meter at the calls that are parts; one that subscribes to nothing if need be."""

    def __init__(self, inner: Any, meter: Meter, *, subscribes: bool) -> None:
        self._inner, self._meter, self._subscribes = inner, meter, subscribes

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._inner, name)
        if name in _DOMAINS:
            return Watched(found, self._meter, subscribes=self._subscribes)
        if not self._subscribes and "Context" in name:
            return lambda *_: {}
        if name in (_STEP, _OBJECTS):
            return lambda *given: self._meter.timed(name, found, *given)
        return found


def _driven(net: bytes, vehicles: int, given: argparse.Namespace, *, subscribes: bool) -> Round:
    sumo = SumoProfile(vehicles=vehicles, radius_m=2000.0, backend=given.backend, warm_up_s=20.0)
    profile = TrafficProfile(seed=1, period_ms=given.period, sumo=sumo)
    duration_s = 0.001 * given.period * given.steps
    road_map = read_net(net, "city.net.xml")
    edge = min(
        (edge for edge in road_map.edges if edge.function == ROAD),
        key=lambda edge: float(abs(road_map.lanes[edge.lanes[0]].line[0, :2] - 420.0).sum()),
    )
    (x, y, _), (to_x, to_y, _) = road_map.lanes[edge.lanes[0]].line[[0, -1]].tolist()
    way_m, heading = math.hypot(to_x - x, to_y - y), math.atan2(to_y - y, to_x - x)

    def at(step: int) -> Box:
        share = 0.1 + 0.8 * step / given.steps
        return Box(x + share * (to_x - x), y + share * (to_y - y), heading, 0.8 * way_m / duration_s, 4.4, 1.8)

    meter, opens = Meter(), vars(sumo_traffic)
    opened = opens["open_engine"]

    def watched(*words: Any) -> Any:
        engine = opened(*words)
        return engine._replace(sumo=Watched(engine.sumo, meter, subscribes=subscribes))

    around = Surroundings(road_map=road_map, net=net, legs=(), tick_hz=_HZ, egos=(at(0),), duration_s=4.0 * duration_s)
    opens["open_engine"] = watched
    try:
        traffic = SumoTraffic(profile, around)
    finally:
        opens["open_engine"] = opened
    seen, meter.process = CAPACITY, traffic.process
    try:
        for step in range(given.steps):
            meter.begin()
            seen = min(seen, len(meter.timed(_WHOLE, traffic.step, at(step))))
        assert traffic.lost is None, traffic.lost
        assert traffic.ego_error_m == 0.0
    finally:
        meter.process = None
        traffic.close()
    return Round(seen, meter.steps)


if __name__ == "__main__":
    main()
