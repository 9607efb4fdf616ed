"""Guided trials of a cockpit for `simconsole devices accept`: what a person does, and what must be seen."""

import math
from collections.abc import Callable
from contextlib import ExitStack
from itertools import pairwise
from typing import Any, Final, NamedTuple

from simconsole.devices.calibration.calibrator import calibrate, wheel_angle
from simconsole.devices.calibration.cockpit_settings import NOBODY, cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.devices.setup.device_commands import Pace, Say
from simconsole.devices.sources.sdl_source import SdlSource
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.profiles.device import Buttons, CockpitProfile
from simconsole.values.signals import NEVER_TICKS, NO_SAMPLE, Button, DeviceSample, DriverInput
from simconsole.values.units import RAD_PER_DEG

HZ: Final = 250
PEDALS: Final = ("throttle", "brake", "clutch", "handbrake")
BINS_MS: Final = (2, 4, 8, 12, 16, 24, 32, 64)
"""Upper ends of the histogram of the time between two new readings."""
CENTRE_RAD: Final = 5.0 * RAD_PER_DEG
LOCK_SHARE: Final = 0.03
FULL: Final = 0.99
"""A pedal at its end: an axis has steps."""
LATE_MS: Final = 32

Hands = Callable[[float], Intent]
"""What virtual hands do, by the time in s since the trial began."""


class Seen(NamedTuple):
    """One tick of a trial."""

    sample: DeviceSample
    driver: DriverInput


class Verdict(NamedTuple):
    """What a trial showed."""

    ok: bool
    how: str
    figures: dict[str, Any]


class Trials:
    """An opened cockpit, tried step by step; a virtual one does by itself what each step asks for."""

    def __init__(
        self, cockpit: CockpitProfile, virtual: bool, pace: Callable[[int], Pace], say: Say, stack: ExitStack
    ) -> None:
        """Open the devices; `stack` closes them.

        Raises:
            DeviceError: a device is missing or cannot drive.
        """
        self.cockpit = cockpit
        self._settings = cockpit_settings(cockpit, HZ)
        self._pace, self._say = pace, say
        self._virtual = VirtualCockpit(cockpit) if virtual else None
        if self._virtual is not None:
            stack.callback(self._virtual.close)
        self._source = SdlSource(cockpit)
        stack.callback(self._source.close)
        self._tick = 0
        self._before, self._driver = NO_SAMPLE, NOBODY
        self._plugs: list[tuple[float, bool]] = []
        self.pedals = tuple(name for name in PEDALS if getattr(cockpit.pedals, name) is not None)

    def watch(self, text: str, seconds: float, hands: Hands) -> list[Seen]:
        """Say what to do, and return what is seen for so long."""
        self._say(f"{text} ({seconds:g} s)")
        wait, seen = self._pace(HZ), []
        for tick in range(1, round(seconds * HZ) + 1):
            wait(tick)
            self._tick += 1
            if self._virtual is not None:
                self._act(self._virtual, tick / HZ, hands)
            sample = self._source.poll(self._tick)
            self._driver = calibrate(sample, self._before, self._driver, 0.0, self._settings, 1.0 / HZ)
            self._before = sample
            seen.append(Seen(sample, self._driver))
        self._plugs = []
        return seen

    def _act(self, virtual: VirtualCockpit, time_s: float, hands: Hands) -> None:
        for at_s, plugged in self._plugs:
            if abs(time_s - at_s) < 0.5 / HZ:
                (virtual.plug if plugged else virtual.unplug)("wheel")
        virtual.write(raw_sample(hands(time_s), self._settings))

    def rest(self) -> Verdict:
        """Nothing is touched."""
        last = self.watch("Hands and feet off, lever in neutral, wheel straight.", 2.0, _nothing)[-1]
        driver = last.driver
        ok = (driver.throttle, driver.brake, driver.clutch, driver.gear) == (0.0, 0.0, 0.0, 0.0)
        ok = ok and abs(driver.hand_wheel_rad) < CENTRE_RAD and last.sample.wheel_age_ticks == 0.0
        return Verdict(ok, "all at rest" if ok else "not at rest", {"wheel_deg": _deg(driver.hand_wheel_rad)})

    def pedal(self, name: str) -> Verdict:
        """Press one pedal: it reaches both ends, no other moves."""
        seen = self.watch(
            f"Press the {name.upper()} fully, and let it go.", 5.0, lambda t: _pressed(name, 1.0 < t < 2.0)
        )
        most = {other: max(getattr(each.driver, other) for each in seen) for other in PEDALS}
        wrong = [other for other in PEDALS if other != name and most[other] > 0.0]
        ok = most[name] >= FULL and getattr(seen[-1].driver, name) == 0.0 and not wrong
        how = "both ends, alone" if ok else f"moved {', '.join(wrong)}, too" if wrong else "not both ends"
        return Verdict(ok, how, {"most": most[name]})

    def wheel(self) -> Verdict:
        """Turn the wheel to both locks: left first and positive, both where its axis ends."""
        lock_rad = max(wheel_angle(raw, self._settings) for raw in (-1.0, 1.0))
        seen = self.watch(
            "Turn the wheel to its LEFT lock, then to its RIGHT lock, then straight.",
            10.0,
            lambda t: Intent(hand_wheel_rad=lock_rad * math.sin(2.0 * math.pi * t / 10.0)),
        )
        angles = [each.driver.hand_wheel_rad for each in seen]
        high, low = max(angles), min(angles)
        first = angles.index(high) < angles.index(low)
        ok = first and max(abs(high - lock_rad), abs(low + lock_rad)) <= LOCK_SHARE * lock_rad
        how = "left first, both locks" if ok else "not as the profile says"
        return Verdict(ok, how, {"left_deg": _deg(high), "right_deg": _deg(low)})

    def gears(self) -> Verdict:
        """Go through every gear of an H pattern."""
        shifter = self.cockpit.shifter
        if shifter.pattern != "h":
            return Verdict(True, "no H pattern: its paddles are among the buttons", {})
        wanted = [*range(1, len(shifter.gears) + 1), *([] if shifter.reverse is None else [-1])]
        names = ", ".join("REVERSE" if gear < 0 else str(gear) for gear in wanted)
        each_s, count = 2.0, len(wanted)
        seen = self.watch(
            f"Lever into {names}, half a second each, then neutral.",
            each_s * (len(wanted) + 1),
            lambda t: Intent(gear=float(wanted[int(t / each_s)] if t % each_s > 0.5 and t < each_s * count else 0)),
        )
        found = {int(each.driver.gear) for each in seen}
        missing = [gear for gear in wanted if gear not in found]
        ok = not missing and seen[-1].driver.gear == 0.0
        return Verdict(ok, "every gear" if ok else f"missing: {missing}", {"gears": sorted(found)})

    def buttons(self) -> Verdict:
        """Press every button that the profile names."""
        wanted = [name for name in Buttons.__struct_fields__ if getattr(self.cockpit.buttons, name) is not None]
        names = ", ".join(self.cockpit.button_label(name) or name.replace("_", " ") for name in wanted)
        seen = self.watch(
            f"Press each once: {names}.",
            2.0 * len(wanted),
            lambda t: _button(wanted[int(t / 2.0) % len(wanted)] if 0.5 < t % 2.0 < 1.0 else None),
        )
        found = 0
        for each in seen:
            found |= int(each.driver.pressed)
        missing = [name for name in wanted if name.upper() in Button.__members__ and not found & Button[name.upper()]]
        return Verdict(not missing, "every button" if not missing else f"missing: {missing}", {"buttons": len(wanted)})

    def latency(self) -> Verdict:
        """Turn the wheel without a pause: how long it takes from one new reading to the next."""
        seen = self.watch(
            "Turn the wheel to and fro without a pause.", 5.0, lambda t: Intent(hand_wheel_rad=math.sin(3.0 * t))
        )
        axes = [each.sample.wheel_axis for each in seen]
        new = [tick for tick, (one, other) in enumerate(pairwise(axes)) if one != other]
        gaps_ms = [1000.0 * (late - early) / HZ for early, late in pairwise(new)]
        if not gaps_ms:
            return Verdict(False, "the wheel did not turn", {})
        bins = {f"<= {top} ms": sum(gap <= top for gap in gaps_ms) for top in BINS_MS}
        middle = sorted(gaps_ms)[len(gaps_ms) // 2]
        ok = sum(gap <= LATE_MS for gap in gaps_ms) >= 0.9 * len(gaps_ms)
        return Verdict(ok, f"a new reading every {middle:g} ms", {"readings": len(gaps_ms), "at_most": bins})

    def hot_plug(self) -> Verdict:
        """Pull the wheel's plug with the throttle pressed, and put it in again."""
        self._plugs = [(2.0, False)]
        seen = self.watch(
            "Press the THROTTLE and hold it; then pull the wheel's USB plug.",
            12.0,
            lambda t: Intent(throttle=1.0 if t > 0.5 else 0.0),
        )
        gone = next((tick for tick, each in enumerate(seen) if each.sample.wheel_age_ticks == NEVER_TICKS), None)
        self._plugs = [(1.0, True)]
        back = self.watch("Foot off, put the plug in again, wait for its middle.", 12.0, _nothing)[-1]
        if gone is None:
            return Verdict(False, "no unplugging was seen", {})
        half = max(each.driver.brake for each in seen)
        left = max(each.driver.throttle for each in seen[gone:])
        is_back = back.sample.wheel_age_ticks == 0.0
        ok = half == 0.0 and is_back and (left == 0.0 or not self._pedals_on_wheel())
        how = "gone at once, back by itself" if ok else "no brake may move, and the wheel must be back"
        return Verdict(ok, how, {"brake": half, "throttle_after": left, "back": is_back})

    def _pedals_on_wheel(self) -> bool:
        keys = {role.role: role.key for role in self.cockpit.roles}
        return keys["pedals"] == keys["wheel"]

    def emergency(self) -> list[DeviceSample]:
        """Press the emergency button; return what the cockpit sent, for a console to judge."""
        label = self.cockpit.button_label("emergency_stop") or "the emergency stop"
        seen = self.watch(f"Press {label}.", 4.0, lambda t: _button("emergency_stop" if 2.0 < t < 2.5 else None))
        return [each.sample for each in seen]


def _nothing(time_s: float) -> Intent:
    return Intent()


def _pressed(name: str, down: bool) -> Intent:
    return Intent(**{name: 1.0 if down else 0.0})  # type: ignore[arg-type]  # the names of its pedals


def _button(name: str | None) -> Intent:
    if name is None or name.upper() not in Button.__members__:
        return Intent()
    return Intent(pressed=int(Button[name.upper()]))


def _deg(rad: float) -> float:
    return round(rad / RAD_PER_DEG, 1)
