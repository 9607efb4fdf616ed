"""The driven vehicle as meshes, from its outer size: outside, and what the driver sees of it from the seat."""

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.hud.driver_view.mesh import (
    Box,
    Colour,
    Material,
    Vertices,
    box,
    cone,
    encoded,
    facets,
    joined,
    prism,
    quads,
    ring,
    wheel,
)

Array = NDArray[np.float64]

PAINT: Final[Colour] = (54, 92, 150)
GLASS: Final[Colour] = (38, 46, 54)
RUBBER: Final[Colour] = (30, 30, 32)
ALLOY: Final[Colour] = (150, 152, 156)
TRIM: Final[Colour] = (34, 35, 38)
LEATHER: Final[Colour] = (26, 26, 28)
HEADLAMP: Final[Colour] = (250, 246, 224)
TAIL_LAMP: Final[Colour] = (156, 12, 14)
BRAKE_LAMP: Final[Colour] = (255, 40, 32)
INDICATOR: Final[Colour] = (255, 160, 20)
BALL: Final[Colour] = (214, 126, 44)
HAND_WHEEL_RADIUS_M: Final = 0.185
WHEEL_RADIUS_M: Final = 0.31
ROBOT_WHEEL_RADIUS_M: Final = 0.033  # of both TurtleBot3
CAR_LENGTH_M: Final = 4.0
SEAT_M: Final = 1.0
"""Height from which a person can sit in a vehicle."""


class Size(NamedTuple):
    """A vehicle in m; base_link is `rear_overhang_m` from its rear end, `wheelbase_m` behind the front axle."""

    length_m: float
    width_m: float
    height_m: float
    rear_overhang_m: float
    wheelbase_m: float

    @property
    def is_ball(self) -> bool:
        """Whether it is as long as wide as high."""
        return self.length_m == self.width_m == self.height_m

    @property
    def scale(self) -> float:
        """Size against a car: how much nearer the camera of a small robot stands."""
        return min(1.0, max(0.1, self.length_m / CAR_LENGTH_M))

    @property
    def has_seat(self) -> bool:
        """Whether a person sees the road from inside of it."""
        return self.height_m >= SEAT_M and not self.is_ball

    @property
    def front_m(self) -> float:
        """From base_link to the front end."""
        return self.length_m - self.rear_overhang_m

    @property
    def eye_m(self) -> tuple[float, float, float]:
        """Where the driver's eyes are from base_link on the ground, sitting on the left."""
        return (self.front_m - 0.53 * self.length_m, 0.2 * self.width_m, 0.80 * self.height_m)


class VehicleMeshes(NamedTuple):
    """A vehicle in its own frame (base_link on the ground); parts that move stand about their own origin."""

    body: Vertices
    wheel: Vertices
    wheel_places: tuple[tuple[float, float], ...]  # (x, y) in m; of four the first two are steered
    brake_lamps: Vertices
    left_indicators: Vertices
    right_indicators: Vertices
    bonnet: Vertices
    hand_wheel: Vertices  # about the hub, in the plane of y and z
    hand_wheel_place: tuple[float, float, float]
    hand_wheel_tilt_rad: float
    wheel_radius_m: float = WHEEL_RADIUS_M

    def steers(self, wheel: int) -> bool:
        """Return whether the wheel at this of `wheel_places` turns with the steering."""
        return len(self.wheel_places) > 2 and wheel < 2


def vehicle_meshes(size: Size) -> VehicleMeshes:
    """Return a car of this size, a ball, or a robot on two wheels."""
    if size.is_ball:
        return _seatless(_ball(0.5 * size.height_m))
    if not size.has_seat:
        half_axle = 0.5 * size.wheelbase_m  # of a robot: between its two wheels
        tyre = wheel(0.0, 0.0, ROBOT_WHEEL_RADIUS_M, 0.018, RUBBER, ALLOY)
        return _seatless(_robot(size))._replace(
            wheel=tyre, wheel_places=((0.0, half_axle), (0.0, -half_axle)), wheel_radius_m=ROBOT_WHEEL_RADIUS_M
        )
    return _car(size)


def _seatless(body: Vertices) -> VehicleMeshes:
    """Return what has a body and nothing else."""
    nothing = joined([])
    return VehicleMeshes(
        body=body, wheel=nothing, wheel_places=(), brake_lamps=nothing, left_indicators=nothing,
        right_indicators=nothing, bonnet=nothing, hand_wheel=nothing, hand_wheel_place=(0.0, 0.0, 0.0),
        hand_wheel_tilt_rad=0.0,
    )  # fmt: skip


def _car(size: Size) -> VehicleMeshes:
    half = 0.5 * size.width_m
    track = half - 0.12
    eye = size.eye_m
    return VehicleMeshes(
        body=_outside(size),
        wheel=wheel(0.0, 0.0, WHEEL_RADIUS_M, 0.2, RUBBER, ALLOY),
        wheel_places=((size.wheelbase_m, track), (size.wheelbase_m, -track), (0.0, track), (0.0, -track)),
        brake_lamps=_lamps(size, 0.62, -size.rear_overhang_m - 0.01, (-1.0, 1.0), BRAKE_LAMP),
        left_indicators=_indicators(size, 1.0),
        right_indicators=_indicators(size, -1.0),
        bonnet=_bonnet(size),
        hand_wheel=_hand_wheel(),
        hand_wheel_place=(eye[0] + 0.52, eye[1], eye[2] - 0.37),
        hand_wheel_tilt_rad=math.radians(24.0),
    )


def _robot(size: Size) -> Vertices:
    """Return decks on posts, a scanner on the top one, and a coloured edge in front."""
    middle = size.front_m - 0.5 * size.length_m
    half_length, half_width, high = 0.5 * size.length_m, 0.5 * size.wheelbase_m - 0.012, size.height_m
    deck_m, foot = 0.04 * high, 0.08 * high

    def deck(z_m: float) -> Vertices:
        return box(
            Box(
                x_m=middle, y_m=0.0, z_m=z_m, half_length_m=half_length, half_width_m=half_width, height_m=deck_m,
            ),
            TRIM,
        )  # fmt: skip

    top = 0.76 * high
    posts = [
        cone(middle + along * 0.8 * half_length, side * 0.8 * half_width, (foot, top), (0.005, 0.005), ALLOY)
        for along in (-1.0, 1.0)
        for side in (-1.0, 1.0)
    ]
    computer = Box(
        x_m=middle, y_m=0.0, z_m=foot + deck_m, half_length_m=0.7 * half_length, half_width_m=0.7 * half_width,
        height_m=0.25 * high,
    )  # fmt: skip
    edge = Box(
        x_m=size.front_m, y_m=0.0, z_m=top, half_length_m=0.004, half_width_m=half_width, height_m=deck_m,
    )  # fmt: skip
    scanner_m = 0.3 * min(half_length, half_width) + 0.015
    scanner = cone(middle, 0.0, (top + deck_m, high), (scanner_m, scanner_m), LEATHER)
    decks = [deck(foot), deck(0.45 * high), deck(top)]
    return joined([*decks, *posts, box(computer, PAINT), box(edge, INDICATOR), scanner])


def _outside(size: Size) -> Vertices:
    """Return body, cabin, lamps and number plates of a car."""
    front, rear, high, half = size.front_m, -size.rear_overhang_m, size.height_m, 0.5 * size.width_m
    sill, waist, bonnet = 0.13 * high, 0.60 * high, 0.52 * high
    lower = np.array(
        (
            (rear + 0.08, sill), (front - 0.12, sill), (front, 0.5 * bonnet), (front - 0.10, 0.94 * bonnet),
            (front - 0.24 * size.length_m, waist), (rear + 0.02, waist), (rear, 0.5 * waist),
        )
    )  # fmt: skip
    roof_front, roof_rear = front - 0.45 * size.length_m, rear + 0.14 * size.length_m
    cabin = np.array(
        (
            (rear + 0.03, waist),
            (front - 0.25 * size.length_m, waist),
            (roof_front, high - 0.03),
            (roof_rear, high - 0.03),
        )
    )
    roof = np.array(
        ((roof_rear, high - 0.03), (roof_front, high - 0.03), (roof_front - 0.1, high), (roof_rear + 0.1, high))
    )
    return joined(
        [
            prism(lower, half, -half, PAINT),
            prism(cabin, 0.88 * half, -0.88 * half, GLASS),
            prism(roof, 0.86 * half, -0.86 * half, PAINT),
            _lamps(size, 0.42, front + 0.005, (-1.0, 1.0), HEADLAMP),
            _lamps(size, 0.62, rear - 0.005, (-1.0, 1.0), TAIL_LAMP),
        ]
    )


def _lamps(
    size: Size, up: float, x_m: float, sides: tuple[float, ...], colour: Colour, reach: float = 0.86
) -> Vertices:
    """Return plates across the car at `x_m`, facing away from its middle."""
    half, z = 0.5 * size.width_m, up * 0.62 * size.height_m
    corners = []
    for side in sides:
        inner, outer = side * (reach - 0.22) * half, side * reach * half
        right, left = min(inner, outer), max(inner, outer)
        plate = [(x_m, left, z), (x_m, right, z), (x_m, right, z + 0.11), (x_m, left, z + 0.11)]
        corners.append(plate if x_m < 0.0 else plate[::-1])
    return quads(np.array(corners), colour, Material.GLOWING)


def _indicators(size: Size, side: float) -> Vertices:
    rear = _lamps(size, 0.80, -size.rear_overhang_m - 0.01, (side,), INDICATOR)
    return joined([rear, _lamps(size, 0.42, size.front_m + 0.012, (side,), INDICATOR, 0.98)])


def _bonnet(size: Size) -> Vertices:
    """Return what the driver sees of the car: bonnet, the top of the dashboard, and the screen's pillars."""
    half, eye = 0.5 * size.width_m, size.eye_m
    back, front = eye[0] + 0.85, size.front_m - 0.08
    x = np.array((back, back, back + 0.35 * (front - back), back + 0.75 * (front - back), front))
    z = np.array((0.5, 0.61, 0.60, 0.56, 0.46)) * size.height_m
    y = np.array((-0.86, -0.5, 0.0, 0.5, 0.86)) * half
    crown = np.array((-0.045, 0.0, 0.02, 0.0, -0.045))
    grid = np.stack(np.broadcast_arrays(x[:, None], y[None, :], z[:, None] + crown[None, :]), axis=-1)
    metal = np.stack((grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]), axis=2).reshape(-1, 4, 3)
    shelf_z, shelf_x = eye[2] - 0.33, eye[0] + 0.45
    shelf = np.array(
        [
            (
                (shelf_x, -half, shelf_z - 0.06),
                (back, -half, shelf_z),
                (back, half, shelf_z),
                (shelf_x, half, shelf_z - 0.06),
            )
        ]
    )
    pillars = []
    for side in (-1.0, 1.0):
        foot, head = (
            np.array((back, side * 0.93 * half, shelf_z)),
            np.array((eye[0] + 0.22, side * 0.72 * half, size.height_m)),
        )
        wide = np.array((0.0, side * 0.075, 0.0))
        plate = (foot, foot + wide, head + wide, head)
        pillars.append(plate if side < 0.0 else plate[::-1])
    return joined([quads(metal, PAINT), quads(shelf, TRIM), quads(np.array(pillars), TRIM)])


def _hand_wheel() -> Vertices:
    """Return rim, spokes and hub in the plane of y (left) and z (up), the driver on the side of -x."""
    right, up = np.array((0.0, -1.0, 0.0)), np.array((0.0, 0.0, 1.0))
    rim = ring(np.zeros(3), right, up, (HAND_WHEEL_RADIUS_M, 0.016), LEATHER)
    reach, wide = HAND_WHEEL_RADIUS_M, 0.022
    spokes = np.array(
        (
            ((0.0, reach, -wide), (0.0, -reach, -wide), (0.0, -reach, wide), (0.0, reach, wide)),
            ((0.0, wide, -reach), (0.0, -wide, -reach), (0.0, -wide, 0.0), (0.0, wide, 0.0)),
        )
    )
    mark_low, mark_high = reach - 0.018, reach + 0.018
    mark = np.array(
        [
            (
                (-0.018, 0.012, mark_low),
                (-0.018, -0.012, mark_low),
                (-0.018, -0.012, mark_high),
                (-0.018, 0.012, mark_high),
            )
        ]
    )
    return joined([rim, quads(spokes, TRIM), quads(spokes[:, ::-1], TRIM), quads(mark, INDICATOR)])


def _ball(radius_m: float) -> Vertices:
    """Return a ball that stands on the ground, in two colours so that its rolling is seen."""
    around, up = np.linspace(0.0, math.tau, 25), np.linspace(-0.5 * math.pi, 0.5 * math.pi, 13)
    points = radius_m * np.stack(
        np.broadcast_arrays(
            np.cos(up)[:, None] * np.cos(around)[None, :],
            np.cos(up)[:, None] * np.sin(around)[None, :],
            1.0 + np.sin(up)[:, None] + 0.0 * around[None, :],
        ),
        axis=-1,
    )
    cells = np.stack((points[:-1, :-1], points[:-1, 1:], points[1:, 1:], points[1:, :-1]), axis=2)
    even = (np.add.outer(np.arange(12) // 3, np.arange(24) // 6) % 2 == 0).reshape(-1)
    corners = cells.reshape(-1, 4, 3)
    return joined([_smooth(corners[even], radius_m, BALL), _smooth(corners[~even], radius_m, TRIM)])


def _smooth(corners: Array, radius_m: float, colour: Colour) -> Vertices:
    made = facets(np.concatenate((corners[:, (0, 1, 2)], corners[:, (0, 2, 3)])), colour)
    outward = (made["position"] - np.array((0.0, 0.0, radius_m))) / radius_m
    made["normal"][:, :3] = encoded(outward)
    return made
