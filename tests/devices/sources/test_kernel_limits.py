"""Dead zones and ranges of the kernel: read from a mocked one, and said where they cannot be read."""

import json
from pathlib import Path

import pytest

from simconsole.devices.sources import event_nodes, kernel_limits
from simconsole.devices.sources.kernel_limits import (
    AxisLimits,
    KernelLimits,
    notes,
    problems,
    read_limits,
    steering_range_deg,
)
from simconsole.profiles.device import CockpitProfile
from tests.devices.mocked import start
from tests.patience import PATIENCE_S


def test_dead_zone_and_range_of_a_wheel_are_read_and_said(tmp_path: Path) -> None:
    done = start(tmp_path / "calls.jsonl", "limits")
    out, err = done.communicate(timeout=PATIENCE_S)
    assert done.returncode == 0, out + err
    found, wrong, said = json.loads(out)
    assert found["axes"] == [[0, 0, 65535, 255, 128], [1, 0, 1023, 0, 0], [2, 0, 1023, 0, 0], [3, 0, 1023, 0, 0]]
    assert found["range_deg"] == 900.0
    assert wrong == ["wheel.lock_to_lock_deg: value 1080: 900, what the wheel's driver is set to"]
    assert said == [
        "axis 0: the kernel smooths 0.39% and calls 0.20% its centre; without: "
        "evdev-joystick --evdev /dev/input/event5 --axis 0 --fuzz 0 --deadzone 0"
    ]


def test_what_may_not_be_read_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, t500: CockpitProfile) -> None:
    monkeypatch.setattr(event_nodes, "NODES", tmp_path)
    found = read_limits((0x044F, 0xB65E))
    assert problems(found, t500) == []
    assert notes(found) == [
        "the kernel's dead zone and the wheel's range could not be read: wheel: event device: value none: "
        "an event device 044f:b65e that may be read"
    ]


def test_range_is_found_above_the_event_device_and_not_further(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    event = tmp_path / "devices" / "usb" / "0003:044F:B65E.0001" / "input" / "input7" / "event5"
    event.mkdir(parents=True)
    (tmp_path / "class").mkdir()
    (tmp_path / "class" / "event5").symlink_to(event)
    monkeypatch.setattr(kernel_limits, "SYSFS", tmp_path / "class")
    (tmp_path / "devices" / "range").write_text("7")
    assert steering_range_deg("event5") is None
    (event.parents[2] / "range").write_text("1080\n")
    assert steering_range_deg("event5") == 1080.0
    (event.parents[2] / "range").write_text("wide")
    assert steering_range_deg("event5") is None
    assert steering_range_deg("event6") is None


def test_a_driver_that_agrees_is_no_problem_and_one_that_is_silent_a_note(t500: CockpitProfile) -> None:
    quiet = (AxisLimits(0, 0, 65535, 0, 0),)
    assert problems(KernelLimits(quiet, 1080.5), t500) == []
    assert notes(KernelLimits(quiet, 1080.0)) == []
    assert problems(KernelLimits(quiet, None), t500) == []
    assert notes(KernelLimits(quiet, None)) == [
        "the wheel's driver does not tell its range; compare the angle shown with the wheel"
    ]
