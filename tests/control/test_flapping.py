"""A cockpit that comes and goes: the car is not handed to and fro."""

from collections.abc import Callable
from typing import Any

import pytest

from simconsole.values.signals import Button, Mode, Reason, Validity


def flicker(rig: Any, seconds: float, period_s: float, **there: float) -> int:
    """Let wheel and pedals come and go every `period_s`, while the person holds `there`; return the mode's changes."""
    changes, mode = 0, rig.mode
    for tick in range(round(seconds * rig.tick_hz)):
        gone = tick // round(period_s * rig.tick_hz) % 2 == 0
        validity = float(Validity.STALE if gone else Validity.LIVE)
        pedals = {"throttle_validity": validity, "brake_validity": validity}
        values = dict.fromkeys(there, 0.0) if gone and "brake" in there else there
        rig.driver = rig.driver._replace(wheel_validity=validity, **pedals, **values)
        rig.tick()
        changes += rig.mode is not mode
        mode = rig.mode
    return changes


@pytest.mark.parametrize("period_s", [0.02, 0.1, 0.18, 0.4])
@pytest.mark.parametrize("mode", [Mode.MANUAL, Mode.SHARED, Mode.AUTONOMOUS, Mode.TAKEOVER_REQUESTED])
def test_a_cockpit_that_comes_and_goes_changes_the_mode_a_few_times_at_most(
    mode: Mode, period_s: float, make_rig: Callable[..., Any]
) -> None:
    rig = make_rig().drive(mode)
    assert flicker(rig, 3.3, period_s, brake=0.3) <= 3
    assert rig.mode is Mode.MINIMAL_RISK


def test_a_cockpit_that_is_back_for_good_takes_over_after_its_time(make_rig: Callable[..., Any]) -> None:
    rig = make_rig().drive(Mode.MANUAL)
    flicker(rig, 0.2, 1.0, brake=0.3)
    assert (rig.mode, rig.reason) == (Mode.MINIMAL_RISK, Reason.DEVICE_LOST)
    live = float(Validity.LIVE)
    rig.driver = rig.driver._replace(wheel_validity=live, throttle_validity=live, brake_validity=live, brake=0.3)
    assert rig.until(Mode.MANUAL) == rig.settings.device_back_ticks
    assert rig.reason is Reason.BRAKE_OVERRIDE


def test_a_button_asks_at_once(make_rig: Callable[..., Any]) -> None:
    rig = make_rig().drive(Mode.MANUAL)
    flicker(rig, 0.2, 1.0, brake=0.3)
    live = float(Validity.LIVE)
    rig.driver = rig.driver._replace(wheel_validity=live, throttle_validity=live, brake_validity=live, brake=0.3)
    rig.tick(edge=Button.MANUAL)
    assert rig.mode is Mode.MANUAL


def test_the_brake_counts_in_full_while_the_cockpit_is_not_yet_trusted_with_the_car(
    make_rig: Callable[..., Any],
) -> None:
    rig = make_rig().drive(Mode.MANUAL)
    flicker(rig, 0.2, 1.0, brake=0.9)
    live = float(Validity.LIVE)
    rig.driver = rig.driver._replace(wheel_validity=live, throttle_validity=live, brake_validity=live, brake=0.9)
    rig.tick()
    assert (rig.mode, rig.request.brake) == (Mode.MINIMAL_RISK, 0.9)
