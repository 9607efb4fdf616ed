"""Check of a cockpit while a person tries it: ranges of its axes, buttons that were pressed, problems. Pure."""

from typing import Any, Final

from simconsole.devices.calibration.calibrator import calibrate, travel
from simconsole.devices.calibration.cockpit_settings import NOBODY, CockpitSettings, button_bits, cockpit_settings
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.parts.axes import PedalAxis
from simconsole.values.signals import NO_SAMPLE, Button, DeviceSample, DriverInput
from simconsole.values.units import DEG_PER_RAD
from simconsole.values.validity import LOST, STALE, is_trusted

PEDALS: Final = ("throttle", "brake", "clutch", "handbrake")
MOVED: Final = 0.9
"""A pedal that was pressed further than this has been tried over its travel."""

STRAIGHT_DEG: Final = 30.0
"""A car that starts with its wheel turned further than this drives off to the side."""


class CockpitCheck:
    """Collects what the samples of some seconds show."""

    def __init__(self, profile: CockpitProfile, tick_hz: int) -> None:
        self._profile = profile
        self._settings: CockpitSettings = cockpit_settings(profile, tick_hz)
        self._tick_s = 1.0 / tick_hz
        self._before = NO_SAMPLE
        self.driver: DriverInput = NOBODY
        self._least = dict.fromkeys(PEDALS, 1.0)
        self._most = dict.fromkeys(PEDALS, 0.0)
        self._wheel_deg = [0.0, 0.0]
        self._gears: set[int] = set()
        self._buttons: set[str] = set()
        self._raw_buttons = {"wheel": 0, "shifter": 0}

    def add(self, sample: DeviceSample) -> DriverInput:
        """Take one sample; return it calibrated."""
        self.driver = calibrate(sample, self._before, self.driver, 0.0, self._settings, self._tick_s)
        self._before = sample
        for name, pedal in self._pedals():
            raw = getattr(sample, f"{name}_axis")
            share = max(0.0, travel(raw, pedal.rest_raw, pedal.full_raw))  # below: the other one of combined pedals
            self._least[name] = min(self._least[name], share)
            self._most[name] = max(self._most[name], share)
        angle_deg = self.driver.hand_wheel_rad * DEG_PER_RAD
        self._wheel_deg = [min(self._wheel_deg[0], angle_deg), max(self._wheel_deg[1], angle_deg)]
        self._gears.add(int(self.driver.gear))
        self._buttons |= {button.name.lower() for button in Button if int(self.driver.pressed) & button and button.name}
        self._raw_buttons["wheel"] |= int(sample.wheel_buttons)
        self._raw_buttons["shifter"] |= int(sample.shifter_buttons)
        return self.driver

    def problems(self) -> list[str]:
        """Return what would keep this cockpit from driving, one line each."""
        driver, found = self.driver, []
        for name, _ in self._pedals():
            validity = getattr(driver, f"{name}_validity")
            if validity in (STALE, LOST):
                found.append(f"pedals.{name}: value no reading: a device that answers")
            elif not is_trusted(validity):
                found.append(
                    f"pedals.{name}: value {self._least[name]:.0%} pressed at least: at most "
                    f"{self._profile.limits.arming:.0%} at rest; foot off, or rest_raw and full_raw are swapped"
                )
        if not is_trusted(driver.wheel_validity):
            found.append("wheel: value no reading: a wheel that answers")
        if not is_trusted(driver.shifter_validity):
            found.append("shifter: value no neutral seen: the lever in neutral")
        return found

    def notes(self) -> list[str]:
        """Return what was not tried, one line each."""
        found = [
            f"{name} was not pressed all the way ({self._most[name]:.0%})"
            for name, _ in self._pedals()
            if self._most[name] < MOVED
        ]
        if self._wheel_deg[1] - self._wheel_deg[0] < 10.0:
            found.append("the wheel was not turned")
        angle_deg = self.driver.hand_wheel_rad * DEG_PER_RAD
        if abs(angle_deg) > STRAIGHT_DEG:
            found.append(f"the wheel stands at {angle_deg:.0f} deg: centre_raw is wrong, or it was not let go")
        missing = set(range(1, len(self._profile.shifter.gears) + 1)) - self._gears
        if missing:
            found.append(f"gears not tried: {', '.join(map(str, sorted(missing)))}")
        return found

    def results(self) -> dict[str, Any]:
        """Return everything as plain values."""
        return {
            "ok": not self.problems(),
            "problems": self.problems(),
            "notes": self.notes(),
            "pedals": {name: {"least": self._least[name], "most": self._most[name]} for name, _ in self._pedals()},
            "wheel_deg": {"least": self._wheel_deg[0], "most": self._wheel_deg[1]},
            "gears": sorted(self._gears),
            "buttons": sorted(self._buttons),
            "raw_buttons": {
                role: sorted(number for number, bit in button_bits(self._profile, role).items() if mask >> bit & 1)
                for role, mask in self._raw_buttons.items()
            },
        }

    def _pedals(self) -> list[tuple[str, PedalAxis]]:
        pedals = ((name, getattr(self._profile.pedals, name)) for name in PEDALS)
        return [(name, pedal) for name, pedal in pedals if pedal is not None]
