"""Short ways to drive `calibrate` in tests."""

from collections.abc import Iterable

from simconsole.devices.calibration.calibrator import calibrate
from simconsole.devices.calibration.cockpit_settings import NOBODY, CockpitSettings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.values.signals import NO_SAMPLE, DeviceSample, DriverInput

TICK_S = 0.004


class CalibrationRun:
    """Feeds samples through `calibrate` and remembers what it must."""

    def __init__(self, settings: CockpitSettings) -> None:
        self.settings = settings
        self.before = NO_SAMPLE
        self.driver = NOBODY
        self.model_rad = 0.0

    def calibrate(self, sample: DeviceSample, ticks: int = 1) -> DriverInput:
        for _ in range(ticks):
            self.driver = calibrate(sample, self.before, self.driver, self.model_rad, self.settings, TICK_S)
            self.before = sample
        return self.driver

    def do(self, intent: Intent = Intent(), ticks: int = 1, **raw: float) -> DriverInput:  # noqa: B008  # immutable
        return self.calibrate(self.raw(intent, **raw), ticks)

    def raw(self, intent: Intent = Intent(), **raw: float) -> DeviceSample:  # noqa: B008  # immutable
        return raw_sample(intent, self.settings)._replace(**raw)

    def all(self, samples: Iterable[DeviceSample]) -> list[DriverInput]:
        return [self.calibrate(sample) for sample in samples]
