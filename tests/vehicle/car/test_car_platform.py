"""From a car's profile to its parameters: what follows from several values of it."""

import math

import msgspec
import pytest

from simconsole.profiles.files.loader import load
from simconsole.profiles.tyre import TirTyre
from simconsole.profiles.vehicle import CarProfile
from simconsole.values.errors import ProfileError
from simconsole.values.platform import MOST_PATCHES, Ground, Patch
from simconsole.values.units import STANDARD_GRAVITY_MPS2
from simconsole.vehicle.car.car_platform import build_car, car_parameters
from simconsole.vehicle.car.state import CarState
from tests.vehicle.altered import HATCHBACK, altered, rolling_car
from tests.vehicle.driving import LEVEL, ORIGIN, Drive, platform
from tests.vehicle.parts import CAR


def test_more_patches_than_there_is_room_for_are_refused() -> None:
    with pytest.raises(ValueError, match="at most 4"):
        platform(ground=Ground(1.0, 0.0, 0.0, patches=(Patch(0.0, 1.0, 0.0, 1.0, 0.5),) * (MOST_PATCHES + 1)))


def test_the_sprung_and_the_unsprung_arms_together_are_the_height_of_the_whole_car() -> None:
    """A side force of both axles rolls the car about the ground with the moment of its centre of gravity."""
    front, rear = CAR.front, CAR.rear
    share = rear.ahead_m / (rear.ahead_m - front.ahead_m)  # of a force at the centre of gravity
    arm = share * (front.roll_arm_m + front.link_arm_m) + (1.0 - share) * (rear.roll_arm_m + rear.link_arm_m)
    assert arm == pytest.approx(CAR.body.cg_height_m)


def test_a_car_stands_on_a_slope_as_it_will_rest_there() -> None:
    """The slope takes load off the tyres: the body starts where springs and tyres then hold it."""
    steep = Drive(build_car(HATCHBACK, ORIGIN, Ground(1.0, 0.0, 0.4)))
    before = steep.state
    assert before.heave_m > 0.005
    steep.hold(0.02, brake=1.0)
    now = steep.state
    assert (now.heave_m, now.pitch_rad) == pytest.approx((before.heave_m, before.pitch_rad), abs=2e-4)
    assert build_car(HATCHBACK, ORIGIN, LEVEL).initial_state[CarState._fields.index("heave_m")] == 0.0


def test_full_brake_is_what_brakes_give_or_the_ground_holds() -> None:
    weight_n = HATCHBACK.body.mass_kg * STANDARD_GRAVITY_MPS2

    def full_brake_n(profile: CarProfile, friction: float) -> float:
        seen = build_car(profile, ORIGIN, Ground(friction, 0.0, 0.0)).initial_vehicle
        return -seen.full_brake_accel_mps2 * car_parameters(profile).body.moving_kg

    assert full_brake_n(HATCHBACK, 0.1) == pytest.approx(0.1 * weight_n, rel=0.1)
    weak = altered(front={"brake_nm": 100.0}, rear={"brake_nm": 50.0})
    assert full_brake_n(weak, 1.0) == pytest.approx(150.0 / CAR.front.radius_m, rel=0.1)


def test_a_tyre_file_that_was_not_read_is_refused_by_key() -> None:
    profile = msgspec.structs.replace(HATCHBACK, tyre=TirTyre(tir="mine.tir"))
    with pytest.raises(ProfileError, match=r"tyre\.coefficients: value missing: those of mine\.tir"):
        build_car(profile, ORIGIN, LEVEL)


@pytest.mark.parametrize("name", ["hatchback", "light_van"])
def test_the_links_hold_the_dive_of_braking(name: str) -> None:
    """Passenger cars dive by 1 to 1.7 degrees per g; without the slope of the links it would be nearly 3."""
    dives = []
    shipped = load("vehicles", name, CarProfile)
    front, rear = (msgspec.structs.replace(axle, support_deg=0.0) for axle in (shipped.front, shipped.rear))
    for profile in (shipped, msgspec.structs.replace(shipped, front=front, rear=rear)):
        seen = rolling_car(profile, 25.0).hold(1.5, clutch=1.0, brake=0.3)
        dives.append(math.degrees(seen.pitch_rad) / (-seen.ax_mps2 / STANDARD_GRAVITY_MPS2))
    assert 1.0 < dives[0] < 1.7
    assert dives[1] > 2.5
