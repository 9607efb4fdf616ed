"""Where a drive comes from: who drove when, on what, with which code. It stands in the manifest from the start.

For people and for statistics: no replay needs it. Nothing of it is in the log, so that equal drives make equal logs.
"""

from datetime import UTC, datetime
from typing import Final

import msgspec

from simconsole.values.errors import RecordingError
from simconsole.values.labels import borne_label

NOTE_CHARS: Final = 500
ID_CHARS: Final = 64
NOTES_MAX: Final = 20


class Machine(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The computer. Its name is left out: it often is a person's."""

    platform: str
    """Operating system and architecture."""
    kernel: str
    """Version of the operating system's kernel."""
    cpu: str
    """What the processor calls itself."""
    cpus: int
    """How many processors the system has."""
    python: str
    """Version of Python."""


class Source(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The simconsole that drove."""

    version: str
    """Version of the simconsole that drove."""
    sha256: str
    """SHA-256 of every module's path and text."""
    commit: str | None = None
    """Commit of the git checkout that the modules lie in; `null` if they lie in none."""
    changed: bool | None = None
    """Whether the modules differ from that commit."""


class Device(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One device of the cockpit, as it was found when it was opened."""

    roles: tuple[str, ...]
    """What the device was in the cockpit."""
    name: str
    """What the device's firmware calls itself."""
    usb_id: str
    """USB vendor and product number, `VENDOR:PRODUCT`, hexadecimal."""
    port: str = ""
    """Where the device was plugged in; empty where the system does not tell."""
    serial: str = ""
    """Serial number of the device; empty where it has none."""


class TorqueShare(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How much of the car's torque the wheel bears without swinging, by its profile, at one speed."""

    speed_kmh: float
    """The speed for which the share holds."""
    share: float
    """Share of the car's torque that the wheel bears without swinging, 0 to 1."""


class Provenance(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """All of it. What nobody told is empty."""

    started_utc: str = ""
    """When the drive began, ISO 8601, by the machine's clock."""
    title: str = ""
    """Title of the session."""
    participant: str = ""
    """Who drove, as it was told with `--participant`."""
    trial: str = ""
    """Which trial it was, as it was told with `--trial`."""
    notes: tuple[str, ...] = ()
    """What whoever started the drive noted."""
    machine: Machine | None = None
    """The computer that drove."""
    source: Source | None = None
    """The simconsole that drove."""
    devices: tuple[Device, ...] = ()
    """Devices of the cockpit, as they were found when they were opened."""
    torque_shares: tuple[TorqueShare, ...] = ()
    """How much of the car's torque the wheel bears, by speed; none where the cockpit has no motor."""


UNKNOWN: Final = Provenance()


class Given(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What whoever starts a drive says of it."""

    participant: str = ""
    trial: str = ""
    notes: tuple[str, ...] = ()

    def checked(self) -> "Given":
        """Return it.

        Raises:
            RecordingError: a text is too long, or there are too many.
        """
        if len(self.notes) > NOTES_MAX:
            raise RecordingError(f"notes: value {len(self.notes)} of them: up to {NOTES_MAX}")
        ids = (("participant", self.participant, ID_CHARS), ("trial", self.trial, ID_CHARS))
        for name, text, most in (*ids, *(("note", note, NOTE_CHARS) for note in self.notes)):
            if len(text) > most:
                raise RecordingError(f"{name}: value of {len(text)} characters: up to {most}")
            if not ("".join(text.split()) if name == "note" else text).isprintable():
                raise RecordingError(f"{name}: value {text!r}: printable characters")
        return self


NOTHING_GIVEN: Final = Given()


def facts(provenance: Provenance) -> dict[str, str]:
    """Return what is known, one short text for each fact, for a page that people read."""
    machine, source = provenance.machine, provenance.source
    found = {"started": provenance.started_utc, "participant": provenance.participant, "trial": provenance.trial}
    found["notes"] = "; ".join(provenance.notes)
    found["devices"] = ", ".join(f"{device.name} ({device.usb_id})" for device in provenance.devices)
    found["force feedback"] = _torque_words(provenance.torque_shares)
    if machine is not None:
        found["machine"] = f"{machine.cpu}, {machine.cpus} CPUs, {machine.platform} {machine.kernel}, {machine.python}"
    if source is not None:
        changed = " with changes" if source.changed else ""
        commit = "" if source.commit is None else f", commit {source.commit[:12]}{changed}"
        found["simconsole"] = f"{source.version}{commit}, sources {source.sha256[:12]}"
    return {name: text for name, text in found.items() if text}


def _torque_words(shares: tuple[TorqueShare, ...]) -> str:
    """Return how much of the car's torque the wheel bears: all up to a speed, then less; nothing without a motor."""
    borne = [(at.speed_kmh, at.share) for at in shares]
    return f"of the car's torque: {borne_label(borne)}" if borne else ""


def utc_now() -> str:
    """Return what the machine's clock says, in UTC, ISO 8601, to the second."""
    return datetime.now(UTC).isoformat(timespec="seconds")
