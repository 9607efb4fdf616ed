"""Differential, rolling resistance and engine brake do to the whole car what each is there for."""

import pytest

from simconsole.values.platform import Ground, Patch
from simconsole.values.units import STANDARD_GRAVITY_MPS2
from simconsole.vehicle.platforms import build
from tests.vehicle.altered import HATCHBACK, NO_AIDS, altered, rolling_car
from tests.vehicle.driving import ORIGIN, Drive


def test_rolling_resistance_is_a_share_of_the_weight() -> None:
    slowed = []
    for share in (0.0, 0.02):
        axle = {"rolling_resistance": share}
        drive = rolling_car(altered(body={"drag_area_m2": 0.0}, front=axle, rear=axle), 10.0)
        before = drive.hold(0.5, clutch=1.0).vx_mps
        slowed.append(before - drive.hold(2.0, clutch=1.0).vx_mps)
    turning = 2.0 * (2.2 + 2.0) / 2.0 / 0.306**2  # the wheels' inertia at the rim
    expected = 2.0 * 0.02 * STANDARD_GRAVITY_MPS2 * 1300.0 / (1300.0 + turning)
    assert slowed[0] == pytest.approx(0.0, abs=1e-4)
    assert slowed[1] == pytest.approx(expected, rel=0.02)


def test_a_limited_slip_differential_drives_off_where_an_open_one_spins() -> None:
    """Ice under the left wheels: an open differential gives the right one no more than the ice gives the left."""
    ice = Patch(-1e3, 1e3, 0.1, 10.0, 0.1)
    speeds = []
    for box in ({"lock_nm": 0.0, "lock_share": 0.0}, {"lock_nm": 100.0, "lock_share": 0.0}, {"lock_share": 0.5}):
        profile = altered(gearbox=box, aids=NO_AIDS)
        drive = Drive(build(profile, ORIGIN, Ground(1.0, 0.0, 0.0, patches=(ice,))))
        speeds.append(drive.hold(4.0, automatic=1, gear=1, throttle=0.4).vx_mps)
    print(f"open {speeds[0]:.2f}, preloaded {speeds[1]:.2f}, by torque {speeds[2]:.2f} m/s")
    assert speeds[1] > 1.1 * speeds[0]
    assert speeds[2] > 1.1 * speeds[0]


def test_the_engine_brakes_in_gear_and_more_in_a_lower_one() -> None:
    slowed = []
    for gear in (0, 4, 2):
        drive = rolling_car(HATCHBACK, 15.0)
        drive.hold(0.3, clutch=1.0, gear=gear)
        drive.hold(0.7, gear=gear)
        slowed.append(drive.hold(0.5, gear=gear).ax_mps2)
    print(f"neutral, fourth, second: {slowed} m/s2")
    assert slowed[2] < slowed[1] - 0.1 < slowed[0] - 0.2
