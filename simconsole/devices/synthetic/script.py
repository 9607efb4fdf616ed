"""A script as a cockpit: straight lines between what the person does at stated times, turned into raw axes. Pure."""

from typing import Final

from simconsole.devices.calibration.cockpit_settings import CockpitSettings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.profiles.device import ScriptProfile
from simconsole.values.errors import ProfileError
from simconsole.values.signals import Button, DeviceSample
from simconsole.values.units import RAD_PER_DEG

PRESS_S: Final = 0.2
"""How long a scripted finger holds a button."""
CHANNELS: Final = ("throttle", "brake", "clutch", "handbrake", "hand_wheel_deg")


class _Channel:
    """One channel: straight from knot to knot, 0 before the first, held after the last. Time only goes forward."""

    def __init__(self, knots: list[tuple[float, float]]) -> None:
        self._knots = knots
        self._at = 0

    def value(self, time_s: float) -> float:
        knots = self._knots
        while self._at < len(knots) and knots[self._at][0] <= time_s:
            self._at += 1
        if self._at == 0:
            return knots[0][1] if knots and knots[0][0] == 0.0 else 0.0
        start_s, start = knots[self._at - 1]
        if self._at == len(knots):
            return start
        end_s, end = knots[self._at]
        return start + (end - start) * ((time_s - start_s) / (end_s - start_s))


class ScriptSource:
    """Plays a `ScriptProfile`; the first tick after the start is at 1 / tick_hz."""

    def __init__(self, script: ScriptProfile, settings: CockpitSettings, *, tick_hz: int, name: str = "script") -> None:
        """Prepare the channels.

        Args:
            script: What the person does.
            settings: The cockpit's, as `calibrate` gets them.
            tick_hz: The session's tick rate.
            name: What errors call the script.

        Raises:
            ProfileError: the script asks for a gear or a button that this cockpit has not.
        """
        self._settings = settings
        self._tick_hz = tick_hz
        self._lines = {channel: _Channel(_knots(script, channel)) for channel in CHANNELS}
        self._gears = [(point.time_s, float(point.gear)) for point in script.points if point.gear is not None]
        self._presses = [
            (point.time_s, point.time_s + PRESS_S, int(Button[press.upper()]))
            for point in script.points
            for press in point.press
        ]
        _check(script, settings, name)

    def poll(self, tick: int) -> DeviceSample:
        """Return the raw sample of this tick, age 0."""
        time_s = tick / self._tick_hz
        value = {channel: line.value(time_s) for channel, line in self._lines.items()}
        while len(self._gears) > 1 and self._gears[1][0] <= time_s:
            del self._gears[0]
        gear = self._gears[0][1] if self._gears and self._gears[0][0] <= time_s else 0.0
        pressed = 0
        for start_s, end_s, button in self._presses:
            if start_s <= time_s < end_s:
                pressed |= button
        return raw_sample(
            Intent(
                hand_wheel_rad=value["hand_wheel_deg"] * RAD_PER_DEG,
                throttle=value["throttle"],
                brake=value["brake"],
                clutch=value["clutch"],
                handbrake=value["handbrake"],
                gear=gear,
                pressed=pressed,
            ),
            self._settings,
        )

    def close(self) -> None:
        """Nothing to release."""


def _knots(script: ScriptProfile, channel: str) -> list[tuple[float, float]]:
    return [(point.time_s, getattr(point, channel)) for point in script.points if getattr(point, channel) is not None]


def _check(script: ScriptProfile, settings: CockpitSettings, name: str) -> None:
    for index, point in enumerate(script.points):
        if point.gear and settings.sequential:
            raise ProfileError(f"{name}: points[{index}].gear: value {point.gear}: a cockpit with an H pattern")
        if point.gear and not _gear_mask(settings, point.gear):
            raise ProfileError(f"{name}: points[{index}].gear: value {point.gear}: a gear that the shifter has")
        for press in point.press:
            if not getattr(settings, f"{press}_mask"):
                raise ProfileError(f"{name}: points[{index}].press: value {press}: a button that the cockpit has")


def _gear_mask(settings: CockpitSettings, gear: int) -> float:
    mask: float = settings.gear_reverse_mask if gear < 0 else getattr(settings, f"gear_{gear}_mask")
    return mask
