"""What comes from outside: wind, patches of other friction, switches for the driver aids."""

import math

import pytest

from simconsole.profiles.files.loader import load
from simconsole.profiles.session import Environment, FrictionPatch
from simconsole.profiles.vehicle import CarProfile
from simconsole.tick.assembly import ground_of
from simconsole.values.kernels import put
from simconsole.values.platform import MOST_PATCHES, Ground, Patch, Pose
from simconsole.values.signals import GearFault
from simconsole.values.state_vector import PLATFORM_AT
from simconsole.values.units import KMH_PER_MPS
from simconsole.vehicle.car.state import CarState
from simconsole.vehicle.platforms import build
from tests.vehicle.driving import ORIGIN, TICK_S, Drive, platform
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
        drive.step(drive.row, drive.row, vehicle.parameters, 1)
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
        drive.step(drive.row, drive.row, drive.vehicle.parameters, 1)
        turned.append(drive.state.yaw_rate_radps)
    assert turned[0] < 0.0 < turned[1]


def test_the_plane_tells_height_and_both_angles() -> None:
    """A car that stands across a slope of two directions: the normal of its plane is that of the ground."""
    for slope_x, slope_y, yaw in ((0.2, 0.0, 0.0), (0.1, -0.2, 0.9), (0.0, 0.3, -2.0)):
        drive = Drive(platform(ground=Ground(1.0, slope_x, slope_y), pose=Pose(30.0, -20.0, yaw)))
        seen = drive.vehicle.initial_vehicle
        normal = math.sqrt(1.0 + slope_x**2 + slope_y**2)
        assert seen.z_m == pytest.approx((slope_x * 30.0 - slope_y * 20.0) / normal, rel=1e-12)
        assert -math.sin(seen.pitch_rad) == pytest.approx(
            (slope_x * math.cos(yaw) + slope_y * math.sin(yaw)) / normal, rel=1e-6, abs=1e-12
        )
        assert math.cos(seen.pitch_rad) * math.cos(seen.roll_rad) == pytest.approx(1.0 / normal, rel=1e-6)
        assert math.copysign(1.0, seen.roll_rad) == math.copysign(
            1.0, slope_y * math.cos(yaw) - slope_x * math.sin(yaw)
        )


def test_a_storm_does_not_move_a_braked_car() -> None:
    drive = Drive(platform(ground=Ground(1.0, 0.0, 0.0, wind_x_mps=20.0, wind_y_mps=20.0)))
    before = drive.hold(10.0, brake=0.5)
    after = drive.hold(10.0, brake=0.5)
    assert math.hypot(after.x_m - before.x_m, after.y_m - before.y_m) < 1e-6


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


def test_more_patches_than_there_is_room_for_are_refused() -> None:
    with pytest.raises(ValueError, match="at most 4"):
        platform(ground=Ground(1.0, 0.0, 0.0, patches=(Patch(0.0, 1.0, 0.0, 1.0, 0.5),) * (MOST_PATCHES + 1)))


def test_the_session_names_wind_and_patches() -> None:
    patch = FrictionPatch(from_x_m=1.0, to_x_m=2.0, from_y_m=3.0, to_y_m=4.0, friction_share=0.5)
    ground = ground_of(Environment(wind_mps=10.0, wind_to_deg=90.0, friction_patches=(patch,)))
    assert (ground.wind_x_mps, ground.wind_y_mps) == (pytest.approx(0.0, abs=1e-9), 10.0)
    assert ground.patches == (Patch(1.0, 2.0, 3.0, 4.0, 0.5),)


def test_switched_off_anti_lock_locks_the_wheels() -> None:
    for off, locked in ((0.0, False), (1.0, True)):
        drive = rolling(25.0)
        drive.hold(1.0, brake=1.0, clutch=1.0, anti_lock_off=off)
        assert (drive.state.fl_radps == 0.0) == locked


def test_switched_off_traction_control_spins_and_stability_control_stays_away() -> None:
    spins = []
    for off in (0.0, 1.0):
        drive = rolling(3.0, Ground(0.3, 0.0, 0.0))
        drive.hold(1.5, automatic=1, gear=1, throttle=1.0, traction_off=off)
        spins.append(drive.state.fl_radps)
    assert spins[1] > 1.5 * spins[0]
    drive = rolling(25.0, Ground(0.4, 0.0, 0.0))
    drive.hold(1.0, road_wheel_rad=0.3, stability_off=1.0)
    assert drive.state.stability_nm == 0.0
    assert drive.hold(0.2, road_wheel_rad=-0.3).gear == 0.0
    assert drive.state.stability_nm != 0.0, "on again"


def test_the_gearbox_tells_why_a_gear_does_not_go_in() -> None:
    drive = rolling(15.0)
    assert drive.hold(0.1, gear=2).gear_fault == GearFault.GRIND, "no clutch, and the engine idles"
    assert drive.seen.gear == 0.0
    assert drive.hold(0.1, gear=2, clutch=1.0).gear_fault == 0.0
    assert drive.seen.gear == 2.0
    assert drive.hold(0.1, gear=-1, clutch=1.0).gear_fault == GearFault.MISSED
    assert drive.hold(0.1, gear=7, clutch=1.0).gear_fault == GearFault.MISSED, "six gears"
    assert drive.hold(0.1, gear=0, clutch=1.0).gear_fault == 0.0
    drive = rolling(80.0 / KMH_PER_MPS)
    assert drive.hold(0.1, gear=1, clutch=1.0).gear_fault == GearFault.MONEY_SHIFT
    assert drive.hold(0.1, gear=1).gear_fault == GearFault.MONEY_SHIFT | GearFault.GRIND
    assert drive.seen.gear == 0.0
    assert drive.hold(0.1, automatic=1, gear=1).gear_fault == 0.0
