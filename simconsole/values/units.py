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
    "m": "m", "mps": "m/s", "mps2": "m/s^2", "mps3": "m/s^3", "s": "s", "ns": "ns", "ticks": "ticks",
    "rad": "rad", "radps": "rad/s", "n": "N", "nm": "N m", "nms": "N m s", "nmprad": "N m/rad", "nmps": "N m/s",
    "npm": "N/m", "nspm": "N s/m", "kg": "kg", "kgm2": "kg m^2", "jpkg": "J/kg",
    "deg": "deg", "degps": "deg/s", "kmh": "km/h", "rpm": "1/min",
}  # fmt: skip
DISPLAYED: Final[dict[str, tuple[str, float]]] = {
    "engine_radps": ("engine_rpm", RPM_PER_RADPS),
    "radps": ("degps", DEG_PER_RAD),
    "rad": ("deg", DEG_PER_RAD),
    "mps": ("kmh", KMH_PER_MPS),
}
"""What people read in place of a suffix, and the factor; the longest suffix that fits a name counts."""


def unit_of(name: str) -> str:
    """Return the unit that the suffix of a name states; "1" for shares, raw axes, counts, flags and enumerations."""
    _, separator, suffix = name.rpartition("_")
    return _UNITS.get(suffix, "1") if separator else "1"


def displayed(name: str) -> tuple[str, float]:
    """Return what a value is called in the units of displays, and the factor from its own unit to that; 1 for none."""
    for suffix, (shown, factor) in DISPLAYED.items():
        if name.endswith((f"_{suffix}", f".{suffix}")):
            return name.removesuffix(suffix) + shown, factor
    return name, 1.0


def tick_time_ns(tick: int, tick_hz: int) -> int:
    """Return the simulated time of `tick` in ns, exact in integers: no drift over any length of drive."""
    return tick * NS_PER_S // tick_hz
