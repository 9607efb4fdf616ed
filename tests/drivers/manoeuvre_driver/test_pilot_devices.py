"""The test driver's cockpit: what the pilot does arrives through the axes as a person's would."""

import math

import numpy as np
import pytest

from simconsole.devices.calibration.calibrator import calibrate
from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.drivers.manoeuvre_driver.pilot_devices import PilotDevices
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.values.signals import NO_SAMPLE, DriverInput
from simconsole.values.state_vector import PLATFORM_AT, Snapshot

HZ = 250
SETTINGS = cockpit_settings(load("devices", "t500rs_th8rs", CockpitProfile), HZ)
NOTHING = DriverInput(*(0.0,) * len(DriverInput._fields))
SEEN = Snapshot(1, HZ, np.zeros(PLATFORM_AT))


def test_the_console_reads_what_the_pilot_meant_and_then_that_they_are_gone() -> None:
    plan: list[Intent | None] = [Intent()] * HZ + [Intent(hand_wheel_rad=0.7, throttle=0.4, gear=2.0)] * HZ + [None]
    seat = PilotDevices(lambda snapshot: plan.pop(0), SETTINGS)
    driver, before = NOTHING, NO_SAMPLE
    for tick in range(1, 2 * HZ + 1):
        seat.act(SEEN)
        sample = seat.poll(tick)
        driver, before = calibrate(sample, before, driver, 0.0, SETTINGS, 1.0 / HZ), sample
    assert (driver.hand_wheel_rad, driver.throttle) == (pytest.approx(0.7), pytest.approx(0.4))
    assert (driver.brake, driver.clutch, driver.gear) == (0.0, 0.0, 2.0)
    assert math.isclose(driver.hand_wheel_radps, 0.0, abs_tol=1e-6)
    assert not seat.finished
    seat.act(SEEN)
    assert seat.finished
    assert seat.poll(2 * HZ + 1) == before, "hands and feet stay where they were"
    assert before.wheel_age_ticks == before.pedals_age_ticks == 0.0
