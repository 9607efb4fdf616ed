"""`simconsole devices calibrate`: the wizard on real devices, or on virtual ones that do what each step asks for."""

import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Final

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.calibration.input_detection import SteadyReadings, steady_readings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.devices.calibration.wizard import Entry, Wizard
from simconsole.devices.setup.device_commands import Pace, Say, answer, realtime
from simconsole.devices.sources.raw_joysticks import RawJoysticks
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.strict_yaml import to_yaml
from simconsole.values.errors import DeviceError
from simconsole.values.signals import Button
from simconsole.values.units import RAD_PER_DEG

LOOK_S: Final = 0.3
LOOK_HZ: Final = 200


def calibrate_devices(
    base: CockpitProfile,
    path: Path,
    *,
    say: Say,
    ask: Callable[[str], str] = input,
    virtual: CockpitProfile | None = None,
    pace: Callable[[int], Pace] = realtime,
) -> dict[str, Any]:
    """Learn a cockpit step by step and write its profile.

    Args:
        base: Gives the degrees that are offered, and the force feedback of a wheel that it knows.
        path: The profile to write; it must not be there yet.
        say: Prints a line.
        ask: Puts a question and returns the answer.
        virtual: A cockpit to attach as virtual devices, which do at each step what is asked for.
        pace: Makes a pace for a rate.

    Raises:
        DeviceError: there are no devices, a step did not succeed, or the file cannot be written.
        KeyboardInterrupt: the person gave up; nothing is written.
    """
    if path.exists():
        raise DeviceError(f"{path}: file: value exists: a file that does not")
    with ExitStack() as stack:
        hands: _Hands | None = None
        if virtual is not None:
            hands = _Hands(virtual)
            stack.callback(hands.close)
        devices = stack.enter_context(RawJoysticks())
        entries = {
            key: Entry(found.name, found.axes, found.buttons, found.hats) for key, found in devices.entries.items()
        }
        for key, entry in entries.items():
            say(f"{key[0]:04x}:{key[1]:04x}  {entry.name}: {entry.axes} axes, {entry.buttons} buttons")
        say("Do what each line says, hold it, and press Enter. q gives up.")

        def put(step: str, text: str) -> str:
            if hands is not None:
                hands.do(step)
            return answer(ask, f"{text} ")

        def look() -> SteadyReadings:
            wait = pace(LOOK_HZ)
            readings = []
            for tick in range(1, round(LOOK_S * LOOK_HZ) + 1):
                wait(tick)
                readings.append(devices.read())
            return steady_readings(readings)

        profile = Wizard(base, entries, ask=put, say=say, look=look).run(
            f"simconsole devices calibrate, {time.strftime('%Y-%m-%d')}"
        )
    write_profile(path, profile)
    say(f"{path}: written. Try it: simconsole devices check --cockpit {path}")
    return {"profile": str(path), "title": profile.title, "roles": [role.name for role in profile.roles]}


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
        self._cockpit = VirtualCockpit(cockpit)
        self._settings = cockpit_settings(cockpit, LOOK_HZ)
        self._lock_rad = 0.5 * cockpit.wheel.lock_to_lock_deg * RAD_PER_DEG
        self.close = self._cockpit.close

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
