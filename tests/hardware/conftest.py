"""The real cockpit and a person at it, for tests that are run with `--hardware COCKPIT`."""

import time
from collections.abc import Callable, Iterator

import pytest

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.sources.sdl_source import SdlSource
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.values.signals import DeviceSample, DriverInput
from tests.devices.calibration_run import CalibrationRun

HZ = 250


class Bench:
    """The devices, read 250 times a second, raw and calibrated."""

    def __init__(self, cockpit: CockpitProfile, source: SdlSource) -> None:
        self.cockpit = cockpit
        self.source = source
        self.calibration = CalibrationRun(cockpit_settings(cockpit, HZ))
        self.tick = 0

    def watch(self, duration_s: float) -> list[tuple[DeviceSample, DriverInput]]:
        """Return what was read in so many seconds."""
        seen, start_s = [], time.monotonic()
        for number in range(round(duration_s * HZ)):
            time.sleep(max(0.0, start_s + number / HZ - time.monotonic()))
            self.tick += 1
            sample = self.source.poll(self.tick)
            seen.append((sample, self.calibration.calibrate(sample)))
        return seen


@pytest.fixture(scope="session")
def cockpit(request: pytest.FixtureRequest) -> CockpitProfile:
    return load("devices", request.config.getoption("--hardware"), CockpitProfile)


@pytest.fixture
def bench(cockpit: CockpitProfile) -> Iterator[Bench]:
    source = SdlSource(cockpit)
    yield Bench(cockpit, source)
    source.close()


@pytest.fixture
def ask(capfd: pytest.CaptureFixture[str]) -> Callable[[str], str]:
    """Put a question on the terminal."""

    def question(text: str) -> str:
        with capfd.disabled():
            return input(f"\n  {text} ").strip().lower()

    return question
