"""Our car with the parameters of CommonRoad's BMW 320i beside their models (commonroad-vehicle-models 3.0.2)."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
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
from simconsole.values.platform import Ground, Pose
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.vehicle.car.state import CarState
from simconsole.vehicle.platforms import build

INPUTS = ((10.0, 0.02), (10.0, 0.06), (15.0, 0.03), (20.0, 0.02), (20.0, 0.035), (30.0, 0.012), (30.0, 0.017))
"""Speed in m/s and road-wheel angle in rad, below 6 m/s2 of lateral acceleration."""
RAMP_S = 0.2
DURATION_S = 3.0
PEER_STEP_S = 0.002
SAMPLE_S = 0.02
OUR_STEP_S = 0.001

PARAMETERS = parameters_vehicle2()
Array = NDArray[np.float64]


class Way(NamedTuple):
    """Samples every SAMPLE_S: the centre of gravity, and the yaw rate."""

    x_m: Array
    y_m: Array
    yaw_rate_radps: Array


class Compared(NamedTuple):
    """One input: distances from the multi-body model in m, yaw rates at the end in rad/s."""

    speed_mps: float
    angle_rad: float
    lateral_mps2: float
    gaps_m: dict[str, float]
    yaw_rates_radps: dict[str, float]


def compare() -> list[Compared]:
    """Drive every input with every model."""
    return [_compare(speed, angle) for speed, angle in INPUTS]


def _compare(speed: float, angle: float) -> Compared:
    core = [0.0, 0.0, 0.0, speed, 0.0, 0.0, 0.0]
    wheelbase = PARAMETERS.a + PARAMETERS.b
    multi = _peer(init_mb(core, PARAMETERS), vehicle_dynamics_mb, angle, lambda x: (x[0], x[1], x[5]))
    ways = {
        "ours": _ours(speed, angle),
        "ST": _peer(init_st(core), vehicle_dynamics_st, angle, lambda x: (x[0], x[1], x[5])),
        "STD": _peer(init_std(core, PARAMETERS), vehicle_dynamics_std, angle, lambda x: (x[0], x[1], x[5])),
        # Their kinematic model is of the rear axle.
        "KS": _peer(
            init_ks(core),
            vehicle_dynamics_ks,
            angle,
            lambda x: (
                x[0] + PARAMETERS.b * (math.cos(x[4]) - 1.0),
                x[1] + PARAMETERS.b * math.sin(x[4]),
                x[3] * math.tan(x[2]) / wheelbase,
            ),
        ),
    }
    gaps = {name: float(np.hypot(way.x_m - multi.x_m, way.y_m - multi.y_m).max()) for name, way in ways.items()}
    rates = {name: float(way.yaw_rate_radps[-1]) for name, way in {**ways, "MB": multi}.items()}
    return Compared(speed, angle, rates["MB"] * speed, gaps, rates)


def _peer(start: list[float], model: Callable[..., Any], angle: float, seen: Callable[[Any], Any]) -> Way:
    """Integrate one of their models by Runge-Kutta 4."""
    x, h = np.array(start, dtype=np.float64), PEER_STEP_S
    samples = []
    every = round(SAMPLE_S / h)
    for index in range(round(DURATION_S / h)):
        u = [angle / RAMP_S if index * h < RAMP_S - 0.5 * h else 0.0, 0.0]
        k1 = np.array(model(x.tolist(), u, PARAMETERS))  # plain floats: the same bits, twice as fast
        k2 = np.array(model((x + 0.5 * h * k1).tolist(), u, PARAMETERS))
        k3 = np.array(model((x + 0.5 * h * k2).tolist(), u, PARAMETERS))
        k4 = np.array(model((x + h * k3).tolist(), u, PARAMETERS))
        x = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        if (index + 1) % every == 0:
            samples.append(seen(x))
    return Way(*np.array(samples).T)


def _ours(speed: float, angle: float) -> Way:
    vehicle = build(load("vehicles", "commonroad_bmw320i", CarProfile), Pose(0.0, 0.0, 0.0), Ground(1.0, 0.0, 0.0))
    step = compiled(vehicle.step)
    spin = speed / PARAMETERS.R_w
    start = CarState(*vehicle.initial_state)._replace(
        vx_mps=speed, fl_radps=spin, fr_radps=spin, rl_radps=spin, rr_radps=spin
    )
    row = np.zeros(PLATFORM_AT + len(start))
    put(row, PLATFORM_AT, start)
    every = round(SAMPLE_S / OUR_STEP_S)
    samples = []
    for tick in range(round(DURATION_S / OUR_STEP_S)):
        # A step and a half ahead: the rack follows its command with that lag, their angle has none.
        row[LAYOUT.command.start] = angle * min((tick + 2.5) * OUR_STEP_S / RAMP_S, 1.0)
        step(row, row, vehicle.parameters, vehicle.ground, 1)
        if (tick + 1) % every == 0:
            samples.append(row[PLATFORM_AT:].copy())
    state = CarState(*np.array(samples).T)
    x = state.x_m + PARAMETERS.b * (np.cos(state.yaw_rad) - 1.0)
    return Way(x, state.y_m + PARAMETERS.b * np.sin(state.yaw_rad), np.asarray(state.yaw_rate_radps))
