"""Force feedback: bounds that are refused by key, and defaults that no hand is hurt by."""

import pytest

from simconsole.profiles.force_feedback import ForceFeedback
from tests.profiles.refused import refusal


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("{}", "max_torque_nm: value missing: "),
        ("max_torque_nm: 31", "max_torque_nm: value 31: "),
        ("{max_torque_nm: 4, level_pushes: up}", 'level_pushes: value "up": one of left, right'),
        ("{max_torque_nm: 4, motor: {inertia_kgm2: 0}}", "motor.inertia_kgm2: value 0: "),
        ("{max_torque_nm: 4, guidance: {most_nm: 11}}", "guidance.most_nm: value 11: "),
        ("{max_torque_nm: 4, ramp_s: 0}", "ramp_s: value 0: "),
        ("{max_torque_nm: 4, soft_clip_from: 1}", "soft_clip_from: value 1: "),
        ("{max_torque_nm: 4, gain_percent: 101}", "gain_percent: value 101: "),
        ("{max_torque_nm: 4, autocentre_after_percent: 100}", "autocentre_after_percent: value 100: "),
        ("{max_torque_nm: .inf}", "max_torque_nm"),
    ],
)
def test_what_cannot_be_meant_is_refused(text: str, told: str) -> None:
    assert told in refusal(text, ForceFeedback)


def test_resting_hands_are_more_than_hands_that_are_only_felt() -> None:
    plain = ForceFeedback(max_torque_nm=4.0)
    assert plain.hands_on_nm < plain.resting_hands_nm < plain.guidance.most_nm <= plain.max_torque_nm
    assert plain.friction_nm < plain.standstill_friction_nm
