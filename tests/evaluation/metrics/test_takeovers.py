"""Take-over measures on made-up drives of 20 s at 50 Hz, in which every moment and every peak is known."""

from typing import Any

import numpy as np
import pytest

from simconsole.evaluation.metrics.table import Array, Drive, drive_of
from simconsole.evaluation.metrics.takeovers import takeovers
from simconsole.evaluation.metrics.track import track
from simconsole.values.signals import Mode, Reason
from simconsole.values.state_vector import columns
from tests.evaluation.conftest import Nothing

HZ = 50


def made_up(changes: dict[float, Mode], **values: dict[float, float]) -> Drive:
    """Return a drive whose columns change at these times in s."""
    names = columns(Nothing)
    rows = np.zeros((20 * HZ, len(names)))
    values["arbitration__mode"] = {at: float(mode) for at, mode in changes.items()}
    for name, steps in values.items():
        for at, value in steps.items():
            rows[round(at * HZ) :, names.index(name.replace("__", "."))] = value
    return drive_of(rows, names, HZ)


def found_in(drive: Drive, lateral_m: Array | None = None) -> list[dict[str, Any]]:
    """Return the take-overs of a drive that was so far beside its course, or had none."""
    way = track(drive, None)
    return takeovers(drive, way if lateral_m is None else way._replace(lateral_m=lateral_m))


ASKED = {0.0: Mode.MANUAL, 1.0: Mode.AUTONOMOUS, 5.0: Mode.TAKEOVER_REQUESTED, 8.0: Mode.MANUAL}


def test_a_take_over_on_request_is_timed_from_the_request() -> None:
    drive = made_up(
        ASKED,
        arbitration__reason={8.0: float(Reason.STEERING_OVERRIDE)},
        driver__hand_wheel_rad={0.0: 0.5, 6.5: 0.53, 7.0: 0.54},
        arbitration__person_brake={7.5: 0.06},
        arbitration__remote_lateral={1.0: 1.0, 8.0: 0.5, 8.6: 0.0},
    )
    (found,) = found_in(drive)
    assert (found["tick"], found["request_tick"], found["asked"]) == (401, 251, True)
    assert found["reason"] == "driver turned the wheel"
    assert (found["first_steer_s"], found["first_brake_s"], found["first_throttle_s"]) == (2.0, 2.5, None)
    assert (found["authority_s"], found["sole_authority_s"]) == (3.0, pytest.approx(3.6))
    assert found["peak_deviation_m"] is None


def test_motion_that_the_motor_explains_is_no_reaction() -> None:
    moved = {6.0: 0.4, 7.0: 0.44}
    drive = made_up(ASKED, driver__hand_wheel_rad=moved, motor__explained_rad={6.0: 0.4})
    assert found_in(drive)[0]["first_steer_s"] == 2.0


def test_one_that_nobody_asked_for_is_timed_from_the_authority() -> None:
    drive = made_up(
        {0.0: Mode.MANUAL, 1.0: Mode.AUTONOMOUS, 8.0: Mode.MANUAL},
        driver__hand_wheel_rad={2.0: 1.0, 7.9: 1.1},
        arbitration__person_throttle={7.5: 0.2},
    )
    (found,) = found_in(drive)
    assert (found["asked"], found["request_tick"], found["authority_s"]) == (False, None, 0.0)
    assert found["first_steer_s"] == pytest.approx(-0.1)
    assert found["first_throttle_s"] == -0.5


def test_peaks_are_those_of_ten_seconds_under_the_persons_control() -> None:
    drive = made_up(
        ASKED,
        vehicle__ay_mps2={5.0: 9.0, 6.0: 0.0, 9.0: -2.0, 19.0: 30.0},
        vehicle__ax_mps2={10.0: 1.0},
        driver__hand_wheel_radps={9.0: -3.0, 9.2: 0.0, 19.0: 50.0},
        driver__hand_wheel_rad={8.0: 1.0, 13.0: 3.0},
    )
    lateral = np.full(20 * HZ, 0.2)
    lateral[9 * HZ :] = -0.5
    lateral[18 * HZ :] = 99.0
    (found,) = found_in(drive, lateral)
    assert found["peak_deviation_m"] == pytest.approx(0.7)
    assert found["peak_lateral_accel_mps2"] == 2.0
    assert found["peak_lateral_jerk_mps3"] == pytest.approx(20.0)
    assert found["peak_longitudinal_jerk_mps3"] == pytest.approx(10.0)
    assert found["peak_hand_wheel_radps"] == 3.0
    assert found["hand_wheel_deviation_rad"] == pytest.approx(1.0)


def test_only_what_ends_with_the_person_counts_and_each_has_its_own_span() -> None:
    drive = made_up(
        {
            0.0: Mode.AUTONOMOUS,
            2.0: Mode.MANUAL,
            3.0: Mode.AUTONOMOUS,
            4.0: Mode.EMERGENCY_STOP,
            5.0: Mode.PARKED,
            6.0: Mode.MANUAL,
            7.0: Mode.AUTONOMOUS,
            8.0: Mode.MINIMAL_RISK,
            9.0: Mode.MANUAL,
        },
        driver__hand_wheel_radps={2.5: 1.0, 3.0: 9.0, 9.0: 2.0},
    )
    first, second = found_in(drive)
    assert (first["tick"], first["asked"], first["peak_hand_wheel_radps"]) == (101, False, 1.0)
    assert (second["tick"], second["request_tick"], second["authority_s"]) == (451, 401, 1.0)
    assert second["peak_hand_wheel_radps"] == 2.0


def test_a_drive_without_any_has_none(known: Any) -> None:
    assert found_in(made_up({0.0: Mode.MANUAL})) == []
    assert len(found_in(drive_of(*known))) == 1
