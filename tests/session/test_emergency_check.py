"""The emergency stop of a console that is fed with a cockpit's samples."""

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.session.emergency_check import stops
from simconsole.values.signals import Button


def test_button_stops_the_console_and_nothing_else_does() -> None:
    cockpit = load("devices", "t500rs_th8rs", CockpitProfile)
    settings = cockpit_settings(cockpit, 250)
    rest = [raw_sample(Intent(), settings)] * 100
    pressed = [raw_sample(Intent(pressed=int(Button.EMERGENCY_STOP)), settings)] * 20
    assert stops(cockpit, rest + pressed + rest).ok
    verdict = stops(cockpit, rest)
    assert not verdict.ok
    assert verdict.how == "the console is in MANUAL"
