"""What one step of SUMO's traffic costs with 200 vehicles round the ego: the ego put there, stepped, read, converted.

Run: python benchmarks/sumo_step.py [--vehicles N] [--period MS] [--steps N] [--backend libsumo|traci]

On a grid of netgenerate's with 64 signals and two lanes a direction, the ego in its middle. Processor time of this
process and, behind traci, of SUMO's too: other programs on the machine do not count. Without `--vehicles` 50, 200 and
1000 vehicles; of them those within the radius are read, and a table holds at most 256. Demand is made for four
times as long, since ways end a little early; the least that was read in any step is printed.
"""

import argparse
import math
import os
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

from simconsole.profiles.traffic import SumoProfile, TrafficProfile
from simconsole.world.roads.road_map import ROAD
from simconsole.world.sumo.net_reader import read_net
from simconsole.world.sumo.netconvert import netconvert
from simconsole.world.sumo_traffic.sumo_traffic import SumoTraffic, Surroundings
from simconsole.world.traffic.road_users import CAPACITY, Box

_CITY = (
    "--grid", "--grid.number", "8", "--grid.length", "120", "--default.lanenumber", "2",
    "--default-junction-type", "traffic_light",
)  # fmt: skip
_HZ = 1000


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--vehicles", type=int, action="append")
    parser.add_argument("--period", type=int, default=50, help="ms from step to step")
    parser.add_argument("--steps", type=int, default=600)
    parser.add_argument("--backend", choices=["libsumo", "traci"], default="libsumo")
    given = parser.parse_args()
    net = _city()
    print(f"{given.steps} steps of {given.period} ms, {given.backend}, processor time:")
    for vehicles in given.vehicles or (50, 200, 1000):
        seen, times_ms = _stepped(net, vehicles, given.period, given.steps, given.backend)
        times_ms.sort()
        p99 = times_ms[math.ceil(0.99 * len(times_ms)) - 1]
        print(
            f"  {vehicles:5d} vehicles, {seen:3d} read at least: median {statistics.median(times_ms):6.2f} ms,"
            f" mean {statistics.fmean(times_ms):6.2f} ms, p99 {p99:6.2f} ms a step"
        )


def _city() -> bytes:
    program = netconvert()
    assert program is not None, "the extra `sumo`"
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "city.net.xml"
        words = [program.replace("netconvert", "netgenerate"), *_CITY, "--output-file", str(path)]
        subprocess.run(words, check=True, capture_output=True)
        return path.read_bytes()


def _stepped(net: bytes, vehicles: int, period_ms: int, steps: int, backend: str) -> tuple[int, list[float]]:
    """Return how many were read in each step at least, and what each step cost (ms)."""
    road_map = read_net(net, "city.net.xml")
    edge = min(
        (edge for edge in road_map.edges if edge.function == ROAD),
        key=lambda edge: (
            abs(road_map.lanes[edge.lanes[0]].line[0, 0] - 420.0)
            + abs(road_map.lanes[edge.lanes[0]].line[0, 1] - 420.0)
        ),
    )
    (x, y, _), (to_x, to_y, _) = road_map.lanes[edge.lanes[0]].line[[0, -1]].tolist()
    way_m = math.hypot(to_x - x, to_y - y)
    sumo = SumoProfile(vehicles=vehicles, radius_m=2000.0, backend=backend, warm_up_s=20.0)  # type: ignore[arg-type]
    profile = TrafficProfile(seed=1, period_ms=period_ms, sumo=sumo)
    duration_s = 0.001 * period_ms * steps

    def at(step: int) -> Box:
        share = 0.1 + 0.8 * step / steps
        heading = math.atan2(to_y - y, to_x - x)
        return Box(x + share * (to_x - x), y + share * (to_y - y), heading, 0.8 * way_m / duration_s, 4.4, 1.8)

    around = Surroundings(road_map=road_map, net=net, legs=(), tick_hz=_HZ, egos=(at(0),), duration_s=4.0 * duration_s)
    traffic = SumoTraffic(profile, around)
    seen, times_ms = CAPACITY, []
    try:
        for step in range(steps):
            place, began_ms = at(step), _busy_ms(traffic)
            users = traffic.step(place)
            times_ms.append(_busy_ms(traffic) - began_ms)
            seen = min(seen, len(users))
        assert traffic.lost is None, traffic.lost
        assert traffic.ego_error_m == 0.0
    finally:
        traffic.close()
    return seen, times_ms


def _busy_ms(traffic: SumoTraffic) -> float:
    """Return the processor time of this process and of SUMO's (ms; of the latter in steps of the system's clock)."""
    own_ms = 1e3 * time.process_time()
    if traffic.process is None:
        return own_ms
    fields = Path(f"/proc/{traffic.process.pid}/stat").read_text().rpartition(")")[2].split()
    return own_ms + 1e3 * (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


if __name__ == "__main__":
    main()
