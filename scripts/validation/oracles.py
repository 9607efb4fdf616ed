"""What a car must do by theory, measured on the shipped cars."""

import math
from typing import Any
from unittest import mock

import numpy as np
from msgspec.structs import replace

from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.host.jit import compiled, plain
from simconsole.values.kernels import Row, put
from simconsole.values.platform import Ground, Pose
from simconsole.values.signals import VehicleCommand
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.values.units import STANDARD_GRAVITY_MPS2
from simconsole.vehicle.car import car_platform as car_assembly
from simconsole.vehicle.car import car_step
from simconsole.vehicle.car.car_platform import car_parameters
from simconsole.vehicle.car.state import CarState
from simconsole.vehicle.platforms import build

LEVEL = Ground(1.0, 0.0, 0.0)
NOTHING = VehicleCommand(*(0.0,) * len(VehicleCommand._fields))


class Run:
    """A car, stepped 1 ms at a time or in ticks."""

    def __init__(self, profile: CarProfile, ground: Ground = LEVEL, execution: Any = compiled, **start: float) -> None:
        self.vehicle = build(profile, Pose(0.0, 0.0, 0.0), ground)
        self.step = execution(self.vehicle.step)
        speed = start.get("vx_mps", 0.0)
        spins = {
            f"{wheel}_radps": speed / (profile.front if wheel[0] == "f" else profile.rear).wheel_radius_m
            for wheel in ("fl", "fr", "rl", "rr")
        }
        self.row: Row = np.zeros(PLATFORM_AT + len(self.vehicle.initial_state))
        put(self.row, PLATFORM_AT, CarState(*self.vehicle.initial_state)._replace(**{**spins, **start}))
        put(self.row, LAYOUT.vehicle.start, self.vehicle.initial_vehicle)

    @property
    def state(self) -> CarState:
        """The car's state now."""
        return CarState(*self.row[PLATFORM_AT:].tolist())

    def hold(self, seconds: float, substeps: int = 1, **command: float) -> list[CarState]:
        """Hold a command and return the states of every `substeps` steps of 1 ms."""
        put(self.row, LAYOUT.command.start, NOTHING._replace(**command))
        states = []
        for _ in range(round(seconds * 1000 / substeps)):
            self.step(self.row, self.row, self.vehicle.parameters, self.vehicle.ground, substeps)
            states.append(self.state)
        return states


def hatchback() -> CarProfile:
    """Return the seat's default car."""
    return load("vehicles", "hatchback", CarProfile)


def ackermann() -> dict[str, float]:
    """Circle at walking pace: radius of base_link against wheelbase / tan(angle)."""
    angle = 0.3
    run = Run(hatchback(), vx_mps=1.4)
    run.hold(2.0, clutch=1.0, road_wheel_rad=angle)
    states = run.hold(1.0, clutch=1.0, road_wheel_rad=angle)
    measured = sum(s.vx_mps / s.yaw_rate_radps for s in states) / len(states)
    theory = run.vehicle.wheelbase_m / math.tan(angle)
    return {"theory_m": theory, "measured_m": measured, "error": measured / theory - 1.0}


def _bicycle_car() -> CarProfile:
    """The validation car as near to a bicycle as its profile allows: low, stiff, tyres without lag or camber."""
    profile = load("vehicles", "commonroad_bmw320i", CarProfile)
    axles = {
        name: replace(axle, relaxation_y_m=0.02, camber_slip_per_rad=0.0, camber_offset_slip=0.0, roll_bar_nmprad=2e5)
        for name, axle in (("front", profile.front), ("rear", profile.rear))
    }
    return replace(profile, body=replace(profile.body, cg_height_m=0.1), **axles)


def bicycle(speed: float = 20.0) -> dict[str, float]:
    """Yaw gain and eigenvalues against the linear single-track model (Riekert and Schunck, 1940)."""
    profile = _bicycle_car()
    body = profile.body
    mass, inertia, wheelbase = body.mass_kg, body.yaw_inertia_kgm2, body.wheelbase_m
    a, b = wheelbase * (1.0 - body.front_mass_share), wheelbase * body.front_mass_share
    weight = mass * STANDARD_GRAVITY_MPS2
    front = profile.front.cornering_stiffness_per_rad * weight * b / wheelbase
    rear = profile.rear.cornering_stiffness_per_rad * weight * a / wheelbase
    across = b * rear - a * front
    matrix = np.array(
        [
            [-(front + rear) / (mass * speed), across / (mass * speed) - speed],
            [across / (inertia * speed), -(a * a * front + b * b * rear) / (inertia * speed)],
        ]
    )
    wanted = np.linalg.eigvals(matrix)
    states = Run(profile, vx_mps=speed, yaw_rate_radps=0.02).hold(0.5)[20:]
    pairs = np.array([[s.vy_mps, s.yaw_rate_radps] for s in states])
    middle, rate = 0.5 * (pairs[1:] + pairs[:-1]), np.diff(pairs, axis=0) / 0.001
    found = np.linalg.eigvals(np.linalg.lstsq(middle, rate, rcond=None)[0].T)
    angle = 0.004
    last = Run(profile, vx_mps=speed).hold(4.0, road_wheel_rad=angle)[-1]
    gain = last.vx_mps / (wheelbase + last.vx_mps**2 * mass * across / (wheelbase * front * rear))
    return {
        "speed_mps": speed,
        "eigenvalue_real_theory": float(wanted.real.mean()),
        "eigenvalue_real_measured": float(found.real.mean()),
        "eigenvalue_imaginary_theory": float(np.abs(wanted.imag).max()),
        "eigenvalue_imaginary_measured": float(np.abs(found.imag).max()),
        "yaw_gain_theory_per_s": gain,
        "yaw_gain_measured_per_s": last.yaw_rate_radps / angle,
        "error": float(np.abs(np.sort_complex(found) / np.sort_complex(wanted) - 1.0).max()),
        "gain_error": last.yaw_rate_radps / angle / gain - 1.0,
    }


def static_loads(slope: float = 0.1) -> dict[str, float]:
    """Axle loads of the braked car at rest, uphill, against the balance of moments."""
    profile = hatchback()
    ground = Ground(1.0, slope, 0.0)
    end = Run(profile, ground).hold(15.0, substeps=100, brake=0.6)[-1]
    p = car_parameters(profile)
    front = 2.0 * p.front.static_n - p.front.carcass_npm * (end.fl_lift_m + end.fr_lift_m)
    rear = 2.0 * p.rear.static_n - p.rear.carcass_npm * (end.rl_lift_m + end.rr_lift_m)
    body, plane = profile.body, STANDARD_GRAVITY_MPS2 / math.sqrt(1.0 + slope * slope)
    moved = body.mass_kg * plane * slope * body.cg_height_m / body.wheelbase_m
    wanted = body.mass_kg * plane * body.front_mass_share - moved
    return {
        "front_theory_n": wanted,
        "front_measured_n": front,
        "sum_theory_n": body.mass_kg * plane,
        "sum_measured_n": front + rear,
        "error": max(abs(front / wanted - 1.0), abs((front + rear) / (body.mass_kg * plane) - 1.0)),
    }


def energy() -> dict[str, float]:
    """Rolling down without drag and rolling resistance; and a sliding car that nobody drives."""
    profile = hatchback()
    free = replace(
        profile,
        body=replace(profile.body, drag_area_m2=0.0, front_lift_area_m2=0.0, rear_lift_area_m2=0.0),
        front=replace(profile.front, rolling_resistance=0.0),
        rear=replace(profile.rear, rolling_resistance=0.0),
    )
    slope = 0.08
    end = Run(free, Ground(1.0, -slope, 0.0)).hold(20.0, substeps=100)[-1]
    height = end.x_m * slope / math.sqrt(1.0 + slope * slope)  # x is measured along the ground
    gained = _motion(free, end) / (free.body.mass_kg * STANDARD_GRAVITY_MPS2 * height)
    sliding = Run(profile, vx_mps=25.0, vy_mps=6.0, yaw_rate_radps=1.0).hold(10.0)
    values = np.array([_motion(profile, state) for state in sliding])
    rise = float((values - np.minimum.accumulate(values)).max() / values[0])
    return {"gained_over_height": gained, "end_mps": end.vx_mps, "error": gained - 1.0, "largest_rise_share": rise}


def _motion(profile: CarProfile, s: CarState) -> float:
    """Return the energy of the car's motion in the plane and of its wheels' spin."""
    spins = 0.25 * profile.front.wheel_inertia_kgm2 * (s.fl_radps**2 + s.fr_radps**2)
    spins += 0.25 * profile.rear.wheel_inertia_kgm2 * (s.rl_radps**2 + s.rr_radps**2)
    body = profile.body
    return 0.5 * (body.mass_kg * (s.vx_mps**2 + s.vy_mps**2) + body.yaw_inertia_kgm2 * s.yaw_rate_radps**2) + spins


def mirror() -> dict[str, float]:
    """A drive and its mirror image: how many values differ in any bit."""
    profile = hatchback()
    left, right = Run(profile, vx_mps=20.0), Run(profile, vx_mps=20.0)
    differing = compared = 0
    for index in range(1500):
        angle = 0.12 * math.sin(0.004 * index) + 0.03
        (a,) = left.hold(0.004, substeps=4, automatic=1.0, gear=1.0, throttle=0.5, road_wheel_rad=angle)
        (b,) = right.hold(0.004, substeps=4, automatic=1.0, gear=1.0, throttle=0.5, road_wheel_rad=-angle)
        pairs: tuple[tuple[float, float], ...] = (
            (a.x_m, b.x_m),
            (a.y_m, -b.y_m),
            (a.yaw_rad, -b.yaw_rad),
            (a.vx_mps, b.vx_mps),
            (a.vy_mps, -b.vy_mps),
        )
        pairs += (
            (a.roll_rad, -b.roll_rad),
            (a.hand_wheel_torque_nm, -b.hand_wheel_torque_nm),
            (a.fl_radps, b.fr_radps),
        )
        differing += sum(one != other for one, other in pairs)
        compared += len(pairs)
    return {"compared": float(compared), "error": float(differing)}


def convergence() -> dict[str, float]:
    """Step steer at 20 m/s: the way after a second against that of a sixteenth of the step, and the order."""
    steps = (0.002, 0.001, 0.0005)
    exact = _stepped(0.001 / 16.0)
    errors = [math.hypot(*(np.array(_stepped(step)) - exact)) for step in steps]
    order = math.log2(errors[0] / errors[2]) / 2.0
    return {**{f"error_{step * 1000:g}_ms_m": error for step, error in zip(steps, errors, strict=True)}, "order": order}


def _stepped(step_s: float) -> tuple[float, float]:
    # The rack's parameters are made for the step.
    with mock.patch.object(car_step, "STEP_S", step_s), mock.patch.object(car_assembly, "STEP_S", step_s):
        run = Run(hatchback(), execution=plain, vx_mps=20.0)
        put(run.row, LAYOUT.command.start, NOTHING._replace(road_wheel_rad=0.04, clutch=1.0))
        run.step(run.row, run.row, run.vehicle.parameters, run.vehicle.ground, round(1.0 / step_s))
    return run.state.x_m, run.state.y_m
