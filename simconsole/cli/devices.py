"""`simconsole devices list | check | calibrate | feel | identify | accept | record | speakers`: before a drive."""

import sys
from argparse import Namespace
from pathlib import Path
from typing import TYPE_CHECKING

from simconsole.cli.outcome import Outcome
from simconsole.devices.setup.device_commands import check_devices, list_devices, realtime, record_devices, unpaced
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load, names

if TYPE_CHECKING:
    from simconsole.devices.setup.identify_dialogue import Weight
    from simconsole.devices.setup.key_watch import KeyWatch


def devices(options: Namespace) -> Outcome:
    """Do one of them; `check` and `feel` have code 1 when the cockpit could not drive as it is.

    Raises:
        DeviceError: a device is missing or in a mode that cannot drive, or a step of a calibration failed.
        ProfileError: the cockpit's profile cannot be used.
    """
    if options.action == "speakers":
        return _speakers(options.device)
    cockpit = load("devices", options.cockpit, CockpitProfile)
    if options.action == "list":
        results = list_devices(cockpit, say=print, virtual=options.virtual)
        return Outcome(1 if results["missing_roles"] else 0, results)
    if options.action == "check":
        show = _Redrawn().show if sys.stderr.isatty() else None
        results = check_devices(cockpit, say=print, duration_s=options.duration_s, virtual=options.virtual, show=show)
        return Outcome(0 if results["ok"] else 1, results)
    if options.action == "calibrate":
        from simconsole.devices.setup.calibration_dialogue import calibrate_devices
        from simconsole.devices.setup.key_watch import KeyWatch

        path = Path(options.out or "cockpit.yaml")
        with KeyWatch() as keys:
            results = calibrate_devices(
                cockpit,
                path,
                say=_say,
                ask=keys.ask,
                virtual=cockpit if options.virtual else None,
                known=[load("devices", name, CockpitProfile) for name in names("devices")],
                typed=keys.typed if keys.is_terminal else None,
            )
        return Outcome(0, results)
    if options.action == "feel":
        from simconsole.devices.setup.force_feedback_check import check_force_feedback
        from simconsole.devices.setup.key_watch import KeyWatch

        with KeyWatch() as keys:
            results = check_force_feedback(
                cockpit,
                say=_say,
                ask=keys.ask,
                pressed=keys.pressed,
                strength=(options.strength or 25) / 100.0,
                virtual=options.virtual,
            )
        return Outcome(0 if results["ok"] else 1, results)
    if options.action in ("identify", "accept"):
        return _identified(options, cockpit)
    results = record_devices(
        cockpit,
        Path(options.out or "trace.csv"),
        say=print,
        duration_s=options.duration_s,
        name=options.cockpit,
        virtual=options.virtual,
    )
    return Outcome(0, results)


def _speakers(device: str | None) -> Outcome:
    """Name the sound devices and play a tone on each loudspeaker of one."""
    import time

    from simconsole.hud.audio.speaker_test import play_tones
    from simconsole.hud.audio.speakers import Speakers, device_names
    from simconsole.profiles.view import SoundProfile

    found = device_names()
    _say("devices: " + (", ".join(found) or "none by name"))
    speakers = Speakers(SoundProfile(device=device))
    try:
        _say(f"{speakers.channels} loudspeakers" + ("" if speakers.channels > 2 else ": four are folded into two"))
        results = play_tones(speakers, _say, time.sleep)
    finally:
        speakers.close()
    return Outcome(0, {"devices": found, "columns": speakers.channels, **results})


def _identified(options: Namespace, cockpit: CockpitProfile) -> Outcome:
    """Find what the motor is like, alone or as a part of accepting the whole cockpit."""
    from simconsole.devices.setup.identify_dialogue import Weight, identify_motor
    from simconsole.devices.setup.key_watch import KeyWatch

    weight = None if options.weight is None else Weight(options.weight, options.radius)
    with KeyWatch() as keys:
        if options.action == "accept":
            return _accepted(options, cockpit, keys, weight)
        results = identify_motor(
            cockpit,
            Path(options.out) if options.out else None,
            say=_say,
            ask=keys.ask,
            pressed=keys.pressed,
            strength=(options.strength or 40) / 100.0,
            weight=weight,
            virtual=options.virtual,
        )
    return Outcome(1 if results["refusal"] else 0, results)


def _accepted(options: Namespace, cockpit: CockpitProfile, keys: "KeyWatch", weight: "Weight | None") -> Outcome:
    """Guide a person through a new cockpit."""
    from simconsole.devices.setup.accept_dialogue import Terminal, accept_cockpit
    from simconsole.session.emergency_check import stops
    from simconsole.session.provenance import host_facts

    results = accept_cockpit(
        cockpit,
        Path(options.out or "acceptance"),
        Terminal(keys.ask, keys.pressed, keys.typed if keys.is_terminal else None),
        say=_say,
        stops=stops,
        host=host_facts(),
        known=[load("devices", name, CockpitProfile) for name in names("devices")],
        weight=weight,
        virtual=options.virtual,
        pace=unpaced if options.virtual else realtime,
    )
    return Outcome(0 if results["ok"] else 1, results)


def _say(line: str) -> None:
    print(line, flush=True)


class _Redrawn:
    """Lines that are drawn over themselves on a terminal."""

    def __init__(self) -> None:
        self._above = 0

    def show(self, lines: list[str]) -> None:
        """Draw them over the last ones."""
        up = f"\x1b[{self._above}A" if self._above else ""
        sys.stderr.write(up + "".join(f"\x1b[2K{line}\n" for line in lines))
        sys.stderr.flush()
        self._above = len(lines)
