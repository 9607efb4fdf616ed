"""Our speed advice beside SUMO's own device for it (device.glosa), on equal roads, demand and seeds.

Run: python benchmarks/speed_advice.py [--seeds N] [--first SEED] [--vehicles N] [--minutes M] [--keep FILE]

A grid of netgenerate's with fixed programs and 300 m between lights; every vehicle is equipped, or none. The device
gets our range and lower bound of speed. Vehicles of ours drive no faster than the advisor says, and slow down as gently
as it counts on; who prepares to stop rolls towards the line as the autopilot does. Told are means over all trips, and
the paired differences of seeds with their 95 % confidence interval: of both against none, and of ours against the
device's.
With `--keep` a run that was ended goes on where it was, with the same words.
"""

import argparse
import json
import statistics
import subprocess
import tempfile
from itertools import count
from pathlib import Path
from typing import Final, NamedTuple
from xml.etree.ElementTree import iterparse

import libsumo

from simconsole.world.rules.speed_advice import (
    DOWN_MPS2,
    LEAST_MPS,
    NO_ADVICE,
    REACH_M,
    Advised,
    Greens,
    SpeedAdvisor,
    rolling_mps,
)
from simconsole.world.rules.timetable import greens, state_of
from simconsole.world.sumo.netconvert import netconvert

_CITY: Final = (
    "--grid", "--grid.number", "4", "--grid.length", "300", "--grid.attach-length", "300",
    "--default-junction-type", "traffic_light", "--tls.default-type", "static", "--no-turnarounds", "true",
)  # fmt: skip
_STEP_S: Final = 0.5
_ANY_MPS: Final = 55.0
_LEAST_BOUND_MPS: Final = 0.01  # SUMO refuses none at all
_STOP_LINE_GAP_M: Final = 1.0
"""So far before the line vehicles of SUMO's stop."""
_WHO: Final = ("none", "device", "ours")
_T_95: Final = {4: 2.776, 9: 2.262, 19: 2.093, 29: 2.045}
"""Student's t, two-sided, by degrees of freedom."""


class Trips(NamedTuple):
    """Means over the trips of one simulation."""

    stops: float
    waiting_s: float
    time_loss_s: float
    duration_s: float
    fuel_g: float


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=10, choices=[one + 1 for one in _T_95])
    parser.add_argument("--first", type=int, default=1, metavar="SEED", help="seeds from this one on")
    parser.add_argument("--vehicles", type=int, default=300, help="an hour")
    parser.add_argument("--minutes", type=float, default=20.0)
    parser.add_argument("--keep", type=Path, help="a line for each seed that is done, JSON")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        net = _city(Path(folder))
        found: dict[str, list[Trips]] = {who: [] for who in _WHO}
        done = _kept(given.keep)
        for seed in range(given.first, given.first + given.seeds):
            if seed not in done:
                routes = _demand(net, Path(folder), seed, given.vehicles, 60.0 * given.minutes)
                done[seed] = [_simulated(who, net, routes, seed, Path(folder)) for who in _WHO]
                _keep(given.keep, seed, done[seed])
            for who, trips in zip(_WHO, done[seed], strict=True):
                found[who].append(trips)
    _tell(found)


def _kept(path: Path | None) -> dict[int, list[Trips]]:
    lines = path.read_text().splitlines() if path is not None and path.exists() else []
    return {seed: [Trips(*one) for one in trips] for seed, trips in map(json.loads, lines)}


def _keep(path: Path | None, seed: int, trips: list[Trips]) -> None:
    if path is not None:
        with path.open("a") as file:
            file.write(json.dumps([seed, trips]) + "\n")


def _city(folder: Path) -> Path:
    program = netconvert()
    assert program is not None, "the extra `sumo`"
    path = folder / "city.net.xml"
    words = [program.replace("netconvert", "netgenerate"), *_CITY, "--output-file", str(path)]
    subprocess.run(words, check=True, capture_output=True)
    return path


def _demand(net: Path, folder: Path, seed: int, vehicles: int, end_s: float) -> Path:
    """Write trips between fringe roads, drawn by the seed."""
    import numpy as np
    import sumolib

    rng, path = np.random.default_rng(seed), folder / "demand.rou.xml"
    edges = sumolib.net.readNet(str(net)).getEdges()
    entries = sorted(edge.getID() for edge in edges if not edge.getIncoming())
    exits = sorted(edge.getID() for edge in edges if not edge.getOutgoing())
    departs = sorted(rng.uniform(0.0, end_s, round(vehicles * end_s / 3600.0)).tolist())
    trips = [
        f'<trip id="{number}" depart="{depart_s:.2f}" from="{rng.choice(entries)}" to="{rng.choice(exits)}"'
        ' departSpeed="max" departLane="best"/>\n'
        for number, depart_s in zip(count(), departs, strict=False)
    ]
    path.write_text(f"<routes>\n{''.join(trips)}</routes>\n")
    return path


def _simulated(who: str, net: Path, routes: Path, seed: int, folder: Path) -> Trips:
    info = folder / "trips.xml"
    words = [
        "sumo", "--net-file", str(net), "--route-files", str(routes), "--seed", str(seed), "--step-length",
        f"{_STEP_S}", "--tripinfo-output", str(info), "--no-step-log", "true", "--no-warnings", "true",
        "--duration-log.disable", "true", "--device.emissions.probability", "1", "--time-to-teleport", "-1",
    ]  # fmt: skip
    if who == "device":
        words += ["--device.glosa.probability", "1", "--device.glosa.range", f"{REACH_M}"]
        words += ["--device.glosa.min-speed", f"{LEAST_MPS}", "--device.glosa.max-speedfactor", "1.0"]
    libsumo.start(words)
    try:
        advised = _Advised() if who == "ours" else None
        while libsumo.simulation.getMinExpectedNumber() > 0:
            if advised is not None:
                advised.step()
            libsumo.simulationStep()
    finally:
        libsumo.close()
    return _read(info)


class _Advised:
    """Every vehicle, with an advisor of its own."""

    def __init__(self) -> None:
        self._advisors: dict[str, SpeedAdvisor] = {}
        self._programs = {
            name: libsumo.trafficlight.getAllProgramLogics(name)[0].phases for name in libsumo.trafficlight.getIDList()
        }

    def step(self) -> None:
        now_s = libsumo.simulation.getTime()
        for name in libsumo.vehicle.getIDList():
            ahead = libsumo.vehicle.getNextTLS(name)
            speed = libsumo.vehicle.getSpeed(name)
            advisor = self._advisors.setdefault(name, SpeedAdvisor(reaction_s=0.0))
            # Not getAllowedSpeed, which knows the bound that is set below.
            allowed = libsumo.lane.getMaxSpeed(libsumo.vehicle.getLaneID(name))
            advice, limit, left_m = NO_ADVICE, allowed * libsumo.vehicle.getSpeedFactor(name), 0.0
            if ahead and ahead[0][2] <= REACH_M:
                signal, link, left_m, _ = ahead[0]
                advice = advisor.advise(left_m, speed, limit, Greens(self._greens(signal, link, now_s), now_s), now_s)
            target = advice.target_mps if advice.kind is Advised.SPEED else _ANY_MPS
            if advice.kind is Advised.STOP:
                target = rolling_mps(left_m - _STOP_LINE_GAP_M - speed * _STEP_S)
            libsumo.vehicle.setMaxSpeed(name, max(target, speed - DOWN_MPS2 * _STEP_S, _LEAST_BOUND_MPS))

    def _greens(self, signal: str, link: int, now_s: float) -> tuple[tuple[float, float], ...]:
        phases, phase = self._programs[signal], libsumo.trafficlight.getPhase(signal)
        left_s = libsumo.trafficlight.getNextSwitch(signal) - now_s
        coming = [phases[(phase + step) % len(phases)] for step in range(1, len(phases) + 1)]
        later = [(state_of(one.state, link), one.duration) for one in coming]
        return tuple(greens(state_of(phases[phase].state, link), left_s, later))


def _read(path: Path) -> Trips:
    rows = []
    for _, element in iterparse(path):
        if element.tag == "tripinfo":
            emissions = element.find("emissions")
            assert emissions is not None
            names = ("waitingCount", "waitingTime", "timeLoss", "duration")
            rows.append(
                (*(float(element.attrib[name]) for name in names), float(emissions.attrib["fuel_abs"]) / 1000.0)
            )
    return Trips(*(statistics.fmean(column) for column in zip(*rows, strict=True)))


def _tell(found: dict[str, list[Trips]]) -> None:
    seeds = len(found["none"])
    for who, trips in found.items():
        means = [f"{name} {statistics.fmean(getattr(one, name) for one in trips):.2f}" for name in Trips._fields]
        print(f"  {who:6s}: {', '.join(means)}")
    for one_of, other in (("device", "none"), ("ours", "none"), ("ours", "device")):
        print(f"  {one_of} less {other}, {seeds} seeds, 95 %:")
        for name in Trips._fields:
            pairs = zip(found[one_of], found[other], strict=True)
            differences = [getattr(one, name) - getattr(two, name) for one, two in pairs]
            half = _T_95[seeds - 1] * statistics.stdev(differences) / seeds**0.5
            print(f"    {name} {statistics.fmean(differences):+.3f} +- {half:.3f}")


if __name__ == "__main__":
    main()
