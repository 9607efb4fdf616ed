"""Which way to the motor is taken."""

from typing import Any

import pytest

from simconsole.devices.force_feedback.motor import Capability, NoHaptics
from simconsole.devices.haptics import back_ends
from simconsole.profiles.force_feedback import ForceFeedback


class Able(NoHaptics):
    """A port that says that it has force."""

    @property
    def capability(self) -> Capability:
        return Capability(self._reason, constant=True)


@pytest.mark.parametrize(
    ("wanted", "sdl_able", "evdev_able", "expected"),
    [
        ("auto", True, True, "sdl"),
        ("auto", False, True, "evdev"),
        ("auto", False, False, "sdl"),
        ("sdl", False, True, "sdl"),
        ("evdev", True, False, "evdev"),
    ],
)
def test_sdl_is_first_and_evdev_second(
    wanted: Any, sdl_able: bool, evdev_able: bool, expected: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(back_ends, "open_haptics", lambda *_: (Able if sdl_able else NoHaptics)("sdl"))
    monkeypatch.setattr(back_ends, "open_evdev", lambda *_: (Able if evdev_able else NoHaptics)("evdev"))
    force = ForceFeedback(max_torque_nm=4.0, back_end=wanted)
    assert back_ends.open_motor(0, (1, 2), force).capability.name == expected
