"""`simconsole devices calibrate`: the wizard on real devices, or on virtual ones that do what each step asks for."""

import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack, closing
from pathlib import Path
from typing import Any, Final

import msgspec

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.calibration.hands_free import HeldStill, Readings
from simconsole.devices.calibration.input_detection import SteadyReadings, steady_readings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.devices.calibration.wizard import QUIT, SKIP, Entry, Wizard
from simconsole.devices.setup.device_commands import Pace, Say, answer, realtime
from simconsole.devices.sources.raw_joysticks import RawJoysticks
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.profiles.device import Buttons, CockpitProfile, DeviceKey
from simconsole.profiles.strict_yaml import to_yaml
from simconsole.values.errors import DeviceError
from simconsole.values.host.files import write_atomically
from simconsole.values.signals import Button
from simconsole.values.units import RAD_PER_DEG

LOOK_S: Final = 0.3
LOOK_HZ: Final = 200
TYPED: Final = ("degrees", "lever")
"""Steps that are answered by a line, not by holding something."""
AT_REST: Final = ("rest", "centre", "neutral")


def calibrate_devices(
    base: CockpitProfile,
    path: Path,
    *,
    say: Say,
    ask: Callable[[str], str] = input,
    virtual: CockpitProfile | None = None,
    pace: Callable[[int], Pace] = realtime,
    known: Sequence[CockpitProfile] = (),
    typed: Callable[[], str] | None = None,
) -> dict[str, Any]:
    """Learn a cockpit step by step and write its profile.

    Args:
        base: Gives the degrees that are offered, and the force feedback of a wheel that it knows.
        path: The profile to write; it must not be there yet.
        say: Prints a line.
        ask: Puts a question and returns the answer.
        virtual: A cockpit to attach as virtual devices, which do at each step what is asked for.
        pace: Makes a pace for a rate.
        known: Other profiles, one of which may know the wheel at hand.
        typed: Returns a key that was typed since the last call, or nothing. With it what a step asks for is taken
            when it is held still for a second: nobody has to reach for Enter with a foot down.

    Raises:
        DeviceError: there are no devices, nobody answers, or the file cannot be written.
        KeyboardInterrupt: the person gave up; what was learnt is kept beside `path` and the next call goes on from it.
    """
    if path.exists():
        raise DeviceError(f"{path}: file: value exists: a file that does not")
    with ExitStack() as stack:
        hands = None if virtual is None else stack.enter_context(closing(_Hands(virtual)))
        devices = stack.enter_context(RawJoysticks())
        entries = {
            key: Entry(found.name, found.axes, found.buttons, found.hats) for key, found in devices.entries.items()
        }
        for key, entry in entries.items():
            say(f"{key[0]:04x}:{key[1]:04x}  {entry.name}: {entry.axes} axes, {entry.buttons} buttons")
        how = "press Enter" if typed is None else "keep still for a second"
        say(f"Do what each line says, hold it, and {how}. q gives up for now.")
        progress = _Progress(path, list(entries))
        if progress.learnt:
            say(f"{progress.path}: goes on after {list(progress.learnt)[-1]}; delete it to begin anew")
        bench = _Bench(devices.read, hands, ask, say, typed, pace)
        profile = Wizard(
            base,
            entries,
            ask=bench.put,
            say=say,
            look=bench.look,
            known=known,
            learnt=progress.learnt,
            save=progress.save,
        ).run(f"simconsole devices calibrate, {time.strftime('%Y-%m-%d')}")
    write_profile(path, profile)
    progress.path.unlink(missing_ok=True)
    say(f"{path}: written. Try it: simconsole devices check --cockpit {path}")
    return {"profile": str(path), "title": profile.title, "roles": [role.name for role in profile.roles]}


class _Bench:
    """Puts the wizard's questions and reads the devices for it."""

    def __init__(
        self,
        read: Callable[[], Readings],
        hands: "_Hands | None",
        ask: Callable[[str], str],
        say: Say,
        typed: Callable[[], str] | None,
        pace: Callable[[int], Pace],
    ) -> None:
        self._read, self._hands, self._ask, self._say, self._typed, self._pace = read, hands, ask, say, typed, pace
        self._holds = HeldStill(LOOK_HZ)

    def put(self, step: str, text: str) -> str:
        """Return what was typed at a step, nothing for Enter or for what was held still.

        Of a virtual cockpit Enter skips what it has not: nobody need know it.
        """
        if self._hands is not None:
            self._hands.do(step)
        if self._typed is None or step in TYPED:
            said = answer(self._ask, f"{text} ")
            return SKIP if not said and self._hands is not None and not self._hands.has(step) else said
        self._say(text)
        return self._wait_for_hold(step, self._typed)

    def look(self) -> SteadyReadings:
        """Read for LOOK_S."""
        wait = self._pace(LOOK_HZ)
        readings = []
        for tick in range(1, round(LOOK_S * LOOK_HZ) + 1):
            wait(tick)
            readings.append(self._read())
        return steady_readings(readings)

    def _wait_for_hold(self, step: str, typed: Callable[[], str]) -> str:
        """Wait until what the step asks for is held still, or a key is typed: return that key, nothing for Enter."""
        wait = self._pace(LOOK_HZ)
        self._holds.begin()
        tick = 0
        while True:
            tick += 1
            wait(tick)
            key = typed().strip().lower()[:1]
            if key in (SKIP, QUIT):
                return key
            if self._holds.add(self._read(), at_rest=step in AT_REST):
                return ""


class _Progress:
    """The steps that are done, in a file beside the profile: of the same devices only."""

    def __init__(self, path: Path, devices: list[DeviceKey]) -> None:
        self.path = path.with_name(f"{path.name}.part")
        self._devices = [list(key) for key in devices]
        self.learnt: dict[str, Any] = {}
        try:
            saved = msgspec.json.decode(self.path.read_bytes(), type=dict[str, Any])
        except (OSError, msgspec.DecodeError):
            return
        if saved.get("devices") == self._devices:
            self.learnt = dict(saved.get("steps", {}))

    def save(self, learnt: dict[str, Any]) -> None:
        """Write all steps.

        Raises:
            DeviceError: the file cannot be written.
        """
        try:
            write_atomically(self.path, msgspec.json.encode({"devices": self._devices, "steps": learnt}), durable=False)
        except OSError as error:
            raise DeviceError(f"{self.path}: file: {error.strerror}: a file that can be written") from error


def write_profile(path: Path, profile: CockpitProfile) -> None:
    """Write a profile as YAML.

    Raises:
        DeviceError: the file is there already or cannot be written.
    """
    text = to_yaml(profile)
    try:
        with path.open("x", encoding="ascii") as file:
            file.write(text)
    except OSError as error:
        raise DeviceError(f"{path}: file: {error.strerror}: a new file that can be written") from error


class _Hands:
    """Virtual devices that do what each step asks for."""

    def __init__(self, cockpit: CockpitProfile) -> None:
        self._profile = cockpit
        self._cockpit = VirtualCockpit(cockpit)
        self._settings = cockpit_settings(cockpit, LOOK_HZ)
        self._lock_rad = 0.5 * cockpit.wheel.lock_to_lock_deg * RAD_PER_DEG
        self.close = self._cockpit.close

    def has(self, step: str) -> bool:
        """Return whether the cockpit has what a step asks for."""
        profile = self._profile
        if step in ("clutch", "handbrake"):
            return getattr(profile.pedals, step) is not None
        if step == "lever":
            return profile.shifter.pattern == "h"
        if step.startswith("gear "):
            gear = int(step.removeprefix("gear "))
            return profile.shifter.reverse is not None if gear < 0 else gear <= len(profile.shifter.gears)
        return step not in Buttons.__struct_fields__ or getattr(profile.buttons, step) is not None

    def do(self, step: str) -> None:
        self._cockpit.write(raw_sample(self._intent(step), self._settings))

    def _intent(self, step: str) -> Intent:
        if step in ("left", "right"):
            return Intent(hand_wheel_rad=self._lock_rad if step == "left" else -self._lock_rad)
        if step in ("throttle", "brake", "clutch", "handbrake"):
            return Intent(**{step: 1.0})  # type: ignore[arg-type]  # the names of its pedals
        if step.startswith("gear "):
            return Intent(gear=float(step.removeprefix("gear ")))
        if step.upper() in Button.__members__:
            return Intent(pressed=int(Button[step.upper()]))
        return Intent()
