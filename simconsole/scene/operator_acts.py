"""The operator's acts as lines of the log. Pure."""

import msgspec

from simconsole.scene.timeline import Entry
from simconsole.values.units import NS_PER_S


class _Act(msgspec.Struct):
    tick: int
    act: str
    note: str = ""
    participant: str = ""
    trial: str = ""


def act_entry(content: bytes, tick_hz: int) -> Entry:
    """Return the line of an act, which is JSON as the drive's log keeps it; what is none is told, not refused."""
    try:
        act = msgspec.json.decode(content, type=_Act)
    except msgspec.DecodeError:
        return Entry(0, "WARN", "an operator's act cannot be read")
    parts = [f"operator: {act.act}"]
    parts += [f"{name} {value}" for name, value in (("participant", act.participant), ("trial", act.trial)) if value]
    parts += [act.note] if act.note else []
    return Entry(act.tick * NS_PER_S // tick_hz, "INFO", ", ".join(parts))
