"""The settings of control: what is refused."""

import msgspec
import pytest

from simconsole.profiles.control import ControlProfile


@pytest.mark.parametrize(
    "text",
    [
        {"fade_s": 0.0},
        {"brake_override": 0.6},
        {"command_stale_s": 5.0},
        {"emergency_brake": 0.2},
        {"invalid_commands_max": 0},
        {"person_required": 1.5},
        {"stop_decel": 2.5},
    ],
)
def test_profiles_out_of_bounds_are_refused(text: dict[str, float]) -> None:
    with pytest.raises(msgspec.ValidationError):
        msgspec.convert(text, ControlProfile)


def test_defaults_are_an_order_in_which_a_person_is_asked_before_the_car_stops() -> None:
    plain = ControlProfile()
    assert plain.command_stale_s < plain.escalation_s < plain.minimal_risk_after_s
    assert plain.stop_decel_mps2 <= plain.stop_decel_max_mps2
    assert plain.throttle_override_hysteresis < plain.throttle_override
    assert plain.steering_override_hysteresis_deg < plain.steering_override_deg
    assert plain.engage_lateral_accel_mps2 < plain.automatic_lateral_accel_mps2
    assert plain.manual_hand_wheel_rate_degps > 1100.0, "no limit of the person's wheel is felt in an emergency"
