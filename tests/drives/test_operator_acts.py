"""Each act of an operator from the wheel, from ROS and from the command line alike."""

import pytest

from simconsole.bridge.console.command_decoder import REQUESTS
from simconsole.cli.main import parser
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.values.signals import Button

BUTTONS = {
    "autonomous": Button.AUTONOMOUS,
    "manual": Button.MANUAL,
    "shared": Button.SHARED,
    "takeover": Button.TAKEOVER,
    "estop": Button.EMERGENCY_STOP,
    "reset": Button.RESET,
    "mark": Button.MARK,
    "pause": Button.PAUSE,
    "start": Button.PAUSE,
    "restart": Button.RESTART,
    "fault": Button.FAULT,
}
AIDS = {"anti_lock", "traction", "stability"}
"""Switched by an operator alone."""


@pytest.mark.parametrize("name", ["t500rs_th8rs", "t300rs_th8a", "g29", "gamepad", "keyboard"])
def test_every_cockpit_binds_every_act(name: str) -> None:
    buttons = load("devices", name, CockpitProfile).buttons
    unbound = [act for act, button in BUTTONS.items() if getattr(buttons, str(button.name).lower()) is None]
    assert unbound == []


def test_ros_and_the_command_line_know_the_same_acts() -> None:
    assert set(REQUESTS) == {*BUTTONS, *AIDS}
    for act in REQUESTS:
        assert parser().parse_args(["operate", act]).act == act
