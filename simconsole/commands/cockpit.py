"""`simconsole devices list | check | record`: the cockpit before a drive."""

from argparse import Namespace
from pathlib import Path

from simconsole.commands.outcome import Outcome
from simconsole.devices.commands import check_devices, list_devices, record_devices
from simconsole.profile_files import load
from simconsole.profiles.device import CockpitProfile


def devices(words: Namespace) -> Outcome:
    """Do one of the three; `check` has code 1 when the cockpit could not drive.

    Raises:
        DeviceError: a device is missing or in a mode that cannot drive.
        ProfileError: the cockpit's profile cannot be used.
    """
    cockpit = load("devices", words.cockpit, CockpitProfile)
    if words.action == "list":
        results = list_devices(cockpit, say=print, virtual=words.virtual)
        return Outcome(1 if results["missing_roles"] else 0, results)
    if words.action == "check":
        results = check_devices(cockpit, say=print, duration_s=words.duration_s, virtual=words.virtual)
        return Outcome(0 if results["ok"] else 1, results)
    results = record_devices(
        cockpit, Path(words.out), say=print, duration_s=words.duration_s, name=words.cockpit, virtual=words.virtual
    )
    return Outcome(0, results)
