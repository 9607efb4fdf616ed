"""What touches do to the vehicle and to others."""

import pytest

from simconsole.values.host.jit import plain
from simconsole.values.platform import Solid
from simconsole.values.signals import NO_IMPACT, VehicleState
from simconsole.world.traffic.crashes import NO_CRASH, Crashes
from simconsole.world.traffic.road_users import RoadUser, RoadUserKind, table
from tests.world.traffic.made import box

SOLID = Solid(mass_kg=1400.0, yaw_inertia_kgm2=2000.0, cg_ahead_m=1.2)


def vehicle(vx_mps: float) -> VehicleState:
    nought = VehicleState(*(0.0,) * len(VehicleState._fields))
    return nought._replace(x_m=-1.2, vx_mps=vx_mps)


def user(x_m: float, kind: RoadUserKind = RoadUserKind.CAR, speed_mps: float = 0.0) -> RoadUser:
    size = (0.5, 0.5) if kind == RoadUserKind.PEDESTRIAN else (4.5, 1.8)
    return RoadUser(
        id=5.0,
        kind=float(kind),
        x_m=x_m,
        y_m=0.0,
        yaw_rad=0.0,
        speed_mps=speed_mps,
        length_m=size[0],
        width_m=size[1],
        height_m=1.5,
    )


def test_standing_car_takes_half_of_the_speed_and_is_new_once() -> None:
    crashes, rows = Crashes(SOLID, plain), table([user(4.3)])
    crash = crashes.step(vehicle(10.0), box(0.0, 0.0), rows)
    assert crash.new == {5.0}
    assert crash.impact.first_touch == 1.0
    assert crash.impact.vx_mps == pytest.approx(-5.5)
    assert crash.pushed == ((5.0, pytest.approx(5.5)),)
    again = crashes.step(vehicle(2.0), box(0.0, 0.0), rows)
    assert (again.new, again.impact.first_touch) == (frozenset(), 0.0)
    assert again.impact.vx_mps < 0.0, "who goes on pushing is held on"
    assert crashes.step(vehicle(2.0), box(0.0, 0.0), table([user(9.0)])) == NO_CRASH


def test_a_person_is_struck_once() -> None:
    crashes, rows = Crashes(SOLID, plain), table([user(2.3, RoadUserKind.PEDESTRIAN)])
    first = crashes.step(vehicle(10.0), box(0.0, 0.0), rows)
    assert -1.0 < first.impact.vx_mps < -0.3
    assert crashes.step(vehicle(9.0), box(0.0, 0.0), rows).impact == NO_IMPACT


def test_who_drives_into_its_rear_pushes_the_vehicle_on() -> None:
    crash = Crashes(SOLID, plain).step(vehicle(0.0), box(0.0, 0.0), table([user(-4.3, speed_mps=8.0)]))
    assert crash.impact.vx_mps == pytest.approx(4.4)
    assert crash.pushed == ((5.0, pytest.approx(-4.4)),)


def test_without_a_body_touches_are_told_and_move_nobody() -> None:
    crash = Crashes(None, plain).step(vehicle(10.0), box(0.0, 0.0), table([user(4.3)]))
    assert (crash.new, crash.impact, crash.pushed) == ({5.0}, NO_IMPACT._replace(first_touch=1.0), ())
