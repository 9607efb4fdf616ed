"""What stands beside the road where the world does not say: houses, trees and speed signs, the same in every drive."""

import math
from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.hud.driver_view.hills import stood
from simconsole.hud.driver_view.mesh import Box, Colour, Material, Vertices, box, cone, facets, joined, left_of, quads
from simconsole.hud.driver_view.occupancy import Occupancy
from simconsole.values.height_field import HeightField

Array = NDArray[np.float64]

SEED: Final = 20180607
HOUSE_EVERY_M: Final = 24.0
TREE_EVERY_M: Final = 14.0
SIGN_EVERY_M: Final = 400.0
TOWN_KMH: Final = 60.0
"""Up to this limit there are houses, kerbs and pavements beside a road; above it trees further away."""
COUNTRY_TREE_M: Final = 5.0
"""By how much further."""
FIRST_SIGN_M: Final = 30.0
"""From where the path begins; a limit that begins further on has its sign there, or a few metres later."""
SIGN_LATER_M: Final = (0.0, 10.0, 20.0, 30.0)
SIDES_M: Final = (-1.0, 1.0)
BEHIND_PAVEMENT_M: Final = 4.6
WALLS: Final[tuple[Colour, ...]] = ((196, 178, 152), (178, 152, 132), (206, 200, 190), (158, 120, 104), (186, 188, 178))
ROOFS: Final[tuple[Colour, ...]] = ((122, 66, 52), (92, 88, 90), (104, 74, 62))
CROWNS: Final[tuple[Colour, ...]] = ((62, 96, 48), (74, 108, 54), (54, 86, 52))
TRUNK: Final[Colour] = (92, 72, 54)
POST: Final[Colour] = (128, 130, 134)
SIGN_RED: Final[Colour] = (176, 24, 32)
SIGN_WHITE: Final[Colour] = (240, 240, 238)
INK: Final[Colour] = (24, 24, 26)
SIGN_RADIUS_M: Final = 0.3
SIGN_ASIDES_M: Final = (3.0, 6.5, 10.0, 13.5)
"""To the right of the path: the nearest that no other lane takes."""
_DIGITS: Final = {
    "0": (7, 5, 5, 5, 7), "1": (2, 6, 2, 2, 7), "2": (7, 1, 7, 4, 7), "3": (7, 1, 7, 1, 7), "4": (5, 5, 7, 1, 1),
    "5": (7, 4, 7, 1, 7), "6": (7, 4, 7, 5, 7), "7": (7, 1, 1, 2, 2), "8": (7, 5, 7, 5, 7), "9": (7, 5, 7, 1, 7),
}  # fmt: skip


Limits = Sequence[tuple[float, float]]
"""Speed limits along a path: from where in m, and in km/h; none: there are no signs."""


def in_town(limits: Limits, s_m: Array) -> NDArray[np.bool_]:
    """Return for each place along the path whether houses stand there: where the limit is that of a town, or none."""
    if not limits:
        return np.ones(len(s_m), dtype=bool)
    starts, kmh = np.array(limits).T
    return np.asarray(kmh[np.maximum(np.searchsorted(starts, s_m, side="right") - 1, 0)] <= TOWN_KMH)


class Surroundings(NamedTuple):
    """What stands beside the road."""

    signs: Vertices
    houses: Vertices
    trees: Vertices


NO_SURROUNDINGS: Final = Surroundings(joined([]), joined([]), joined([]))


def surroundings(path: Array, limits: Limits, taken: Occupancy, ground: HeightField | None = None) -> Surroundings:
    """Return houses, trees and signs along a path [N, 2], on ground that is free; takes it.

    Houses stand upright on the ground's height; what is slender is made for level ground.
    """
    generator = np.random.Generator(np.random.PCG64(SEED))
    across = left_of(path)
    way = np.concatenate(((0.0,), np.cumsum(np.hypot(*np.diff(path, axis=0).T))))

    def sign(at_m: float, limit_kmh: float) -> Vertices:
        spots = [_place(path, across, way, min(at_m + later, way[-1])) for later in SIGN_LATER_M]
        made = (_sign(*spot, aside_m, limit_kmh, taken) for aside_m in SIGN_ASIDES_M for spot in spots)
        return next((one for one in made if len(one)), joined([]))

    ends = [*(start for start, _ in limits[1:]), way[-1]][: len(limits)]
    signs = [
        sign(at_m, kmh)
        for (start, kmh), end in zip(limits, ends, strict=True)
        for at_m in np.arange(max(start, FIRST_SIGN_M), end, SIGN_EVERY_M).tolist()
    ]

    def places_of(first_m: float, every_m: float) -> Iterator[tuple[Array, Array, bool]]:
        at = np.arange(first_m, way[-1], every_m)
        for s_m, is_town in zip(at.tolist(), in_town(limits, at).tolist(), strict=True):
            yield *_place(path, across, way, s_m), is_town

    houses = [
        _house(point, left, side, taken, generator)
        for point, left, is_town in places_of(10.0, HOUSE_EVERY_M)
        for side in SIDES_M
        if is_town
    ]
    trees = [
        _tree(point, left, side, 0.0 if is_town else COUNTRY_TREE_M, taken, generator)
        for point, left, is_town in places_of(4.0, TREE_EVERY_M)
        for side in SIDES_M
    ]
    return Surroundings(joined(signs), joined([stood(house, ground) for house in houses]), joined(trees))


def _place(path: Array, across: Array, way: Array, s_m: float) -> tuple[Array, Array]:
    """Return point and left direction of the path at `s_m`."""
    index = min(int(np.searchsorted(way, s_m)), len(path) - 1)
    return path[index], across[index] / np.linalg.norm(across[index])


def _house(point: Array, left: Array, side: float, taken: Occupancy, generator: np.random.Generator) -> Vertices:
    length, depth = generator.uniform(5.0, 9.5), generator.uniform(4.5, 6.5)
    height, setback = 3.0 * generator.integers(2, 6), generator.uniform(0.0, 3.0)
    wall, roof = WALLS[int(generator.integers(len(WALLS)))], ROOFS[int(generator.integers(len(ROOFS)))]
    road = 3.5 if side < 0.0 else 7.0
    centre = point + side * (road + BEHIND_PAVEMENT_M + setback + depth) * left
    if not taken.take_disc(float(centre[0]), float(centre[1]), max(length, depth) + 1.0):
        return joined([])
    yaw = math.atan2(-float(left[0]), float(left[1]))
    place = Box(
        x_m=float(centre[0]), y_m=float(centre[1]), z_m=0.0, half_length_m=float(length), half_width_m=float(depth),
        height_m=float(height), yaw_rad=yaw,
    )  # fmt: skip
    return joined([box(place, wall, roof, Material.WALL), _gable(place, roof)])


def _gable(place: Box, colour: Colour) -> Vertices:
    """Return a pitched roof over a box, its ridge along the length."""
    cosine, sine = math.cos(place.yaw_rad), math.sin(place.yaw_rad)
    along = np.array((cosine, sine, 0.0)) * (place.half_length_m + 0.3)
    across = np.array((-sine, cosine, 0.0)) * (place.half_width_m + 0.3)
    eaves = np.array((place.x_m, place.y_m, place.z_m + place.height_m))
    ridge = eaves + np.array((0.0, 0.0, 0.55 * place.half_width_m))
    slopes = np.array(
        (
            (eaves - along - across, eaves + along - across, ridge + along, ridge - along),
            (eaves + along + across, eaves - along + across, ridge - along, ridge + along),
        )
    )
    ends = np.array(
        (
            (eaves + along - across, eaves + along + across, ridge + along),
            (eaves - along + across, eaves - along - across, ridge - along),
        )
    )
    return joined([quads(slopes, colour), facets(ends, colour)])


def _tree(
    point: Array, left: Array, side: float, further_m: float, taken: Occupancy, generator: np.random.Generator
) -> Vertices:
    height, aside = generator.uniform(4.5, 8.5), further_m + generator.uniform(0.0, 6.0)
    crown = CROWNS[int(generator.integers(len(CROWNS)))]
    road = 3.5 if side < 0.0 else 7.0
    x, y = (point + side * (road + 2.2 + aside) * left).tolist()
    if not taken.take_disc(x, y, 0.9):
        return joined([])
    trunk = cone(x, y, (0.0, 0.35 * height), (0.14, 0.11), TRUNK)
    low = cone(x, y, (0.3 * height, 0.62 * height), (0.30 * height, 0.24 * height), crown)
    high = cone(x, y, (0.62 * height, height), (0.24 * height, 0.0), crown)
    return joined([trunk, low, high])


def _sign(point: Array, left: Array, aside_m: float, limit_kmh: float, taken: Occupancy) -> Vertices:
    """Return a speed limit's sign on the right of the path, facing those who come along it; nothing on taken ground."""
    foot = np.append(point - aside_m * left, 0.0)
    if not taken.take_disc(float(foot[0]), float(foot[1]), SIGN_RADIUS_M):
        return joined([])
    ahead, right, up = np.array((left[1], -left[0], 0.0)), np.append(-left, 0.0), np.array((0.0, 0.0, 1.0))
    centre = foot + 2.3 * up
    post = cone(float(foot[0]), float(foot[1]), (0.0, 2.6), (0.035, 0.035), POST)
    red = _disc(centre - 0.05 * ahead, right, up, SIGN_RADIUS_M, SIGN_RED)
    white = _disc(centre - 0.055 * ahead, right, up, 0.76 * SIGN_RADIUS_M, SIGN_WHITE)
    text = _digits(f"{limit_kmh:.0f}", centre - 0.06 * ahead, right, up)
    back = _disc(centre - 0.045 * ahead, -right, up, SIGN_RADIUS_M, POST)
    return joined([post, red, white, text, back])


def _disc(centre: Array, right: Array, up: Array, radius_m: float, colour: Colour) -> Vertices:
    """Return a round plate, seen from the side on which `right` lies to the right."""
    angles = np.linspace(0.0, math.tau, 17)
    rim = centre + radius_m * (np.cos(angles)[:, None] * right + np.sin(angles)[:, None] * up)
    return facets(np.stack((np.broadcast_to(centre, (16, 3)), rim[:-1], rim[1:]), axis=1), colour)


def _digits(text: str, centre: Array, right: Array, up: Array) -> Vertices:
    """Return a number in blocks of five rows of three."""
    cell = 0.24 * SIGN_RADIUS_M * min(1.0, 2.0 / len(text))
    corners = []
    for index, digit in enumerate(text):
        x = (4.0 * (index - 0.5 * (len(text) - 1)) - 1.5) * cell
        for row, bits in enumerate(_DIGITS[digit]):
            for column in range(3):
                if bits & (4 >> column):
                    corner = centre + (x + column * cell) * right + (1.5 - row) * cell * up
                    corners.append((corner, corner + cell * right, corner + cell * (right + up), corner + cell * up))
    return quads(np.array(corners), INK)
