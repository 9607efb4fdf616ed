"""The ground under each wheel: friction, and on a field of heights slope, crests and kerbs."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from simconsole.values.height_field import Grid, HeightField
from simconsole.values.host.jit import compiled, plain
from simconsole.values.platform import Ground, Patch
from simconsole.values.units import STANDARD_GRAVITY_MPS2
from tests.bits import difference
from tests.vehicle.altered import altered, rolling_car
from tests.vehicle.driving import IDLE, TICK_S, Drive, platform
from tests.vehicle.parts import CAR
from tests.vehicle.rolling import rolling

Array = NDArray[Any]


def test_each_wheel_has_the_friction_of_the_patch_it_stands_on() -> None:
    """Ice under the left wheels only: braked without ABS the car turns to the side that grips."""
    ice = Patch(-1e3, 1e3, 0.1, 10.0, 0.2)
    drive = rolling(20.0, Ground(1.0, 0.0, 0.0, patches=(ice,)), anti_lock=False, stability_control=False)
    assert drive.hold(0.6, brake=1.0, clutch=1.0).yaw_rate_radps < -0.05
    there = rolling(20.0, Ground(1.0, 0.0, 0.0, patches=(Patch(*ice[:2], 3.0, 10.0, 0.2),)), anti_lock=False)
    assert there.hold(0.6, brake=1.0, clutch=1.0).yaw_rate_radps == 0.0, "the ice is beside the car"


def test_a_patch_ends_where_it_ends_and_the_later_one_counts() -> None:
    strip = (Patch(10.0, 50.0, -5.0, 5.0, 0.1), Patch(20.0, 30.0, -5.0, 5.0, 1.0))
    drive = rolling(25.0, Ground(1.0, 0.0, 0.0, patches=strip), anti_lock=False)
    seen = {}
    for _ in range(250):
        now = drive.hold(TICK_S, brake=0.9, clutch=1.0)
        seen[round(now.x_m)] = now.ax_mps2
    assert seen[5] < -7.0, "the front wheels are 2.6 m ahead of base_link"
    assert -2.0 < seen[14] < 0.0
    assert seen[21] < -7.0


def corridor(
    height_m: Callable[[Array], Array], length_m: float = 700.0, kerb_m: float = 0.0, kerb_at_m: float = 1e9
) -> Ground:
    """Return ground that rises along x as told, straight across; from a place on there is a kerb and grass."""
    x, y = np.arange(-20.0, length_m), np.arange(-12.0, 13.0)
    high = np.broadcast_to(height_m(x), (len(y), len(x)))
    edge = np.broadcast_to(np.clip(x - kerb_at_m, -4.0, 4.0), (len(y), len(x)))
    grid = Grid(-20.0, -12.0, 1.0, 1.0, len(x), len(y), kerb_m, 0.4)
    return Ground(1.0, 0.0, 0.0, field=HeightField(grid, np.stack((high, edge), axis=-1)))


def coasting(ground: Ground, speed_mps: float) -> Drive:
    """Return a hatchback in neutral, without resistance of air and tyres."""
    body = {"drag_area_m2": 0.0, "front_lift_area_m2": 0.0, "rear_lift_area_m2": 0.0}
    easy = {"rolling_resistance": 0.0}
    return rolling_car(altered(body=body, front=easy, rear=easy), speed_mps, ground)


def load_n(drive: Drive) -> float:
    """Return the load of all tyres, by their deflections."""
    state, front, rear = drive.state, CAR.front, CAR.rear
    lifted = front.carcass_npm * (state.fl_lift_m + state.fr_lift_m)
    return float(
        2.0 * (front.static_n + rear.static_n) - lifted - rear.carcass_npm * (state.rl_lift_m + state.rr_lift_m)
    )


@pytest.mark.parametrize("grade", [0.05, -0.1, 0.2])
def test_grade_resistance_is_that_of_the_slope(grade: float) -> None:
    drive = coasting(corridor(lambda x: grade * x), 18.0)
    drive.hold(2.0, clutch=1.0)
    before = drive.seen
    assert before.z_m == pytest.approx(grade * before.x_m, abs=1e-6)
    assert before.pitch_rad == pytest.approx(-math.atan(grade), abs=2e-3), "REP-103: positive nose down"
    assert before.distance_m == pytest.approx(math.hypot(before.x_m, before.z_m), rel=1e-6)
    after = drive.hold(1.0, clutch=1.0)
    spin_kg = 2.0 * (CAR.front.wheel_inertia_kgm2 + CAR.rear.wheel_inertia_kgm2) / CAR.front.radius_m**2
    wanted = STANDARD_GRAVITY_MPS2 * math.sin(math.atan(grade)) / (1.0 + spin_kg / CAR.body.mass_kg)
    print(f"measured: {before.vx_mps - after.vx_mps:.4f} m/s2, by the slope {wanted:.4f}")
    assert before.vx_mps - after.vx_mps == pytest.approx(wanted, rel=0.001)


def test_a_field_that_is_a_plane_drives_as_the_plane_does() -> None:
    field = rolling(15.0, corridor(lambda x: 0.06 * x))
    plane = rolling(15.0, Ground(1.0, 0.06, 0.0))
    one, other = (drive.hold(4.0, throttle=0.4, road_wheel_rad=0.004, clutch=1.0) for drive in (field, plane))
    assert one.vx_mps == pytest.approx(other.vx_mps, rel=2e-4)
    assert one.yaw_rad == pytest.approx(other.yaw_rad, rel=0.01)


def test_over_hills_the_energy_stays() -> None:
    high_m, long_m = 6.0, 200.0
    drive = coasting(corridor(lambda x: high_m * np.sin(math.tau * x / long_m)), 25.0)
    energies = []
    while drive.seen.x_m < 600.0:
        seen = drive.hold(0.1, clutch=1.0)
        state = drive.state
        spin = CAR.front.wheel_inertia_kgm2 * (state.fl_radps**2 + state.fr_radps**2)
        spin += CAR.rear.wheel_inertia_kgm2 * (state.rl_radps**2 + state.rr_radps**2)
        centre_m = high_m * math.sin(math.tau * (seen.x_m + CAR.body.cg_to_rear_m) / long_m)
        moving = 0.5 * CAR.body.mass_kg * state.vx_mps**2 + 0.5 * spin
        energies.append(moving + CAR.body.mass_kg * STANDARD_GRAVITY_MPS2 * centre_m)
    spread = (max(energies) - min(energies)) / energies[0]
    print(f"measured: energy within {100.0 * spread:.2f} %, at both ends {energies[-1] / energies[0]:.5f}")
    assert spread < 0.005
    assert energies[-1] == pytest.approx(energies[0], rel=0.002)


def test_a_crest_takes_the_load_off_that_its_curvature_takes() -> None:
    radius_m, half_m = 300.0, 45.0

    def hill(x: Array) -> Array:
        from_top = np.abs(x - 80.0)
        round_top = np.minimum(from_top, half_m) ** 2
        return -(round_top + 2.0 * half_m * np.maximum(from_top - half_m, 0.0)) / (2.0 * radius_m)

    drive = coasting(corridor(hill), 25.0)
    loads, wanted = [], []
    while drive.seen.x_m < 95.0:
        seen = drive.hold(TICK_S, clutch=1.0)
        if seen.x_m > 65.0:
            loads.append(load_n(drive))
            wanted.append(CAR.body.mass_kg * (STANDARD_GRAVITY_MPS2 - seen.vx_mps**2 / radius_m))
    print(f"measured: load on the crest {np.mean(loads):.0f} N, by its curvature {np.mean(wanted):.0f} N")
    assert np.mean(loads) == pytest.approx(np.mean(wanted), rel=0.02)
    assert np.mean(loads) < 0.85 * CAR.body.mass_kg * STANDARD_GRAVITY_MPS2


@pytest.mark.parametrize("speed_mps", [3.0, 12.0])
def test_a_kerb_lifts_wheels_then_the_car_and_takes_speed_but_gives_none(speed_mps: float) -> None:
    drive = coasting(corridor(lambda x: 0.0 * x, 120.0, kerb_m=0.1, kerb_at_m=15.0), speed_mps)
    lifts, heaves = [], []
    while drive.seen.x_m < 40.0:
        drive.hold(TICK_S, clutch=1.0)
        lifts.append(drive.state.fl_lift_m)
        heaves.append(drive.state.heave_m)
    assert drive.seen.z_m == pytest.approx(0.1, abs=1e-9)
    assert abs(drive.state.heave_m) < 0.01
    assert -0.12 < min(heaves) < -0.02, "the body is left behind as the wheels rise"
    assert abs(drive.seen.y_m) < 1e-9
    climbed = math.sqrt(speed_mps**2 - 2.0 * STANDARD_GRAVITY_MPS2 * 0.1)
    assert 0.75 * speed_mps < drive.seen.vx_mps <= climbed + 0.1


def test_grass_beside_the_road_holds_less() -> None:
    stops = []
    for grass_at_m in (1e9, -50.0):
        drive = rolling(20.0, corridor(lambda x: 0.0 * x, 150.0, kerb_at_m=grass_at_m), anti_lock=False)
        stops.append(drive.until(lambda seen: seen.vx_mps < 0.1, 12.0, brake=1.0, clutch=1.0).x_m)
    assert stops[1] == pytest.approx(stops[0] / 0.4, rel=0.1)


def test_on_a_field_both_executions_are_equal_to_the_last_bit() -> None:
    draw = np.random.default_rng(3)
    ground = corridor(lambda x: draw.uniform(0.0, 0.05, len(x)), 100.0, kerb_m=0.08, kerb_at_m=25.0)
    slow, fast = (Drive(platform(ground=ground), execution) for execution in (plain, compiled))
    for tick in range(1500):
        command = IDLE._replace(throttle=1.0, gear=1.0, automatic=1.0, road_wheel_rad=0.2 * math.sin(0.01 * tick))
        slow.tick(command)
        fast.tick(command)
        assert not difference(slow.row, fast.row), tick
    assert fast.seen.x_m > 15.0
