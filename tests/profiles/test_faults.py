"""Faults of a drive: one onset each, and words for people."""

import msgspec
import pytest

from simconsole.profiles.faults import MAX_FAULTS, Fault, Faults, Silent, Stuck, Swapped, Unplug, fault_label
from simconsole.profiles.session import Scenario
from tests.profiles.refused import refusal


def told(fault: str) -> str:
    return refusal(f"faults: [{fault}]", Scenario)


def test_a_fault_begins_once() -> None:
    assert "faults[0]" in told("{kind: unplug, device: wheel}")
    assert "no trigger given, must be exactly one of at_s, at_distance_m, near, above_mps, " in told(
        "{kind: unplug, device: wheel, for_s: 3}"
    )
    assert "at_s and on_mode given, must be exactly one" in told(
        "{kind: unplug, device: wheel, at_s: 0, on_mode: shared}"
    )


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        ("{kind: swapped, at_s: 1, axis: brake, other: brake}", "other brake must be another axis than axis brake"),
        ("{kind: noise, at_s: 1, axis: brake, amplitude_raw: 0}", "amplitude_raw: value 0: "),
        ("{kind: noise, at_s: 1, axis: brake, amplitude_raw: 1, seed: -1}", "seed: value -1: "),
        ("{kind: stuck, at_s: 1, axis: horn}", 'axis: value "horn": one of '),
        ("{kind: unplug, at_s: 1, device: wheel, for_s: 0}", "for_s: value 0: "),
        ("{kind: unplug, near: {x_m: 0, y_m: 0, radius_m: 0}, device: wheel}", "radius_m: value 0: "),
        ("{kind: late, at_s: 1, device: wheel, by_ms: 5001}", "by_ms: value 5001: "),
        ("{kind: explode, at_s: 1}", "explode"),
    ],
)
def test_what_cannot_be_meant_is_refused(fault: str, words: str) -> None:
    assert words in told(fault)


def test_no_more_faults_than_a_float_has_bits_for() -> None:
    assert float(2**MAX_FAULTS - 1) == 2**MAX_FAULTS - 1
    one = {"kind": "unplug", "device": "wheel", "at_s": 1.0}
    assert len(msgspec.convert([one] * MAX_FAULTS, Faults)) == MAX_FAULTS
    with pytest.raises(msgspec.ValidationError, match=str(MAX_FAULTS)):
        msgspec.convert([one] * (MAX_FAULTS + 1), Faults)


@pytest.mark.parametrize(
    ("fault", "label"),
    [
        (Stuck(at_s=1.0, axis="throttle", raw=-1.0), "stuck axis throttle raw -1.0"),
        (Stuck(at_s=1.0, axis="throttle"), "stuck axis throttle"),
        (Unplug(on_mode="shared", delay_s=2.0, for_s=1.0, device="wheel"), "unplug device wheel"),
        (Swapped(at_s=0.0, axis="brake", other="clutch"), "swapped axis brake other clutch"),
        (Silent(at_s=0.0), "silent controller ros"),
    ],
)
def test_a_label_names_what_it_does_and_not_when(fault: Fault, label: str) -> None:
    assert fault_label(fault) == label


def test_a_part_is_read_by_its_earlier_name() -> None:
    earlier = msgspec.convert({"kind": "raises", "at_s": 1.0, "part": "stations"}, Fault)
    assert fault_label(earlier) == "raises part outputs"
