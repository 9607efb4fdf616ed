"""Our car with the parameters of CommonRoad's BMW against their multi-body model, on random inputs."""

import math
import random
from typing import Any, NamedTuple

import msgspec
import numpy as np
import pytest

from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.host.jit import compiled
from simconsole.values.kernels import put
from simconsole.values.platform import Platform
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.vehicle.car.car_step import load_parameters
from simconsole.vehicle.car.parameters import CarParameters
from simconsole.vehicle.car.state import CAR, CarState
from simconsole.vehicle.platforms import build
from tests.samples import Sample
from tests.vehicle.commonroad import BMW, DURATION_S, SAMPLE_S, Input, Path, drive_multi_body, drive_single_track
from tests.vehicle.driving import LEVEL, ORIGIN

CASES = 100
WHEELBASE_M = BMW.a + BMW.b
STATE = CAR.slice
STEER_AT = LAYOUT.command.start  # VehicleCommand begins with road_wheel_rad


class Case(NamedTuple):
    """One input, their answer, and how far their two models are apart."""

    given: Input
    truth: Path
    gap_m: float


def drive_ours(vehicle: Platform, given: Input) -> Path:
    """Drive our car at ticks of 1 ms, coasting in neutral."""
    step = compiled(vehicle.step)
    spin = given.speed_mps / BMW.R_w
    start = CarState(*vehicle.initial_state)._replace(
        vx_mps=given.speed_mps, fl_radps=spin, fr_radps=spin, rl_radps=spin, rr_radps=spin
    )
    row, other = np.zeros((2, PLATFORM_AT + len(start)))
    put(row, PLATFORM_AT, start)
    every = round(SAMPLE_S / 0.001)
    samples = []
    for tick in range(round(DURATION_S / 0.001)):
        other[STEER_AT] = given.rate_radps * min((tick + 2.5) * 0.001, given.ramp_s)
        step(row, other, vehicle.parameters, vehicle.ground, 1)
        row, other = other, row
        if (tick + 1) % every == 0:
            samples.append(CarState(*row[STATE]))
    return of_centre(CarState(*np.array(samples).T), load_parameters(vehicle.parameters))


def of_centre(run: Any, p: CarParameters) -> Path:
    """Return the path of the centre of gravity, as theirs: ahead of base_link and above the ground it rocks over."""
    axle_roll = (run.rl_lift_m - run.rr_lift_m) / (2.0 * p.rear.half_track_m)
    ahead = BMW.b + p.body.cg_height_m * run.pitch_rad
    aside = -(p.rear.roll_arm_m * run.roll_rad + p.rear.link_arm_m * axle_roll)
    c, s = np.cos(run.yaw_rad), np.sin(run.yaw_rad)
    x_m, y_m = run.x_m + ahead * c - aside * s, run.y_m + ahead * s + aside * c
    return Path(x_m - BMW.b, y_m, run.yaw_rate_radps, run.roll_rad)


def apart(one: Path, other: Path) -> float:
    return float(np.hypot(one.x_m - other.x_m, one.y_m - other.y_m).max())


def bmw(**body: float) -> CarProfile:
    profile = load("vehicles", "commonroad_bmw320i", CarProfile)
    return msgspec.structs.replace(profile, body=msgspec.structs.replace(profile.body, **body))


def ratios(profile: CarProfile, cases: list[Case]) -> list[float]:
    """Return for each case our distance from MB as a share of ST's."""
    vehicle = build(profile, ORIGIN, LEVEL)
    return [apart(drive_ours(vehicle, case.given), case.truth) / case.gap_m for case in cases]


def passes(shares: list[float]) -> bool:
    """Return the gate's verdict: at least 95 % within half, none beyond the whole, the median at most 0.3."""
    within = sum(share <= 0.5 for share in shares) / len(shares)
    print(f"within half {within:.1%}, worst {max(shares):.2f}, median {np.median(shares):.3f}")
    return within >= 0.95 and max(shares) <= 1.0 and float(np.median(shares)) <= 0.3


@pytest.fixture(scope="module")
def cases(module_sample: Sample) -> list[Case]:
    rng = random.Random(module_sample.seed)
    count = module_sample.of(CASES, 20 * CASES)
    found: list[Case] = []
    while len(found) < count:
        speed = rng.uniform(5.0, 30.0)
        lateral = rng.uniform(0.3, 6.0) * rng.choice([-1.0, 1.0])
        given = Input(speed, math.atan(lateral * WHEELBASE_M / speed**2))
        truth = drive_multi_body(given)
        if np.abs(truth.yaw_rate_radps).max() * speed < 6.0:
            found.append(Case(given, truth, apart(drive_single_track(given), truth)))
    return found


def test_our_car_is_much_nearer_to_the_multi_body_model_than_the_single_track_model_is(cases: list[Case]) -> None:
    assert passes(ratios(bmw(), cases))


def test_the_gate_sees_ten_percent_less_cornering_stiffness(cases: list[Case]) -> None:
    profile = bmw()
    axles: dict[str, Any] = {
        name: msgspec.structs.replace(axle, cornering_stiffness_per_rad=0.9 * axle.cornering_stiffness_per_rad)
        for name, axle in (("front", profile.front), ("rear", profile.rear))
    }
    assert not passes(ratios(msgspec.structs.replace(profile, **axles), cases))


def test_the_gate_sees_ten_percent_more_yaw_inertia(cases: list[Case]) -> None:
    assert not passes(ratios(bmw(yaw_inertia_kgm2=1.1 * BMW.I_z), cases))


def test_yaw_rate_and_roll_in_steady_state(cases: list[Case]) -> None:
    vehicle = build(bmw(), ORIGIN, LEVEL)
    yaw_errors, roll_errors = [], []
    for case in cases:
        ours = drive_ours(vehicle, case.given)
        last = slice(-10, None)
        wanted = case.truth.yaw_rate_radps[last].mean()
        if abs(wanted) * case.given.speed_mps < 1.0:
            continue  # relative errors of next to nothing say nothing
        yaw_errors.append(abs(ours.yaw_rate_radps[last].mean() / wanted - 1.0))
        roll_errors.append(abs(ours.roll_rad[last].mean() / case.truth.roll_rad[last].mean() - 1.0))
    print(f"{len(yaw_errors)} cases: yaw rate off by at most {max(yaw_errors):.2%}, roll by {max(roll_errors):.2%}")
    assert len(yaw_errors) > len(cases) // 2
    assert max(yaw_errors) < 0.01
    assert max(roll_errors) < 0.05
