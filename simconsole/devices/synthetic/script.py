"""A script as a cockpit: straight lines between what the person does at stated times, turned into raw axes. Pure."""

import math
from bisect import bisect_right
from collections.abc import Callable
from typing import Final

from simconsole.devices.calibration.cockpit_settings import CockpitSettings
from simconsole.devices.calibration.inverse_calibration import Intent, pedal_raw, raw_sample, wheel_raw
from simconsole.profiles.parts.script import ScriptProfile
from simconsole.values.errors import ProfileError
from simconsole.values.input_table import InputTable
from simconsole.values.kernels import Row
from simconsole.values.signals import Button, DeviceSample
from simconsole.values.units import RAD_PER_DEG

PEDALS: Final = ("throttle", "brake", "clutch", "handbrake")
PRESS_S: Final = 0.2
"""How long a scripted finger holds a button."""


class _Channel:
    """One channel: straight from knot to knot, 0 before the first, held after the last."""

    def __init__(self, knots: list[tuple[float, float]], tick_hz: int, raw: Callable[[float], float]) -> None:
        self._knots = knots
        self._tick_hz = tick_hz
        self._raw = raw
        self._ticks = [first_tick(time_s, tick_hz) for time_s, _ in knots]

    def fill(self, tick: int, axis: Row) -> None:
        """Write the raw axis from `tick` on."""
        end, at = tick + len(axis), tick
        while at < end:
            passed = bisect_right(self._ticks, at)
            until = end if passed == len(self._ticks) else min(end, self._ticks[passed])
            axis[at - tick : until - tick] = self._between(passed, at, until)
            at = until

    def _between(self, passed: int, tick: int, until: int) -> float | list[float]:
        """Return the raw axis from `tick` to before `until`, of which none is beyond the next knot."""
        if passed == 0:
            return self._raw(0.0)
        start_s, start = self._knots[passed - 1]
        if passed == len(self._knots) or self._knots[passed][1] == start:
            return self._raw(start)
        end_s, end = self._knots[passed]
        hz, raw = self._tick_hz, self._raw
        return [raw(start + (end - start) * ((at / hz - start_s) / (end_s - start_s))) for at in range(tick, until)]


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
        _check(script, settings, name)
        self._settings = settings
        self._channels = [_Channel(_knots(script, channel), tick_hz, raw) for channel, raw in _axes(settings).items()]
        self._gears = [
            (first_tick(point.time_s, tick_hz), float(point.gear)) for point in script.points if point.gear is not None
        ]
        self._presses = [
            (first_tick(point.time_s, tick_hz), first_tick(point.time_s + PRESS_S, tick_hz), Button[press.upper()])
            for point in script.points
            for press in point.press
        ]
        edges = {tick for start, end, _ in self._presses for tick in (start, end)}
        self._changes = sorted(edges.union(tick for tick, _ in self._gears))
        self._table = InputTable(len(DeviceSample._fields), self._fill)
        self.foresee = self._table.foresee

    def poll(self, tick: int) -> DeviceSample:
        """Return the raw sample of this tick, age 0."""
        return DeviceSample(*self._table.values(tick))

    def _fill(self, tick: int, rows: Row) -> None:
        end, at = tick + len(rows), tick
        while at < end:  # between two changes of lever or buttons all is equal but the axes
            passed = bisect_right(self._changes, at)
            until = end if passed == len(self._changes) else min(end, self._changes[passed])
            rows[at - tick : until - tick] = self._held(at)
            at = until
        for axis, channel in enumerate(self._channels):
            channel.fill(tick, rows[:, axis])

    def _held(self, tick: int) -> DeviceSample:
        """Return the sample with lever and buttons as they are in `tick`."""
        gear, pressed = 0.0, 0
        for since, asked in self._gears:
            if since <= tick:
                gear = asked
        for start, end, button in self._presses:
            if start <= tick < end:
                pressed |= int(button)
        return raw_sample(Intent(gear=gear, pressed=pressed), self._settings)

    def close(self) -> None:
        """Nothing to release."""


def first_tick(time_s: float, tick_hz: int) -> int:
    """Return the first tick that is not before a time (>= 0)."""
    tick = max(0, math.floor(time_s * tick_hz) - 1)
    while tick / tick_hz < time_s:
        tick += 1
    return tick


def _axes(settings: CockpitSettings) -> dict[str, Callable[[float], float]]:
    """Return, by channel, what turns its values into those of its axis; in the order of `DeviceSample`."""
    wheel = {"hand_wheel_deg": lambda angle_deg: wheel_raw(angle_deg * RAD_PER_DEG, settings)}
    return wheel | {pedal: _pedal(pedal, settings) for pedal in PEDALS}


def _pedal(pedal: str, settings: CockpitSettings) -> Callable[[float], float]:
    numbers = (getattr(settings, f"{pedal}_{name}") for name in ("rest_raw", "full_raw", "dead", "curve"))
    rest_raw, full_raw, dead, curve = numbers
    return lambda pressed: pedal_raw(pressed, rest_raw, full_raw, dead, curve)


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
