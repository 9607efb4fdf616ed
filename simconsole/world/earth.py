"""From places in `map` to latitude and longitude: transverse Mercator maps, UTM among them, to below a millimetre.

Karney: Transverse Mercator with an accuracy of a few nanometers, Journal of Geodesy 85 (2011), 475-485: Krueger's
series in the third flattening, equations 12 (A), 35 (alpha) and 36 (beta), here to its fourth power, and latitude from
conformal latitude by Newton's method, equations 19 to 21.
"""

import math
from typing import Final, NamedTuple

ORIGIN_DEG: Final = (48.2, 16.37)
"""Latitude and longitude of the origin of `map` in a world that does not say where on the earth it is."""

_ELLIPSOIDS: Final = {"WGS84": (6378137.0, 298.257223563), "GRS80": (6378137.0, 298.257222101)}
_UTM_SCALE: Final = 0.9996
_UTM_EAST_M: Final = 500_000.0
_UTM_SOUTH_M: Final = 10_000_000.0
_NEWTON_STEPS: Final = 4
_NUMBERS: Final = ("zone", "lat_0", "lon_0", "k", "k_0", "x_0", "y_0")
_IDLE: Final = {"type", "no_defs", "units", "datum", "ellps", "south", "wktext"}
"""Words that change nothing here, or that are looked at where they stand."""


class GeoPlace(NamedTuple):
    """A place on the ellipsoid."""

    latitude_deg: float
    longitude_deg: float


class Earth:
    """Where `map` lies: x to the east of the projection's grid, y to its north."""

    def __init__(
        self, ellipsoid: str, origin_deg: tuple[float, float], scale: float, false_m: tuple[float, float]
    ) -> None:
        """Take a transverse Mercator projection.

        Args:
            ellipsoid: WGS84 or GRS80.
            origin_deg: latitude and longitude of its natural origin.
            scale: on the central meridian.
            false_m: what that origin has as x and y in `map`.
        """
        axis_m, inverse = _ELLIPSOIDS[ellipsoid]
        f = 1.0 / inverse
        n = f / (2.0 - f)
        self._e2 = f * (2.0 - f)
        self._unit_m = scale * axis_m / (1.0 + n) * (1.0 + n**2 / 4.0 + n**4 / 64.0)
        self._beta = (
            n / 2.0 - 2.0 * n**2 / 3.0 + 37.0 * n**3 / 96.0 - n**4 / 360.0,
            n**2 / 48.0 + n**3 / 15.0 - 437.0 * n**4 / 1440.0,
            17.0 * n**3 / 480.0 - 37.0 * n**4 / 840.0,
            4397.0 * n**4 / 161280.0,
        )
        alpha = (
            n / 2.0 - 2.0 * n**2 / 3.0 + 5.0 * n**3 / 16.0 + 41.0 * n**4 / 180.0,
            13.0 * n**2 / 48.0 - 3.0 * n**3 / 5.0 + 557.0 * n**4 / 1440.0,
            61.0 * n**3 / 240.0 - 103.0 * n**4 / 140.0,
            49561.0 * n**4 / 161280.0,
        )
        self._false_m = false_m
        self._meridian_deg = origin_deg[1]
        conformal = math.atan(self._conformal(math.tan(math.radians(origin_deg[0]))))
        self._start = conformal + sum(a * math.sin(2.0 * j * conformal) for j, a in enumerate(alpha, start=1))

    def place(self, x_m: float, y_m: float) -> GeoPlace:
        """Return where on the earth a place in `map` is."""
        xi = (y_m - self._false_m[1]) / self._unit_m + self._start
        eta = (x_m - self._false_m[0]) / self._unit_m
        north = xi - sum(b * math.sin(2 * j * xi) * math.cosh(2 * j * eta) for j, b in enumerate(self._beta, start=1))
        east = eta - sum(b * math.cos(2 * j * xi) * math.sinh(2 * j * eta) for j, b in enumerate(self._beta, start=1))
        wanted = math.sin(north) / math.hypot(math.sinh(east), math.cos(north))
        longitude = self._meridian_deg + math.degrees(math.atan2(math.sinh(east), math.cos(north)))
        return GeoPlace(math.degrees(math.atan(self._tangent(wanted))), math.remainder(longitude, 360.0))

    def _conformal(self, tangent: float) -> float:
        """Return the tangent of the conformal latitude from that of the latitude."""
        e = math.sqrt(self._e2)
        secant = math.hypot(1.0, tangent)
        sigma = math.sinh(e * math.atanh(e * tangent / secant))
        return tangent * math.hypot(1.0, sigma) - sigma * secant

    def _tangent(self, conformal: float) -> float:
        """Return the tangent of the latitude from that of the conformal latitude."""
        tangent = conformal
        for _ in range(_NEWTON_STEPS):
            found = self._conformal(tangent)
            secant2 = 1.0 + tangent * tangent
            slope = (
                (1.0 - self._e2) * math.sqrt(secant2) * math.hypot(1.0, found) / (1.0 + (1.0 - self._e2) * tangent**2)
            )
            tangent += (conformal - found) / slope
        return tangent


def earth_of(projection: str = "!", offset_m: tuple[float, float] = (0.0, 0.0)) -> Earth | None:
    """Return where a map lies; None where its projection is none that is known here.

    Args:
        projection: a PROJ definition; a world without one (`!`, as in a `.net.xml`) lies round ORIGIN_DEG.
        offset_m: place in `map` less that in the projection's grid.
    """
    if projection.strip() in ("", "!", "-"):
        return Earth("WGS84", ORIGIN_DEG, 1.0, (0.0, 0.0))
    words = dict(word.lstrip("+").partition("=")[::2] for word in projection.split())
    kind = words.pop("proj", "")
    ellipsoid = words.get("datum", words.get("ellps", "GRS80"))
    if ellipsoid not in _ELLIPSOIDS or words.get("units", "m") != "m" or not words.keys() <= _IDLE | {*_NUMBERS}:
        return None
    try:
        numbers = {name: float(words[name]) for name in _NUMBERS if name in words}
    except ValueError:
        return None
    if not all(map(math.isfinite, numbers.values())):
        return None
    if kind == "utm" and 1.0 <= numbers.get("zone", 0.0) <= 60.0 and numbers["zone"].is_integer():
        origin, scale = (0.0, 6.0 * numbers["zone"] - 183.0), _UTM_SCALE
        false = (_UTM_EAST_M, _UTM_SOUTH_M if "south" in words else 0.0)
    elif kind == "tmerc" and "south" not in words:
        origin, scale = (
            (numbers.get("lat_0", 0.0), numbers.get("lon_0", 0.0)),
            numbers.get("k_0", numbers.get("k", 1.0)),
        )
        false = (numbers.get("x_0", 0.0), numbers.get("y_0", 0.0))
    else:
        return None
    if abs(origin[0]) >= 90.0 or scale <= 0.0:
        return None
    return Earth(ellipsoid, origin, scale, (false[0] + offset_m[0], false[1] + offset_m[1]))
