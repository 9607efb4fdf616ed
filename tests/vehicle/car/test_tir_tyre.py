"""PAC2002 tyres: the file, the formulas against a second writing of them, and the car that stands and drives."""

import math
import random
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from simconsole.profiles.files.loader import load, profiles_folder
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.tyre import NEEDED, ONE, ZERO, parse_tir
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.host.jit import compiled, digest, plain
from simconsole.values.kernels import put
from simconsole.values.platform import Ground, Platform
from simconsole.values.state_vector import PLATFORM_AT
from simconsole.vehicle.batch.fleet import Fleet
from simconsole.vehicle.car.car_platform import car_parameters
from simconsole.vehicle.car.car_step import step
from simconsole.vehicle.car.pac2002 import Pac2002, Slip, coefficients, exp, pac2002
from simconsole.vehicle.car.state import CarState
from simconsole.vehicle.car.tir_tyre import make_tyre, step_on
from simconsole.vehicle.platforms import build
from tests.bits import difference
from tests.samples import Sample
from tests.vehicle.driving import IDLE, LEVEL, ORIGIN, SUBSTEPS, Drive

FOLDER = profiles_folder() / "vehicles"
TEXT = (FOLDER / "tyres" / "example.tir").read_text()
EXAMPLE = parse_tir(TEXT, "example.tir")
ADAMS = parse_tir((Path(__file__).parent / "adams_205_60r15.tir").read_text(), "adams_205_60r15.tir")


def car(ground: Ground = LEVEL, values: dict[str, float] = EXAMPLE) -> Platform:
    profile: Any = load_vehicle("hatchback")
    tyre = msgspec.convert({"tir": "example.tir", "coefficients": values}, type=dict[str, Any])
    raw = msgspec.to_builtins(profile)
    return build(msgspec.convert(raw | {"tyre": tyre}, CarProfile), ORIGIN, ground)


def published(v: dict[str, float], kappa: float, tangent: float, fz: float, gamma: float, mu: float) -> np.ndarray:
    """Return Fx, Fy, Mz with all coefficients and scale factors, written again with numpy's functions."""
    g = {**dict.fromkeys(ZERO, 0.0), **dict.fromkeys(ONE, 1.0), **v}

    def magic(b: float, c: float, e: float, x: float) -> float:
        return float(c * np.arctan(b * x - e * (b * x - np.arctan(b * x))))

    fz0 = g["FNOMIN"] * g["LFZO"]
    r0 = g["UNLOADED_RADIUS"]
    d = (fz - fz0) / fz0
    lmx, lmy = g["LMUX"] * mu, g["LMUY"] * mu
    alpha = np.arctan(tangent)
    # longitudinal
    gx = gamma * g["LGAX"]
    cx = g["PCX1"] * g["LCX"]
    dx = (g["PDX1"] + g["PDX2"] * d) * (1 - g["PDX3"] * gx**2) * lmx * fz
    kx = fz * (g["PKX1"] + g["PKX2"] * d) * np.exp(g["PKX3"] * d) * g["LKX"]
    x = kappa + (g["PHX1"] + g["PHX2"] * d) * g["LHX"]
    ex = min(1.0, (g["PEX1"] + g["PEX2"] * d + g["PEX3"] * d**2) * (1 - g["PEX4"] * np.sign(x)) * g["LEX"])
    fx0 = dx * np.sin(magic(kx / (cx * dx), cx, ex, x)) + fz * (g["PVX1"] + g["PVX2"] * d) * g["LVX"] * lmx
    # lateral
    gy = gamma * g["LGAY"]
    cy = g["PCY1"] * g["LCY"]
    dy = (g["PDY1"] + g["PDY2"] * d) * (1 - g["PDY3"] * gy**2) * lmy * fz
    ky = g["PKY1"] * fz0 * np.sin(2 * np.arctan(fz / (g["PKY2"] * fz0))) * (1 - g["PKY3"] * abs(gy)) * g["LKY"]
    by = ky / (cy * dy)
    shy = (g["PHY1"] + g["PHY2"] * d) * g["LHY"] + g["PHY3"] * gy
    svy = fz * ((g["PVY1"] + g["PVY2"] * d) * g["LVY"] + (g["PVY3"] + g["PVY4"] * d) * gy) * lmy
    y = alpha + shy
    ey = min(1.0, (g["PEY1"] + g["PEY2"] * d) * (1 - (g["PEY3"] + g["PEY4"] * gy) * np.sign(y)) * g["LEY"])
    fy0 = dy * np.sin(magic(by, cy, ey, y)) + svy
    # combined
    b = g["RBX1"] * np.cos(np.arctan(g["RBX2"] * kappa)) * g["LXAL"]
    e = min(1.0, g["REX1"] + g["REX2"] * d)
    fx = fx0 * np.cos(magic(b, g["RCX1"], e, alpha + g["RHX1"])) / np.cos(magic(b, g["RCX1"], e, g["RHX1"]))
    b = g["RBY1"] * np.cos(np.arctan(g["RBY2"] * (alpha - g["RBY3"]))) * g["LYKA"]
    e = min(1.0, g["REY1"] + g["REY2"] * d)
    shift = g["RHY1"] + g["RHY2"] * d
    fy_plain = fy0 * np.cos(magic(b, g["RCY1"], e, kappa + shift)) / np.cos(magic(b, g["RCY1"], e, shift))
    dv = dy * (g["RVY1"] + g["RVY2"] * d + g["RVY3"] * gamma) * np.cos(np.arctan(g["RVY4"] * alpha))
    fy = fy_plain + dv * np.sin(g["RVY5"] * np.arctan(g["RVY6"] * kappa)) * g["LVYKA"]
    # aligning
    gz = gamma * g["LGAZ"]
    at = alpha + g["QHZ1"] + g["QHZ2"] * d + (g["QHZ3"] + g["QHZ4"] * d) * gz
    ar = alpha + shy + svy / ky
    bt = (g["QBZ1"] + g["QBZ2"] * d + g["QBZ3"] * d**2) * (1 + g["QBZ4"] * gz + g["QBZ5"] * abs(gz)) * g["LKY"] / lmy
    dt = fz * (g["QDZ1"] + g["QDZ2"] * d) * (1 + g["QDZ3"] * gz + g["QDZ4"] * gz**2) * r0 / fz0 * g["LTR"]
    et = (g["QEZ1"] + g["QEZ2"] * d + g["QEZ3"] * d**2) * (
        1 + (g["QEZ4"] + g["QEZ5"] * gz) * 2 / np.pi * np.arctan(bt * g["QCZ1"] * at)
    )
    at_eq = np.arctan(np.hypot(np.tan(at), kx / ky * kappa)) * np.sign(at)
    ar_eq = np.arctan(np.hypot(np.tan(ar), kx / ky * kappa)) * np.sign(ar)
    trail = dt * np.cos(magic(bt, g["QCZ1"], min(1.0, et), at_eq)) * np.cos(alpha)
    dr = fz * ((g["QDZ6"] + g["QDZ7"] * d) * g["LRES"] + (g["QDZ8"] + g["QDZ9"] * d) * gz) * r0 * lmy
    br = g["QBZ9"] * g["LKY"] / lmy + g["QBZ10"] * by * cy
    arm = r0 * (g["SSZ1"] + g["SSZ2"] * fy / fz0 + (g["SSZ3"] + g["SSZ4"] * d) * gamma) * g["LS"]
    mz = -trail * fy_plain + dr * np.cos(np.arctan(br * ar_eq)) * np.cos(alpha) + arm * fx
    return np.array([fx, fy, mz])


def every_coefficient(rng: random.Random) -> dict[str, float]:
    """Return the example with every absent coefficient given a small value and the scale factors near 1."""
    small = {key: rng.uniform(-0.05, 0.05) for key in ZERO}
    return small | {key: rng.uniform(0.9, 1.1) for key in ONE} | {"TYRESIDE": 1.0} | EXAMPLE


def test_force_and_moment_are_those_of_a_second_writing(sample: Sample) -> None:
    rng = random.Random(sample.seed)
    worst = 0.0
    for case in range(sample.of(1500, 100_000)):
        values = EXAMPLE if case % 2 else every_coefficient(rng)
        kappa = 0.0 if case % 5 == 0 else rng.uniform(-1.0, 1.0)
        tangent = 0.0 if case % 7 == 0 else rng.uniform(-0.6, 0.6)
        load = rng.choice([500.0, 2000.0, 3600.0, 7000.0])
        camber = rng.choice([0.0, rng.uniform(-0.1, 0.1)])
        mu = rng.choice([1.0, 0.3])
        force = pac2002(coefficients(values), Slip(kappa, tangent, load, camber, mu))
        expected = published(values, kappa, tangent, load, camber, mu)
        worst = max(worst, float(np.max(np.abs(np.array(force[:3]) - expected))) / load)
    print(f"largest deviation per load {worst:.2g}")
    assert worst < 1e-10


def test_exp() -> None:
    for value in np.linspace(-20.0, 20.0, 401):
        assert exp(float(value)) == pytest.approx(float(np.exp(value)), rel=1e-13)


def test_a_tyre_without_shifts_is_symmetric_and_falls_with_friction_and_load() -> None:
    p = coefficients(EXAMPLE | {"SSZ1": 0.0})
    for kappa, tangent in ((0.0, 0.05), (0.08, 0.1), (-0.3, 0.3)):
        left = pac2002(p, Slip(kappa, tangent, 4000.0, 0.03, 1.0))
        right = pac2002(p, Slip(kappa, -tangent, 4000.0, -0.03, 1.0))
        assert (left.x_n, left.y_n, left.moment_nm) == (right.x_n, -right.y_n, -right.moment_nm)
    assert pac2002(p, Slip(0.0, -0.05, 4000.0, 0.0, 1.0)).y_n > 0.0  # slides to the right: pushed to the left
    assert pac2002(p, Slip(0.0, -0.02, 4000.0, 0.0, 1.0)).moment_nm < 0.0  # and turned back
    assert pac2002(p, Slip(0.1, 0.0, 4000.0, 0.0, 1.0)).x_n > 0.0
    for friction in (1.0, 0.4):
        most = max(pac2002(p, Slip(0.01 * n, 0.0, 3600.0, 0.0, friction)).x_n for n in range(100))
        assert most == pytest.approx(1.02 * 3600.0 * friction, rel=1e-3)  # sampled: a little below the peak
    assert abs(pac2002(p, Slip(0.1, 0.1, 0.0, 0.0, 1.0)).x_n) < 2.0  # in the air


def test_a_file_comes_back_as_it_was_written() -> None:
    values = {key: value + 0.0 for key, value in every_coefficient(random.Random(3)).items()}
    head = TEXT.partition("[DIMENSION]")[0]
    shape = "[SHAPE]\n{radial width}\n1.0 0.0\n[OTHER]\nIGNORED_KEY = 7 $ by this model\n"
    written = head + "[ALL]\n" + "".join(f" {key.lower()}={value!r}   $ c\n" for key, value in values.items()) + shape
    assert parse_tir(written, "mine.tir") == values
    assert set(values) == set(NEEDED + ZERO + ONE)
    assert Pac2002._fields == tuple(key.lower() for key in NEEDED + ZERO + ONE)


def test_the_default_car_keeps_its_own_step_and_equal_tyres_share_one() -> None:
    shipped: Any = load_vehicle("hatchback")
    assert build(shipped, ORIGIN, LEVEL).step is step
    assert car().step is car().step
    assert car().step is not step


def test_plain_and_compiled_agree_to_the_bit() -> None:
    vehicle = car(Ground(0.9, 0.03, 0.01))
    slow, fast = Drive(vehicle, plain), Drive(vehicle, compiled)
    rng = random.Random(11)
    for _ in range(30):
        held = {"throttle": rng.random(), "brake": rng.choice([0.0, rng.random()]), "handbrake": rng.choice([0.0, 1.0])}
        turn = rng.uniform(-0.5, 0.5)
        for drive in (slow, fast):
            drive.hold(0.06, automatic=1, gear=1, road_wheel_rad=turn, **held)
        assert not difference(slow.row, fast.row)


def rolling(vehicle: Platform, speed_mps: float) -> Drive:
    """Return the car as it rolls, in plain Python: another tyre would be compiled for half a minute."""
    drive = Drive(vehicle, plain)
    spins = dict.fromkeys(("fl_radps", "fr_radps", "rl_radps", "rr_radps"), speed_mps / 0.306)
    put(drive.row, PLATFORM_AT, CarState(*vehicle.initial_state)._replace(vx_mps=speed_mps, **spins))
    return drive


def test_a_tyre_with_plysteer_is_mounted_mirrored_so_the_car_runs_straight() -> None:
    """A real tyre pulls aside; left and right pull apart, and a drive and its mirror image are equal to the bit."""
    vehicle = car(values=ADAMS)
    assert rolling(vehicle, 20.0).hold(0.2, clutch=1.0).y_m == 0.0
    left, right = rolling(vehicle, 20.0), rolling(vehicle, 20.0)
    for angle in (0.02, -0.05):
        a = left.hold(0.3, clutch=1.0, road_wheel_rad=angle)
        b = right.hold(0.3, clutch=1.0, road_wheel_rad=-angle)
        assert (a.x_m, a.y_m, a.yaw_rad, a.roll_rad) == (b.x_m, -b.y_m, -b.yaw_rad, -b.roll_rad)
        assert a.hand_wheel_torque_nm == -b.hand_wheel_torque_nm
    assert abs(left.state.vy_mps) > 0.01
    turned = [
        rolling(car(values=ADAMS | {"TYRESIDE": side}), 20.0).hold(0.2, clutch=1.0, road_wheel_rad=0.05).yaw_rate_radps
        for side in (1.0, -1.0)
    ]
    assert turned[0] != turned[1], "measured on the other side, toe and camber forces are turned over"


def test_camber_pushes_to_the_lean_as_the_default_tyre_does() -> None:
    for lean in (0.05, -0.05):
        force = pac2002(coefficients(EXAMPLE), Slip(0.0, 0.0, 3600.0, lean, 1.0))
        assert math.copysign(1.0, force.y_n) == -math.copysign(1.0, lean)
        assert abs(force.y_n) > 50.0


def test_a_fleet_on_such_tyres_steps_as_one_car_does() -> None:
    vehicle = car()
    fleet = Fleet([vehicle] * 3)
    alone = Drive(vehicle)
    command = IDLE._replace(automatic=1, gear=1, throttle=0.7, road_wheel_rad=0.1)
    fleet.command(np.tile(command, (3, 1)))
    for _ in range(300):
        fleet.step(SUBSTEPS)
        alone.tick(command)
    assert not difference(fleet.states[1], alone.row[PLATFORM_AT:])


def test_other_coefficients_are_other_code() -> None:
    other = step_on(coefficients(EXAMPLE | {"PDX1": 1.03}))
    assert digest(other) != digest(car().step) != digest(step)


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize(("kappa", "tangent"), [(0.1, 0.0), (-0.15, 0.0), (0.0, 0.08), (-0.08, 0.06), (0.05, -0.05)])
def test_in_steady_motion_the_slip_is_that_of_pac2002(kappa: float, tangent: float, way: float) -> None:
    """Over the speed of travel, in both directions: what was not divided by it comes out as if it were."""
    axle = car_parameters(load("vehicles", "hatchback", CarProfile)).front
    own = make_tyre(coefficients(EXAMPLE))
    speed = 15.0 * way
    spin = speed * (1.0 + way * kappa) / axle.radius_m
    x = y = 0.0
    for _ in range(400):
        now = own(axle, 1.0, 3600.0, speed - spin * axle.radius_m, 15.0 * tangent, spin, x, y, 0.0, 1.0, 0.001)
        x, y = now.deflection_x_m, now.deflection_y_m
    steady = pac2002(coefficients(EXAMPLE), Slip(kappa, tangent, 3600.0, 0.0, 1.0))
    assert (now.force_x_n, now.force_y_n) == pytest.approx((steady.x_n, steady.y_n), rel=1e-6, abs=1e-3)


@pytest.mark.parametrize("slope", [-0.15, 0.15])
def test_holds_on_a_grade(slope: float) -> None:
    drive = Drive(car(Ground(1.0, slope, 0.0)))
    before = drive.hold(10.0, brake=0.5)
    after = drive.hold(60.0, brake=0.5)
    print(f"creep {after.x_m - before.x_m:.3g} m, {after.y_m - before.y_m:.3g} m, speed {after.vx_mps:.3g} m/s")
    assert max(abs(after.x_m - before.x_m), abs(after.y_m - before.y_m)) < 1e-4
    assert abs(after.vx_mps) < 1e-6


def test_launches_turns_and_brakes_as_a_car_does() -> None:
    drive = Drive(car())
    drive.until(lambda seen: seen.vx_mps > 20.0, 20.0, automatic=1, gear=1, throttle=1.0)
    turned = drive.hold(2.0, automatic=1, gear=1, throttle=0.2, road_wheel_rad=0.03)
    print(
        f"yaw rate {turned.yaw_rate_radps:.3f} rad/s, {turned.ay_mps2:.2f} m/s2, rim {turned.hand_wheel_torque_nm:.2f}"
    )
    assert 0.1 < turned.yaw_rate_radps < 0.03 * turned.vx_mps / 2.6
    assert turned.hand_wheel_torque_nm < 0.0  # back to the middle
    drive.hold(2.0, automatic=1, gear=1)
    before = drive.seen
    stopped = drive.until(lambda seen: seen.vx_mps < 0.01, 6.0, brake=1.0)
    way = np.hypot(stopped.x_m - before.x_m, stopped.y_m - before.y_m)
    mean = before.vx_mps**2 / (2.0 * way)
    print(f"braked with {mean:.2f} m/s2 from {before.vx_mps:.1f} m/s")
    assert 7.0 < mean < 10.5
    assert abs(drive.hold(12.0, brake=1.0).vx_mps) < 1e-6
    assert np.all(np.isfinite(drive.row))


def test_the_rim_feels_the_moment_of_the_file() -> None:
    """Twice the aligning moment (scale factor LTR) is felt, at the same side force."""
    torques = []
    for scale in (1.0, 2.0):
        drive = rolling(car(values={**EXAMPLE, "LTR": scale}), 15.0)
        drive.hold(0.5, clutch=1.0, road_wheel_rad=0.02)
        torques.append(-drive.seen.hand_wheel_torque_nm)
    assert 0.0 < 1.1 * torques[0] < torques[1]
