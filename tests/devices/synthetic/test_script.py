"""Scripts: straight lines, steps and presses, through the cockpit and back."""

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from simconsole.devices.calibration.cockpit_settings import CockpitSettings
from simconsole.devices.synthetic.script import ScriptSource
from simconsole.profiles.parts.script import ScriptPoint, ScriptProfile
from simconsole.values.errors import ProfileError
from simconsole.values.signals import Button, DriverInput
from tests.devices.calibration_run import CalibrationRun

HZ = 250


def driven(settings: CockpitSettings, seconds: float, *points: dict[str, Any]) -> list[DriverInput]:
    script = ScriptProfile(points=[ScriptPoint(**point) for point in points])
    source = ScriptSource(script, settings, tick_hz=HZ)
    calibration = CalibrationRun(settings)
    return [calibration.calibrate(source.poll(tick)) for tick in range(1, round(seconds * HZ) + 1)]


def at(drivers: list[DriverInput], time_s: float) -> DriverInput:
    return drivers[round(time_s * HZ) - 1]


def test_lines_run_from_mention_to_mention(t500_settings: CockpitSettings) -> None:
    drivers = driven(
        t500_settings,
        4.0,
        {"time_s": 0.0, "throttle": 0.0, "hand_wheel_deg": 0.0},
        {"time_s": 1.0, "throttle": 0.0},
        {"time_s": 2.0, "brake": 0.0},
        {"time_s": 3.0, "throttle": 0.8, "hand_wheel_deg": 90.0, "brake": 0.5},
    )
    assert at(drivers, 1.0).throttle == 0.0
    assert at(drivers, 2.0).throttle == pytest.approx(0.4)
    assert at(drivers, 3.0).throttle == pytest.approx(0.8)
    assert at(drivers, 3.9).throttle == pytest.approx(0.8)
    assert at(drivers, 2.5).brake == pytest.approx(0.25)
    assert at(drivers, 1.5).brake == 0.0
    assert at(drivers, 1.5).hand_wheel_rad == pytest.approx(math.radians(45.0))


def test_gears_step_and_buttons_are_pressed_once(t500_settings: CockpitSettings) -> None:
    drivers = driven(
        t500_settings,
        3.0,
        {"time_s": 0.5, "gear": 1},
        {"time_s": 1.0, "gear": 2, "press": ["autonomous", "mark"]},
        {"time_s": 2.0, "gear": -1},
    )
    assert [at(drivers, time_s).gear for time_s in (0.4, 0.6, 1.1, 2.1)] == [0.0, 1.0, 2.0, -1.0]
    edges = [driver.edges for driver in drivers if driver.edges]
    assert edges == [float(Button.AUTONOMOUS | Button.MARK)]
    held = [driver for driver in drivers if driver.pressed]
    assert len(held) == round(0.2 * HZ)


def test_script_for_another_cockpit_is_refused(
    t500_settings: CockpitSettings, keyboard_settings: CockpitSettings
) -> None:
    gear = ScriptProfile(points=[ScriptPoint(time_s=0.0, gear=2)])
    with pytest.raises(ProfileError, match=r"mine: points\[0\].gear: value 2: a cockpit with an H pattern"):
        ScriptSource(gear, keyboard_settings, tick_hz=HZ, name="mine")
    six = t500_settings._replace(gear_7_mask=0.0)
    seventh = ScriptProfile(points=[ScriptPoint(time_s=0.0), ScriptPoint(time_s=1.0, gear=7)])
    with pytest.raises(ProfileError, match=r"points\[1\].gear: value 7"):
        ScriptSource(seventh, six, tick_hz=HZ)
    reset = ScriptProfile(points=[ScriptPoint(time_s=0.0, press=["reset"])])
    with pytest.raises(ProfileError, match=r"points\[0\].press: value reset"):
        ScriptSource(reset, t500_settings._replace(reset_mask=0.0), tick_hz=HZ)


SHARES = st.one_of(st.floats(0.0, 1.0), st.sampled_from([0.0, 1.0]))


@given(st.lists(st.tuples(st.floats(0.001, 1.0), SHARES), min_size=1, max_size=8))
def test_no_line_leaves_the_travel_of_its_pedal(
    t500_settings: CockpitSettings, knots: list[tuple[float, float]]
) -> None:
    """No pedal of a scripted cockpit is clamped: between two shares of its travel lie only such."""
    points, time_s = [], 0.0
    for gap_s, share in knots:
        time_s += gap_s
        points.append(ScriptPoint(time_s=time_s, throttle=share))
    source = ScriptSource(ScriptProfile(points=points), t500_settings, tick_hz=HZ)
    ends = sorted((t500_settings.throttle_rest_raw, t500_settings.throttle_full_raw))
    for tick in range(1, round(time_s * HZ) + 2):
        assert ends[0] <= source.poll(tick).throttle_axis <= ends[1]
