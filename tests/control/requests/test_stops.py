"""Safe stops: by the book, with weak brakes, backward, blind."""

import math
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.values.signals import Event, Mode, Reason, Validity

MakeRig = Callable[..., Any]


def test_a_stop_that_nobody_steers_is_short_and_stays_stopped(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS, speed_mps=15.0)
    rig.send(road_wheel_rad=0.05)
    rig.run(2.0)
    rig.sending = False
    rig.until(Mode.MINIMAL_RISK)
    assert rig.command.road_wheel_rad == pytest.approx(0.05, abs=0.001)
    decel, jerk, before = [], [], rig.vehicle.ax_mps2
    while rig.mode is Mode.MINIMAL_RISK and rig.vehicle.vx_mps > 0.2:
        rig.tick()
        decel.append(-rig.vehicle.ax_mps2)
        jerk.append((before - rig.vehicle.ax_mps2) / rig.tick_s)
        before = rig.vehicle.ax_mps2
        assert rig.command.throttle == 0.0
    assert max(decel) <= 3.9, "nobody steers: harder, but never beyond 4"
    assert decel[-1] == pytest.approx(3.5, abs=0.2)
    assert 4.0 < max(jerk[2:]) < 6.0
    held_s = rig.memory.mode_ticks * rig.tick_s
    straightened_rad = rig.settings.stop_road_wheel_decay_radps * held_s
    assert rig.command.road_wheel_rad == pytest.approx(0.05 - straightened_rad, abs=1e-3)
    rig.until(Mode.STOPPED)
    assert rig.reason is Reason.STANDSTILL
    rig.send()
    rig.driver = rig.driver._replace(throttle=0.8)
    rig.run(3.0)
    assert rig.mode is Mode.STOPPED
    assert rig.vehicle.vx_mps == 0.0
    assert (rig.command.brake, rig.command.handbrake, rig.command.gear) == (0.4, 1.0, 0.0)


def test_a_safe_stop_whose_brakes_are_weak_asks_for_more_but_never_beyond_four(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.MANUAL, speed_mps=30.0)
    move = rig._move

    def weak() -> None:
        speed = rig.vehicle.vx_mps
        move()
        rig.vehicle = rig.vehicle._replace(vx_mps=speed - 0.3 * (speed - rig.vehicle.vx_mps))
        rig.vehicle = rig.vehicle._replace(ax_mps2=(rig.vehicle.vx_mps - speed) / rig.tick_s)

    rig._move = weak
    rig.tick(Event.LOOP_STALL)
    rig.run(8.0)
    asked = -0.3 - rig.command.brake * 8.7
    assert -4.0 - 1e-9 <= asked < -3.2
    assert rig.memory.speed_integral_mps2 == -rig.settings.integral_max_mps2


def test_a_safe_stop_also_stops_a_car_that_rolls_backward(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.MANUAL, speed_mps=5.0)
    rig._move = lambda: None
    rig.vehicle = rig.vehicle._replace(
        vx_mps=-5.0, gear=-1.0, coast_accel_mps2=0.3, full_throttle_accel_mps2=-3.0, full_brake_accel_mps2=9.0
    )
    rig.tick(Event.LOOP_STALL)
    rig.run(2.0)
    assert rig.command.brake > 0.2
    assert (rig.command.gear, rig.command.automatic) == (-1.0, 1.0)


def test_a_vehicle_whose_speed_is_no_number_is_braked_and_never_counts_as_standing(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.MANUAL)
    rig._move = lambda: None
    rig.vehicle = rig.vehicle._replace(vx_mps=math.nan, ax_mps2=math.nan, gear=math.nan)
    rig.tick(Event.LOOP_STALL)
    rig.run(3.0)
    assert rig.mode is Mode.MINIMAL_RISK
    assert rig.command.brake > 0.2
    assert rig.command.gear == 0.0


@pytest.mark.parametrize("event", [Event.LOOP_STALL, None])
def test_a_controller_that_is_well_goes_on_steering_the_stop(make_rig: MakeRig, event: Event | None) -> None:
    rig = make_rig().drive(Mode.TAKEOVER_REQUESTED)
    if event is None:
        rig.until(Mode.MINIMAL_RISK)
    else:
        rig.tick(event)
    assert rig.reason is (Reason.NO_REACTION if event is None else Reason.LOOP_STALL)
    rig.remote = rig.remote._replace(road_wheel_rad=0.02)
    rig.run(0.5)
    assert rig.command.road_wheel_rad == pytest.approx(0.02)
    assert rig.command.brake > 0.0
    rig.sending = False
    rig.run(0.3)
    held = rig.command.road_wheel_rad
    assert 0.0 <= held < 0.02, "silent by now: held, and slowly straightened"
    rig.sending = True
    rig.remote = rig.remote._replace(road_wheel_rad=-0.02)
    rig.run(0.5)
    assert rig.mode is Mode.MINIMAL_RISK
    assert 0.0 <= rig.command.road_wheel_rad <= held, "a controller that failed once steers this stop no more"


def test_a_stop_that_the_controller_steers_brakes_by_the_book(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.AUTONOMOUS, speed_mps=15.0)
    rig.run(2.0)
    rig.tick(Event.LOOP_STALL)
    decel, jerk, before = [], [], rig.vehicle.ax_mps2
    while rig.mode is Mode.MINIMAL_RISK and rig.vehicle.vx_mps > 0.2:
        rig.tick()
        decel.append(-rig.vehicle.ax_mps2)
        jerk.append((before - rig.vehicle.ax_mps2) / rig.tick_s)
        before = rig.vehicle.ax_mps2
    assert max(decel) <= 2.8
    assert decel[-1] == pytest.approx(2.5, abs=0.2)
    assert max(jerk[2:]) < 2.0


@pytest.mark.parametrize("mode", [Mode.MANUAL, Mode.SHARED])
@pytest.mark.parametrize(("asked_rad", "steers"), [(0.045, True), (0.06, False)])
def test_a_person_whose_wheel_is_lost_is_stopped_by_a_controller_that_agrees(
    mode: Mode, asked_rad: float, steers: bool, make_rig: MakeRig
) -> None:
    """At 10 m/s, 2 m/s2 beside the straight line of the person are 0.052 rad."""
    rig = make_rig().drive(mode)
    rig.settings = rig.settings._replace(shared_lateral=0.0)
    rig.send(road_wheel_rad=asked_rad)
    rig.run(0.7)
    rig.driver = rig.driver._replace(wheel_validity=float(Validity.LOST))
    rig.tick()
    assert (rig.mode, rig.reason) == (Mode.MINIMAL_RISK, Reason.DEVICE_LOST)
    rig.run(1.0)
    assert (rig.mode, rig.command.road_wheel_rad) == (Mode.MINIMAL_RISK, asked_rad if steers else 0.0)
    assert rig.command.brake > 0.0


@pytest.mark.parametrize("fault", ["silent", "unsteady"])
def test_a_controller_that_is_not_steady_does_not_steer_it(fault: str, make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.MANUAL)
    rig.send(road_wheel_rad=0.02)
    rig.run(0.2)
    if fault == "silent":
        rig.sending = False
        rig.run(0.3)
    else:
        rig.refuse()
        rig.tick()
    rig.driver = rig.driver._replace(wheel_validity=float(Validity.LOST))
    rig.run(1.0)
    assert (rig.mode, rig.command.road_wheel_rad) == (Mode.MINIMAL_RISK, 0.0)


def test_a_wheel_that_is_back_takes_over_by_the_brake(make_rig: MakeRig) -> None:
    rig = make_rig().drive(Mode.MANUAL)
    rig.driver = rig.driver._replace(wheel_validity=float(Validity.LOST))
    rig.run(0.5)
    assert rig.mode is Mode.MINIMAL_RISK
    rig.driver = rig.driver._replace(wheel_validity=float(Validity.LIVE), brake=0.2)
    assert rig.until(Mode.MANUAL) == rig.settings.device_back_ticks
    assert rig.reason is Reason.BRAKE_OVERRIDE
