"""Which motors may turn the wheel by themselves."""

from typing import Any

import msgspec
import pytest

from simconsole.devices.force_feedback.servo_range import servo_refusal
from simconsole.profiles.device import CockpitProfile


@pytest.mark.parametrize(
    ("changed", "key"),
    [
        ({"identified": "no"}, "identified"),
        ({"inertia_kgm2": 0.4}, "inertia_kgm2"),
        ({"inertia_kgm2": 0.006}, "inertia_kgm2"),
        ({"friction_nm": 1.5}, "friction_nm"),
        ({"delay_s": 0.05}, "delay_s"),
    ],
)
def test_unknown_or_far_off_figures_are_refused(changed: dict[str, Any], key: str, t500: CockpitProfile) -> None:
    force = t500.force_feedback
    assert force is not None
    good = msgspec.structs.replace(force.motor, identified="ratios")
    assert servo_refusal(msgspec.structs.replace(force, motor=good)) is None
    bad = msgspec.structs.replace(good, **changed)
    refusal = servo_refusal(msgspec.structs.replace(force, motor=bad))
    assert refusal is not None
    assert refusal.startswith(f"force_feedback.motor.{key}: value ")
