"""The unit that the name of a key states, spelled as docs/units.md does."""

from typing import Final

from simconsole.values.units import unit_of

WRITTEN: Final = {
    **{"m2": "m^2", "m3": "m^3", "1pm": "1/m", "1ps": "1/s", "ms": "ms", "hz": "Hz", "percent": "%", "px": "pixels"},
    **{"ah": "A h", "v": "V", "w": "W", "kj": "kJ", "bps": "bit/s", "bytes": "bytes", "radps2pm": "rad s^2/m"},
}
"""Units of profiles beside those of `values/units.py`, by the suffix of a name."""
MEASURES: Final = {"1000rpm": "1000/min", "100nm": "100 N m", "root_m": "root of m"}
"""What stands after `_per_` and is no unit by itself."""


def key_unit(name: str) -> str:
    """Return the unit that the suffix of a key's name states; empty for shares, counts, texts and the like."""
    head, per, below = name.partition("_per_")
    if not per:
        return _one(name)
    above, under = _one(head) or "1", MEASURES.get(below) or _one(f"_{below}")
    if not under:  # per something without a unit
        return ""
    return f"{above} per {under}" if " " in f"{above}{under}" else f"{above}/{under}"


def _one(name: str) -> str:
    _, separator, suffix = name.rpartition("_")
    unit = WRITTEN.get(suffix) or unit_of(name)
    return unit if separator and unit != "1" else ""
