"""What every source promises, and how they are found."""

import math
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from simconsole.devices.calibration.cockpit_settings import CockpitSettings, cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.devices.calibration.validity import axis_good, mask_good
from simconsole.devices.force_feedback.motor import MotorisedSource, SimulatedWheelPort, WheelMotor
from simconsole.devices.force_feedback.simulated_wheel import SimulatedWheel
from simconsole.devices.sources import sdl_runtime
from simconsole.devices.sources.sdl_source import SdlSource
from simconsole.devices.sources.source_registry import open_source
from simconsole.devices.sources.trace_files import TraceWriter
from simconsole.devices.synthetic.trace_format import TraceHeader
from simconsole.faults.cockpit_faults import FaultyDevices
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.faults import Stuck
from simconsole.profiles.files.loader import load
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.errors import DeviceNotFound, ProfileError
from simconsole.values.key_codes import Key
from simconsole.values.protocols import DeviceSource
from simconsole.values.validity import LIVE
from tests.devices.calibration_run import CalibrationRun
from tests.paths import ROOT

HZ = 250
SCRIPT = "points:\n- {time_s: 0, throttle: 0}\n- {time_s: 0.4, throttle: 0}\n- {time_s: 0.5, throttle: 0.8, gear: 1}\n"


class Opened:
    """A source that sits at rest for 0.4 s and then presses the throttle and shifts to first."""

    def __init__(self, source: DeviceSource, profile: CockpitProfile, before: Callable[[int], None]) -> None:
        self.source = source
        self.settings = cockpit_settings(profile, HZ)
        self.before = before


def _trace(path: Path, cockpit: CockpitSettings) -> str:
    with TraceWriter(path, TraceHeader(HZ, "t500rs_th8rs")) as writer:
        for tick in range(1, 301):
            pressed = Intent(throttle=0.8, gear=1) if tick > 100 else Intent()
            writer.write(tick, raw_sample(pressed, cockpit))
    return f"trace:{path}"


@pytest.fixture(params=["sdl", "trace", "script", "keyboard", "motorised", "faulty"])
def opened(
    request: pytest.FixtureRequest, tmp_path: Path, t500: CockpitProfile, t500_settings: CockpitSettings
) -> Opened:
    def nothing(tick: int) -> None:
        return

    if request.param == "sdl":
        plugged = request.getfixturevalue("plugged_once")

        def work(tick: int) -> None:
            pressed = Intent(throttle=0.8, gear=1) if tick > 100 else Intent()
            plugged.write(raw_sample(pressed, t500_settings))

        return Opened(open_source("sdl", t500, tick_hz=HZ), t500, work)
    if request.param == "trace":
        return Opened(open_source(_trace(tmp_path / "t.csv", t500_settings), t500, tick_hz=HZ), t500, nothing)
    if request.param in ("script", "motorised", "faulty"):
        path = tmp_path / "script.yaml"
        path.write_text(SCRIPT)
        source = open_source(f"script:{path}", t500, tick_hz=HZ)
        if request.param == "motorised":
            force = ForceFeedback(max_torque_nm=4.0)
            port = SimulatedWheelPort(SimulatedWheel(force, 1080.0, tick_hz=HZ))
            motor = WheelMotor(port, force, lambda snapshot: snapshot.t_s)
            source = MotorisedSource(source, motor, lambda: None)
        if request.param == "faulty":
            source = FaultyDevices(source, [(Stuck(axis="wheel", at_s=9.0), Never())], t500, t500_settings, HZ)
        return Opened(source, t500, nothing)
    keyboard = load("devices", "keyboard", CockpitProfile)
    held = [Key(0)]

    def press(tick: int) -> None:
        held[0] = Key.THROTTLE | Key.GEAR_UP if tick > 100 else Key(0)

    return Opened(open_source("keyboard", keyboard, tick_hz=HZ, keys=lambda: (int(held[0]), 0)), keyboard, press)


@pytest.fixture
def plugged_once(sdl: None, t500: CockpitProfile) -> object:
    from simconsole.devices.sources.virtual_cockpit import VirtualCockpit

    cockpit = VirtualCockpit(t500)
    yield cockpit
    cockpit.close()


class Never:
    """The switch of a fault that never comes."""

    ticks = 0


class TestEverySource:
    """The contract."""

    def test_the_first_sample_is_there_and_commands_nothing(self, opened: Opened) -> None:
        opened.before(1)
        sample = opened.source.poll(1)
        assert all(math.isfinite(value) for value in sample)
        driver = CalibrationRun(opened.settings).calibrate(sample)
        assert (driver.throttle, driver.brake, driver.gear, driver.pressed, driver.edges) == (0.0,) * 5
        opened.source.close()

    def test_hat_and_motor_are_flags(self, opened: Opened) -> None:
        for tick in range(1, 20):
            opened.before(tick)
            sample = opened.source.poll(tick)
            assert {sample.hat_x, sample.hat_y} <= {-1.0, 0.0, 1.0}
            assert sample.wheel_motor in (0.0, 1.0)
        opened.source.close()

    def test_samples_are_raw_fresh_and_drive_the_person(self, opened: Opened) -> None:
        calibration = CalibrationRun(opened.settings)
        for tick in range(1, 250):
            opened.before(tick)
            sample = opened.source.poll(tick)
            assert all(axis_good(raw) for raw in sample[:5])
            assert all(mask_good(mask) for mask in sample[5:7])
            assert sample[9:12] == (0.0, 0.0, 0.0)
            driver = calibration.calibrate(sample)
            if tick <= 100:
                assert (driver.throttle, driver.gear) == (0.0, 0.0)
        assert driver.throttle > 0.7
        assert driver.gear == 1.0
        assert {driver.throttle_validity, driver.wheel_validity, driver.shifter_validity} == {LIVE}
        opened.source.close()

    def test_closing_twice_takes_nothing_from_others(self, opened: Opened) -> None:
        """SDL is shared within the process: the second call must not let go of it for somebody else."""
        before = sdl_runtime._Runtime.users
        opened.source.close()
        opened.source.close()
        assert sdl_runtime._Runtime.users == before - isinstance(opened.source, SdlSource)


@pytest.mark.parametrize("driver", ["", "wheel", "sdl:x", "trace:", "script:", "keyboard:a", "TRACE:x"])
def test_unknown_driver_is_refused(driver: str, t500: CockpitProfile) -> None:
    with pytest.raises(ProfileError, match="sdl, trace:FILE, script:FILE or keyboard"):
        open_source(driver, t500, tick_hz=HZ)


def test_keyboard_needs_its_keys(t500: CockpitProfile) -> None:
    with pytest.raises(ProfileError, match="a drive with a window"):
        open_source("keyboard", t500, tick_hz=HZ)


def test_keys_steer_no_cockpit_without_assistance(t500: CockpitProfile) -> None:
    with pytest.raises(ProfileError, match=r"wheel\.assistance"):
        open_source("keyboard", t500, tick_hz=HZ, keys=lambda: (0, 0))


def test_real_devices_that_are_not_there_are_named(sdl: None, t500: CockpitProfile) -> None:
    with pytest.raises(DeviceNotFound, match="044f:b65e"):
        open_source("sdl", t500, tick_hz=HZ)


def test_a_script_loads_no_pygame(tmp_path: Path) -> None:
    path = tmp_path / "script.yaml"
    path.write_text(SCRIPT)
    program = (
        "import sys\n"
        "from simconsole.devices.sources.source_registry import open_source\n"
        "from simconsole.profiles.files.loader import load\n"
        "from simconsole.profiles.device import CockpitProfile\n"
        f"open_source('script:{path}', load('devices', 't500rs_th8rs', CockpitProfile), tick_hz=250).poll(1)\n"
        "print(sorted({'pygame', 'numba'} & set(sys.modules)))\n"
    )
    root = ROOT
    done = subprocess.run([sys.executable, "-c", program], cwd=root, capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
