import math

import pytest

from simconsole.control.requests.control_settings import settings
from simconsole.profiles.control import ControlProfile


@pytest.mark.parametrize(
    ("tick_hz", "steering", "stale", "fade"),
    [
        (50, 3.0, 10.0, 30.0),
        (100, 5.0, 20.0, 60.0),
        (125, 7.0, 25.0, 75.0),
        (250, 13.0, 50.0, 150.0),
        (1000, 50.0, 200.0, 600.0),
    ],
)
def test_times_become_whole_ticks_on_the_safe_side(tick_hz: int, steering: float, stale: float, fade: float) -> None:
    s = settings(ControlProfile(), 15.0, 0.6, 2.6, tick_hz)
    assert s.steering_override_ticks == steering
    assert s.stale_ticks == stale
    assert s.fade_per_tick == 1.0 / fade
    assert s.minimal_risk_ticks == 10.0 * tick_hz


def test_no_time_is_less_than_a_tick() -> None:
    s = settings(
        ControlProfile(steering_override_hold_s=0.0, command_stale_s=0.02, standstill_s=0.0), 15.0, 0.6, 2.6, 50
    )
    assert (s.steering_override_ticks, s.stale_ticks, s.standstill_ticks) == (1.0, 1.0, 1.0)


def test_angles_and_locks_are_converted() -> None:
    s = settings(ControlProfile(), 15.0, 0.6, 2.6, 250)
    assert math.isclose(s.steering_override_rad, math.radians(8.0))
    assert math.isclose(s.steering_release_rad, math.radians(7.0))
    assert math.isclose(s.manual_road_wheel_radps, math.radians(1500.0) / 15.0)
    assert s.automatic_road_wheel_rad == 0.6
    assert s.road_wheel_per_hand_wheel == 1.0 / 15.0
    wide = settings(
        ControlProfile(steering_override_deg=1.0, steering_override_hysteresis_deg=10.0), 15.0, 2.0, 2.6, 250
    )
    assert wide.steering_release_rad == 0.0
    assert wide.automatic_road_wheel_rad == 1.0


def test_what_is_chosen_by_name_becomes_a_number() -> None:
    for steering, haptic in (("blended", 0.0), ("haptic", 1.0)):
        s = settings(ControlProfile(shared_steering=steering), 15.0, 0.6, 2.6, 250)  # type: ignore[arg-type]
        assert s.shared_haptic == haptic


def test_every_setting_is_a_finite_float() -> None:
    for value in settings(ControlProfile(), 15.0, 0.6, 2.6, 250):
        assert type(value) is float
        assert math.isfinite(value)
