"""Unit conversions: the only place where a factor between units stands.

Inside the console every value is SI and says so in its field name; profiles and displays convert here.
"""

from typing import Final

RAD_PER_DEG: Final = 0.017453292519943295
DEG_PER_RAD: Final = 57.29577951308232
MPS_PER_KMH: Final = 1.0 / 3.6
KMH_PER_MPS: Final = 3.6
RADPS_PER_RPM: Final = 0.10471975511965977
RPM_PER_RADPS: Final = 9.549296585513721
STANDARD_GRAVITY_MPS2: Final = 9.80665
NS_PER_S: Final = 1_000_000_000

_UNITS: Final = {
    "m": "m", "mps": "m/s", "mps2": "m/s^2", "s": "s", "ns": "ns", "ticks": "ticks",
    "rad": "rad", "radps": "rad/s", "n": "N", "nm": "N m", "nms": "N m s", "nmprad": "N m/rad",
    "npm": "N/m", "nspm": "N s/m", "kg": "kg", "kgm2": "kg m^2",
}  # fmt: skip


def unit_of(name: str) -> str:
    """Return the unit that the suffix of a name states; "1" for shares, raw axes, counts, flags and enumerations."""
    _, separator, suffix = name.rpartition("_")
    return _UNITS.get(suffix, "1") if separator else "1"


def tick_time_ns(tick: int, tick_hz: int) -> int:
    """Return the simulated time of `tick` in ns, exact in integers: no drift over any length of drive."""
    return tick * NS_PER_S // tick_hz
