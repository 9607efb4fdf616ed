"""How long one vehicle step of 1 ms takes beside the models of CommonRoad in the same run.

Run: python benchmarks/vehicle_step.py [--rounds N]

All on one core, interleaved, medians of the rounds, in processor time. CommonRoad's models (commonroad-vehicle-models
3.0.2, their "BMW 320i") are integrated by Runge-Kutta 4 at 1 ms as their examples do in Python, and once with their own
source compiled by numba. They have 5 to 29 states, no engine, gears, aids or standstill; ours has all of its own
switched on. Many cars at once: benchmarks/fleet.py.

The bar counts steps of the model alone, one car stepped in one compiled call: CommonRoad's step does nothing else.
What a tick adds (command, ground, what others see, forecast of the pedals) is in the rows for ticks of 1 and 4 ms.
"""

import argparse
import os
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
import numpy as np
from vehiclemodels.init_ks import init_ks
from vehiclemodels.init_mb import init_mb
from vehiclemodels.init_st import init_st
from vehiclemodels.init_std import init_std
from vehiclemodels.parameters_vehicle2 import parameters_vehicle2
from vehiclemodels.vehicle_dynamics_ks import vehicle_dynamics_ks
from vehiclemodels.vehicle_dynamics_mb import vehicle_dynamics_mb
from vehiclemodels.vehicle_dynamics_st import vehicle_dynamics_st
from vehiclemodels.vehicle_dynamics_std import vehicle_dynamics_std

from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.host.jit import compiled
from simconsole.values.kernels import put
from simconsole.values.platform import Ground, Platform, Pose
from simconsole.values.signals import VehicleCommand
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.vehicle.platforms import build

SPEED_MPS = 20.0
ROAD_WHEEL_RAD = 0.02
STEP_S = 0.001
LONGEST = 100_000
TICKS = {"ticks of 1 ms": 1, "ticks of 4 ms": 4, "one call": LONGEST}
"""Substeps in one call of the step."""

Steps = Callable[[int], None]


def peer(start: list[float], model: Callable[..., Any]) -> Steps:
    """Return what integrates one of their models in Python."""
    parameters = parameters_vehicle2()

    def steps(count: int) -> None:
        x, u = list(start), [0.0, 0.0]
        for _ in range(count):
            k1 = model(x, u, parameters)
            k2 = model([a + 0.5 * STEP_S * b for a, b in zip(x, k1, strict=True)], u, parameters)
            k3 = model([a + 0.5 * STEP_S * b for a, b in zip(x, k2, strict=True)], u, parameters)
            k4 = model([a + STEP_S * b for a, b in zip(x, k3, strict=True)], u, parameters)
            x = [
                a + STEP_S / 6.0 * (b + 2.0 * c + 2.0 * d + e) for a, b, c, d, e in zip(x, k1, k2, k3, k4, strict=True)
            ]

    return steps


def peers() -> dict[str, Steps]:
    parameters = parameters_vehicle2()
    core = [0.0, 0.0, ROAD_WHEEL_RAD, SPEED_MPS, 0.0, 0.0, 0.0]
    return {
        "CommonRoad KS, Python": peer(init_ks(core), vehicle_dynamics_ks),
        "CommonRoad ST, Python": peer(init_st(core), vehicle_dynamics_st),
        "CommonRoad STD, Python": peer(init_std(core, parameters), vehicle_dynamics_std),
        "CommonRoad MB, Python": peer(init_mb(core, parameters), vehicle_dynamics_mb),
    }


def command() -> VehicleCommand:
    nothing = VehicleCommand(*(0.0,) * len(VehicleCommand._fields))
    return nothing._replace(road_wheel_rad=ROAD_WHEEL_RAD, throttle=0.3, gear=1.0, automatic=1.0)


def rolling(vehicle: Platform) -> list[float]:
    """Return the state of a car that rolls at SPEED_MPS."""
    profile = load("vehicles", "hatchback", CarProfile)
    state = vehicle.state(*vehicle.initial_state)
    spin = SPEED_MPS / profile.front.wheel_radius_m
    return list(state._replace(vx_mps=SPEED_MPS, fl_radps=spin, fr_radps=spin, rl_radps=spin, rr_radps=spin))


def alone(vehicle: Platform, substeps: int) -> Steps:
    """Return what steps one car in ticks, the loop over the ticks compiled too: no call from Python in between."""
    step = compiled(vehicle.step)
    row = np.zeros(PLATFORM_AT + len(vehicle.initial_state))

    @numba.njit
    def ticks(row: Any, parameters: Any, ground: Any, substeps: int, count: int) -> None:
        for _ in range(count):
            step(row, row, parameters, ground, substeps)

    def steps(count: int) -> None:
        put(row, PLATFORM_AT, rolling(vehicle))
        put(row, LAYOUT.command.start, command())
        ticks(row, vehicle.parameters, vehicle.ground, substeps, count // substeps)

    return steps


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--cars", type=int, default=1000)
    given = parser.parse_args()
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    vehicle = build(load("vehicles", "hatchback", CarProfile), Pose(0.0, 0.0, 0.0), Ground(1.0, 0.0, 0.0))
    runs: dict[str, tuple[Steps, int]] = {name: (steps, 200) for name, steps in peers().items()}
    for name, substeps in TICKS.items():
        runs[f"ours, one car, {name}"] = alone(vehicle, substeps), LONGEST
    runs["CommonRoad MB, compiled by numba"] = compiled_peer(), 3_000
    costs: dict[str, list[float]] = {name: [] for name in runs}
    for _ in range(given.rounds + 1):  # the first compiles and warms up
        for name, (steps, count) in runs.items():
            began = time.process_time()
            steps(count)
            costs[name].append((time.process_time() - began) / count)
    medians = {name: statistics.median(cost[1:]) for name, cost in costs.items()}
    base = medians["CommonRoad MB, Python"]
    print(f"one step of 1 ms of one car, medians of {given.rounds} interleaved rounds, one core")
    for name, cost in medians.items():
        print(f"  {name:34}  {cost * 1e9:12.1f} ns   {1e-6 / cost:8.3f} M steps/s   MB Python x {base / cost:8.1f}")

    def ratio(slow: str, fast: str) -> float:
        return statistics.median(a / b for a, b in zip(costs[slow][1:], costs[fast][1:], strict=True))

    print("times as fast, medians of the ratios of each round; the bar counts steps of the model: one car in one call")
    for name in TICKS:
        bar = "   (hold 350)" if TICKS[name] == LONGEST else ""
        print(f"  one car, {name}: {ratio('CommonRoad MB, Python', f'ours, one car, {name}'):.0f} x MB{bar}")


def compiled_peer() -> Steps:
    """Return their multi-body model compiled from its own source, as the tests use it: 3000 steps a drive."""
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    from tests.vehicle import commonroad

    def steps(_: int) -> None:
        commonroad.drive_multi_body(commonroad.Input(SPEED_MPS, ROAD_WHEEL_RAD), STEP_S)

    return steps


if __name__ == "__main__":
    main()
