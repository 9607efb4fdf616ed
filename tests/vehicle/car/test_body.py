"""What wind, the road's bank and the car's own acceleration do to the body."""

import math

import pytest

from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.kernels import put
from simconsole.values.platform import Ground
from simconsole.values.state_vector import PLATFORM_AT
from simconsole.values.units import STANDARD_GRAVITY_MPS2
from simconsole.vehicle.car.state import CarState
from simconsole.vehicle.platforms import build
from tests.vehicle.altered import HATCHBACK, WHEELS, altered, loads, rolling_car
from tests.vehicle.driving import ORIGIN, Drive, platform
from tests.vehicle.rolling import rolling

DRAG_AREA_M2 = 0.68
MASS_KG = 1300.0
SPINS = ("fl_radps", "fr_radps", "rl_radps", "rr_radps")


def test_head_wind_slows_by_the_drag_of_the_air_that_meets_the_car() -> None:
    slowed = []
    for wind in (0.0, -10.0, 10.0):
        drive = rolling(30.0, Ground(1.0, 0.0, 0.0, wind_x_mps=wind))
        seen = drive.hold(0.5, clutch=1.0)
        slowed.append(seen.ax_mps2)
        print(f"wind {wind} m/s: {seen.ax_mps2:.3f} m/s2 at {seen.vx_mps:.2f} m/s")
        assert seen.coast_accel_mps2 == pytest.approx(seen.ax_mps2, abs=0.05)
    speed = 30.0 + 0.5 * slowed[0]
    for wind, accel in ((10.0, slowed[1]), (-10.0, slowed[2])):
        more = 0.5 * 1.225 * DRAG_AREA_M2 * ((speed + wind) ** 2 - speed**2) / MASS_KG
        assert accel - slowed[0] == pytest.approx(-more, rel=0.05)


def test_side_wind_pushes_to_its_side_and_mirrored_wind_to_the_other() -> None:
    ends = [rolling(25.0, Ground(1.0, 0.0, 0.0, wind_y_mps=wind)).hold(2.0, clutch=1.0) for wind in (12.0, -12.0)]
    print(f"{ends[0].y_m:.3f} m aside in 2 s")
    assert ends[0].y_m > 0.05
    assert ends[0].y_m == -ends[1].y_m
    assert ends[0].roll_rad == -ends[1].roll_rad


@pytest.mark.parametrize("name", ["hatchback", "light_van"])
def test_wind_from_the_side_turns_the_nose_away_from_it(name: str) -> None:
    """Side force and yaw moment of the air as their coefficients say, about the middle of the wheelbase."""
    profile = load("vehicles", name, CarProfile)
    body = profile.body
    speed, wind = 25.0, -8.0
    accelerations = []
    for air in (0.0, wind):
        vehicle = build(profile, ORIGIN, Ground(1.0, 0.0, 0.0, wind_y_mps=air))
        drive = Drive(vehicle)
        start = CarState(*vehicle.initial_state)._replace(vx_mps=speed)
        put(drive.row, PLATFORM_AT, start._replace(**dict.fromkeys(SPINS, speed / profile.front.wheel_radius_m)))
        drive.step(drive.row, drive.row, vehicle.parameters, vehicle.ground, 1)
        accelerations.append((drive.state.ay_mps2, drive.state.yaw_rate_radps / 0.001))
    pressure = 0.5 * 1.225
    side_n = pressure * body.side_area_m2 * math.hypot(speed, wind) * wind
    moment_nm = pressure * body.yaw_volume_m3 * speed * wind
    behind_m = body.wheelbase_m * (body.front_mass_share - 0.5)  # the middle of the wheelbase, of the centre of gravity
    moved, turned = (after - before for before, after in zip(*accelerations, strict=True))
    assert moved == pytest.approx(side_n / body.mass_kg, rel=1e-6)
    assert turned == pytest.approx(
        (moment_nm - wind / abs(wind) * abs(side_n) * behind_m) / body.yaw_inertia_kgm2, rel=0.01
    )
    assert turned < 0.0, "wind to the right"


def test_a_body_in_oblique_air_turns_broadside_also_when_it_comes_from_behind() -> None:
    turned = []
    for wind in (-20.0, 20.0):
        drive = Drive(platform(ground=Ground(1.0, 0.0, 0.0, wind_x_mps=wind, wind_y_mps=-5.0)))
        drive.step(drive.row, drive.row, drive.vehicle.parameters, drive.vehicle.ground, 1)
        turned.append(drive.state.yaw_rate_radps)
    assert turned[0] < 0.0 < turned[1]


def test_a_storm_does_not_move_a_braked_car() -> None:
    drive = Drive(platform(ground=Ground(1.0, 0.0, 0.0, wind_x_mps=20.0, wind_y_mps=20.0)))
    before = drive.hold(10.0, brake=0.5)
    after = drive.hold(10.0, brake=0.5)
    assert math.hypot(after.x_m - before.x_m, after.y_m - before.y_m) < 1e-6


def test_braking_dives_and_driving_squats() -> None:
    """ISO 8855: pitch is positive nose down."""
    assert rolling_car(HATCHBACK, 25.0).hold(0.6, brake=0.5, clutch=1.0).pitch_rad > 0.01
    assert rolling_car(HATCHBACK, 5.0).hold(1.0, automatic=1, gear=1, throttle=1.0).pitch_rad < -0.003


def test_air_lifts_each_axle_by_its_area() -> None:
    speed = 50.0
    found = []
    for front_m2, rear_m2 in ((0.0, 0.0), (0.3, -0.2)):
        body = {"front_lift_area_m2": front_m2, "rear_lift_area_m2": rear_m2, "drag_area_m2": 0.0}
        profile = altered(body=body)
        drive = rolling_car(profile, speed)
        drive.hold(2.0, clutch=1.0)
        found.append((loads(drive, profile), drive.state.vx_mps))
    pressure = 0.5 * 1.225 * found[1][1] ** 2
    front, rear = (
        sum(found[1][0][w] - found[0][0][w] for w in WHEELS if w[0] == axle) / pressure for axle in ("f", "r")
    )
    print(f"front {front:.3f} m2, rear {rear:.3f} m2")
    assert front == pytest.approx(-0.3, abs=0.01)
    assert rear == pytest.approx(0.2, abs=0.01)


def test_a_banked_road_loads_the_lower_wheels_and_pulls_the_car_down() -> None:
    ground = Ground(1.0, 0.0, 0.15)  # rises to the left
    drive = rolling_car(HATCHBACK, 0.0, ground)
    drive.hold(10.0, brake=1.0)
    on = loads(drive, HATCHBACK, ground)
    moment = 1300.0 * STANDARD_GRAVITY_MPS2 * 0.15 / math.hypot(1.0, 0.15) * 0.55
    carried = 0.5 * (1.53 * (on["fr"] - on["fl"]) + 1.51 * (on["rr"] - on["rl"]))
    print(f"{carried:.0f} N m of {moment:.0f} N m, the sway of the body aside")
    assert carried == pytest.approx(moment, rel=0.1)
    assert rolling_car(HATCHBACK, 20.0, ground).hold(2.0, clutch=1.0).y_m < -0.3
