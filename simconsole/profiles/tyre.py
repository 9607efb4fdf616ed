"""PAC2002 tyre property files (`.tir`): sections of `KEY = value $comment`, read into the coefficients of one tyre."""

import math
from typing import Final

import msgspec

from simconsole.values.errors import ProfileError

NEEDED: Final = (
    *("FNOMIN", "UNLOADED_RADIUS", "PCX1", "PDX1", "PKX1", "PCY1", "PDY1", "PKY1", "PKY2"),
    *("QBZ1", "QCZ1", "QDZ1"),
)
"""Without these there is no curve; any other coefficient may be absent."""

COMBINED: Final = ("RBX1", "RCX1", "RBY1", "RCY1")
"""Of combined slip: all of them, or none, and both slips share a friction ellipse."""

ZERO: Final = (
    *("PDX2", "PDX3", "PEX1", "PEX2", "PEX3", "PEX4", "PKX2", "PKX3", "PHX1", "PHX2", "PVX1", "PVX2"),
    *("PDY2", "PDY3", "PEY1", "PEY2", "PEY3", "PEY4", "PKY3", "PHY1", "PHY2", "PHY3", "PVY1", "PVY2", "PVY3", "PVY4"),
    *("QBZ2", "QBZ3", "QBZ4", "QBZ5", "QBZ9", "QBZ10", "QDZ2", "QDZ3", "QDZ4", "QDZ6", "QDZ7", "QDZ8", "QDZ9"),
    *("QEZ1", "QEZ2", "QEZ3", "QEZ4", "QEZ5", "QHZ1", "QHZ2", "QHZ3", "QHZ4", "SSZ1", "SSZ2", "SSZ3", "SSZ4"),
    *COMBINED,
    *("RBX2", "REX1", "REX2", "RHX1", "RBY2", "RBY3", "REY1", "REY2", "RHY1", "RHY2"),
    *("RVY1", "RVY2", "RVY3", "RVY4", "RVY5", "RVY6"),
)
"""Coefficients that are 0 where the file does not give them."""

ONE: Final = (
    *("LFZO", "LCX", "LMUX", "LEX", "LKX", "LHX", "LVX", "LCY", "LMUY", "LEY", "LKY", "LHY", "LVY", "LGAX", "LGAY"),
    *("LGAZ", "LTR", "LRES", "LXAL", "LYKA", "LVYKA", "LS", "TYRESIDE"),
)
"""Scale factors: 1 where the file does not give them. So is the side on which it was measured: 1 left, -1 right."""

POSITIVE: Final = ("FNOMIN", "UNLOADED_RADIUS", "PCX1", "PDX1", "PKX1", "PCY1", "PDY1", "LFZO", "LCX", "LMUX", "LKX")
POSITIVE_Y: Final = ("LCY", "LMUY", "LKY")
_UNITS: Final = {
    "LENGTH": ("meter", "m"),
    "FORCE": ("newton", "n"),
    "ANGLE": ("radians", "radian", "rad"),
    "MASS": ("kg", "kilogram"),
    "TIME": ("second", "sec", "s"),
}
_SIDES: Final = {"left": 1.0, "right": -1.0, "unknown": 1.0}


class TirTyre(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A tyre from a PAC2002 file beside the vehicle's profile; reading the vehicle fills in the coefficients."""

    tir: str
    """Name of the PAC2002 file (`.tir`) beside the vehicle's profile."""
    coefficients: dict[str, float] = {}
    """Coefficients of the tyre by their names in PAC2002; filled in when the file is read."""

    def __post_init__(self) -> None:
        """Refuse coefficients that make no tyre.

        Raises:
            ValueError: names the key.
        """
        if self.coefficients:
            check(self.coefficients)


def check(values: dict[str, float]) -> None:
    """Refuse coefficients that are unknown, missing, not finite, or would be divided by as 0.

    Raises:
        ValueError: names the key.
    """
    for key in values:
        if key not in NEEDED + ZERO + ONE:
            raise ValueError(f"{key}: value {values[key]}: a coefficient of PAC2002")
    for key in NEEDED:
        if key not in values:
            raise ValueError(f"{key}: value missing: a finite number")
    for key, value in values.items():
        if not math.isfinite(value) or abs(value) > 1e6:
            raise ValueError(f"{key}: value {value}: a finite number of at most 1e6")
        if key in POSITIVE + POSITIVE_Y and value <= 0.0:
            raise ValueError(f"{key}: value {value}: above 0")
    if values.get("TYRESIDE", 1.0) not in (1.0, -1.0):
        raise ValueError(f"TYRESIDE: value {values['TYRESIDE']}: 1 (left) or -1 (right)")
    given = [key for key in COMBINED if values.get(key, 0.0) != 0.0]
    if given and len(given) < len(COMBINED):
        raise ValueError(f"{given[0]}: value {values[given[0]]}: with {', '.join(COMBINED)} all given, or none of them")
    if values["PKY1"] >= 0.0:
        raise ValueError(f"PKY1: value {values['PKY1']}: below 0, as in the ISO frame of PAC2002")
    if values["PKY2"] <= 0.0:
        raise ValueError(f"PKY2: value {values['PKY2']}: above 0")


def parse_tir(text: str, origin: str) -> dict[str, float]:
    """Return the coefficients that a PAC2002 file gives; keys that the model does not use are left out.

    Raises:
        ProfileError: no PAC2002 file, other units than SI and radians, or a bad coefficient. Names `origin` and key.
    """
    entries = _entries(text, origin)
    model = entries.get(("MODEL", "PROPERTY_FILE_FORMAT"), "missing")
    if _word(model) != "pac2002":
        raise ProfileError(f"{origin}: PROPERTY_FILE_FORMAT: value {model}: 'PAC2002'")
    for key, allowed in _UNITS.items():
        unit = entries.get(("UNITS", key), "missing")
        if _word(unit) not in allowed:
            raise ProfileError(f"{origin}: {key}: value {unit}: '{allowed[0]}'")
    side = entries.get(("MODEL", "TYRESIDE"), "left")
    if _word(side) not in _SIDES:
        raise ProfileError(f"{origin}: TYRESIDE: value {side}: 'LEFT' or 'RIGHT'")
    values = {"TYRESIDE": _SIDES[_word(side)]}
    for (_, key), shown in entries.items():
        if key in NEEDED + ZERO + ONE and key != "TYRESIDE":
            if key in values:
                raise ProfileError(f"{origin}: {key}: value {shown}: given once")
            values[key] = _number(shown, key, origin)
    try:
        check(values)
    except ValueError as error:
        raise ProfileError(f"{origin}: {error}") from error
    return values


def _entries(text: str, origin: str) -> dict[tuple[str, str], str]:
    entries: dict[tuple[str, str], str] = {}
    section = ""
    for number, line in enumerate(text.splitlines(), 1):
        content = line.partition("$")[0].strip()
        if not content or content.startswith("!"):
            continue
        if content.startswith("["):
            section = content.strip("[] \t").upper()
            continue
        if "=" not in content:
            if section.endswith("SHAPE") or content.startswith("{"):  # a table: the rim's contour, used by no formula
                continue
            raise ProfileError(f"{origin}: line {number}: value {content[:40]!a}: KEY = value")
        key, _, value = content.partition("=")
        at = (section, key.strip().upper())
        if at in entries:
            raise ProfileError(f"{origin}: {at[1]}: value {value.strip()[:40]}: given once in [{section}]")
        entries[at] = value.strip()[:80]
    return entries


def _word(value: str) -> str:
    return value.strip("'\" \t").lower()


def _number(shown: str, key: str, origin: str) -> float:
    try:
        return float(shown)
    except ValueError as error:
        raise ProfileError(f"{origin}: {key}: value {shown!a}: a finite number") from error
