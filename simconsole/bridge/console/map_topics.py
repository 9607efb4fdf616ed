"""The messages about the map: its drawing as markers, and where on the earth the vehicle is."""

from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.bridge.console.published_tick import MAP_FRAME, ONCE, OutputTopic, PublishedTick
from simconsole.bridge.messages import Registry
from simconsole.profiles.link import LocalisationProfile
from simconsole.world.drawing import Drawing
from simconsole.world.triangles import triangulate
from simconsole.world.world import ShownMap

MARKERS: Final = "/map/markers"
GNSS: Final = "/gnss/fix"
GNSS_FRAME: Final = "base_link"
GNSS_HZ: Final = 10.0
MOST_POINTS: Final = 20_000
"""Of all markers; as JSON a point takes some 40 bytes. What is more is left out, surfaces first."""
_LINE_M: Final = 0.12
_STRAIGHT_M: Final = 0.02  # points as near as this to the line between their neighbours are left out
_HEIGHTS_M: Final = 0.01  # between layers, so that a viewer does not mix them
_DIGITS: Final = 2

Array = NDArray[np.float64]
Colour = tuple[float, float, float, float]


class _Layer(NamedTuple):
    """One marker: its name space, whether its shapes are areas, its colour and how high it lies."""

    name: str
    area: bool
    colour: Colour
    height_m: float


_LAYERS: Final = (
    _Layer("stop_lines", True, (1.0, 1.0, 1.0, 1.0), 3.0 * _HEIGHTS_M),
    _Layer("zebras", True, (0.95, 0.95, 0.95, 1.0), 3.0 * _HEIGHTS_M),
    _Layer("edges", False, (0.85, 0.85, 0.85, 1.0), 2.0 * _HEIGHTS_M),
    _Layer("centre_lines", False, (0.95, 0.85, 0.4, 1.0), 2.0 * _HEIGHTS_M),
    _Layer("islands", True, (0.3, 0.5, 0.3, 1.0), _HEIGHTS_M),
    _Layer("surfaces", True, (0.28, 0.29, 0.31, 1.0), 0.0),
)


class MapTopics:
    """Builds them."""

    def __init__(self, registry: Registry, shown: ShownMap, errors: LocalisationProfile) -> None:
        """Take what to show, and the errors that the covariance of a position tells of."""
        self._shown = shown
        self._variance_m2 = errors.position_noise_m**2 + errors.position_drift_m**2
        self._marker_array = registry.struct("visualization_msgs/MarkerArray")
        self._marker = registry.struct("visualization_msgs/Marker")
        self._point = registry.struct("geometry_msgs/Point")
        self._vector = registry.struct("geometry_msgs/Vector3")
        self._colour = registry.struct("std_msgs/ColorRGBA")
        self._fix = registry.struct("sensor_msgs/NavSatFix")
        self._status = registry.struct("sensor_msgs/NavSatStatus")

    def topics(self) -> tuple[OutputTopic, ...]:
        """Return their rows of the table of output topics."""
        markers = OutputTopic(MARKERS, "visualization_msgs/MarkerArray", ONCE, self._markers)
        if self._shown.earth is None:
            return (markers,)
        return markers, OutputTopic(GNSS, "sensor_msgs/NavSatFix", GNSS_HZ, self._position, measured=True)

    def _position(self, tick: PublishedTick) -> Any:
        assert self._shown.earth is not None
        vehicle = tick.measured
        place = self._shown.earth.place(vehicle.x_m, vehicle.y_m)
        status, variance = self._status, self._variance_m2
        return self._fix(
            header=tick.header(GNSS_FRAME),
            status=status(status.STATUS_FIX, status.SERVICE_GPS),
            latitude=place.latitude_deg,
            longitude=place.longitude_deg,
            altitude=vehicle.z_m,
            position_covariance=[variance, 0.0, 0.0, 0.0, variance, 0.0, 0.0, 0.0, 0.0],
            position_covariance_type=self._fix.COVARIANCE_TYPE_DIAGONAL_KNOWN,
        )

    def _markers(self, tick: PublishedTick) -> Any:
        drawing = self._shown.drawing()
        if drawing is None:
            return self._marker_array([])
        layers = zip(_LAYERS, _points_of(_Drawn(drawing)), strict=True)
        found = [self._layer(tick, number, *layer) for number, layer in enumerate(layers) if layer[1]]
        return self._marker_array(found)

    def _layer(self, tick: PublishedTick, number: int, layer: _Layer, points: Sequence[tuple[float, float]]) -> Any:
        width_m = 1.0 if layer.area else _LINE_M
        return self._marker(
            header=tick.header(MAP_FRAME),
            ns=layer.name,
            id=number,
            type=self._marker.TRIANGLE_LIST if layer.area else self._marker.LINE_LIST,
            scale=self._vector(width_m, 1.0, 1.0),
            color=self._colour(*layer.colour),
            points=[self._point(x, y, layer.height_m) for x, y in points],
        )


class _Drawn:
    """A drawing as a key: itself, not what is in it."""

    def __init__(self, drawing: Drawing) -> None:
        self.drawing = drawing

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Drawn) and other.drawing is self.drawing

    def __hash__(self) -> int:
        return id(self.drawing)


@lru_cache(maxsize=1)  # the platforms of a session have one world
def _points_of(drawn: _Drawn) -> list[list[tuple[float, float]]]:
    """Return the points of each of `_LAYERS`, in all at most MOST_POINTS."""
    found: list[list[tuple[float, float]]] = []
    for layer in _LAYERS:
        left = MOST_POINTS - sum(map(len, found))
        found.append(_points(getattr(drawn.drawing, layer.name), layer.area, left))
    return found


def _points(shapes: Iterable[Array], area: bool, most: int) -> list[tuple[float, float]]:
    """Return the points of a list of triangles or of lines, of whole shapes only, at most so many."""
    found: list[tuple[float, float]] = []
    for shape in shapes:
        points = list(_triangles(shape) if area else _lines(shape))
        if len(found) + len(points) <= most:
            found += points
    return found


def _triangles(polygon: Array) -> Iterator[tuple[float, float]]:
    for x, y in polygon[triangulate(polygon).ravel()].tolist():
        yield round(x, _DIGITS), round(y, _DIGITS)


def _lines(line: Array) -> Iterator[tuple[float, float]]:
    kept = [(round(x, _DIGITS), round(y, _DIGITS)) for x, y in _without_straight(line).tolist()]
    for one, other in pairwise(kept):
        yield one
        yield other


def _without_straight(line: Array) -> Array:
    """Return a line [N, 2] without the points that lie on the way between those that stay."""
    kept = [0]
    for place in range(2, len(line)):
        start, end = line[kept[-1]], line[place]
        between = line[kept[-1] + 1 : place] - start
        way = end - start
        length = float(np.hypot(*way))
        off = np.abs(between[:, 1] * way[0] - between[:, 0] * way[1]) / max(length, 1e-9)
        if off.max() > _STRAIGHT_M:
            kept.append(place - 1)
    kept.append(len(line) - 1)
    return line[kept]
