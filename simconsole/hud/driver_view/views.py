"""Which cameras look where: the driver's eyes on one or several screens, three mirrors, chase and bird's eye."""

import math
from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.hud.driver_view.camera import Camera, Lens, Viewport, rotation
from simconsole.hud.driver_view.motion import ShownVehicle
from simconsole.hud.driver_view.vehicle_body import Size
from simconsole.profiles.view import DriverViewProfile

Array = NDArray[np.float64]

MIRROR_FOV_DEG: Final = {"left": 26.0, "inner": 22.0, "right": 30.0}
MIRROR_PLACES: Final = {
    "left": Viewport(0.01, 0.36, 0.16, 0.17),
    "inner": Viewport(0.62, 0.80, 0.22, 0.12),
    "right": Viewport(0.83, 0.36, 0.16, 0.17),
}
"""In shares of the road before the driver; the inner mirror right of the middle, as from a seat on the left."""
MIRROR_GAP: Final = 0.02
CHASE_BACK: Final = 4.8  # of the vehicle's width
CHASE_UP: Final = 1.7  # of the vehicle's height
BIRD_UP_M: Final = 55.0


class Look(NamedTuple):
    """One picture in the window: who looks, with what, where it goes, and whether the car's inside is in it."""

    camera: Camera
    lens: Lens
    viewport: Viewport
    from_seat: bool  # the driver's own eyes: bonnet and hand wheel instead of the car's outside
    is_mirror: bool = False
    shows_vehicle: bool = True


def mounted(
    shown: ShownVehicle,
    place_m: tuple[float, float, float],
    turn_rad: tuple[float, float],
    horizontal_fov_rad: float,
    aspect: float,
) -> Look:
    """Return what a camera on the vehicle sees, which does not see the vehicle itself.

    Args:
        shown: The vehicle now.
        place_m: Of the camera, from base_link.
        turn_rad: Its yaw and then its pitch from the vehicle's axes.
        horizontal_fov_rad: Angle that it sees from side to side.
        aspect: Width to height of its picture.
    """
    axes = rotation(shown.yaw_rad, shown.pitch_rad, shown.roll_rad)
    eye = np.array((shown.x_m, shown.y_m, shown.z_m)) + axes @ np.array(place_m)
    camera = Camera(eye, axes @ rotation(*turn_rad))
    return Look(camera, Lens(horizontal_fov_rad, aspect), Viewport(), from_seat=True, shows_vehicle=False)


class RoadParts(NamedTuple):
    """Which parts of the window show the road."""

    displays: Mapping[int | None, Viewport]  # by the number that a screen of the profile names; None: it names none
    front: Viewport  # what is before the driver, on one screen: mirrors are there
    below_messages: float = 1.0  # share of `front`, from below, that messages never hide


def looks(
    profile: DriverViewProfile, shown: ShownVehicle, size: Size, parts: RoadParts, width_px: int, height_px: int
) -> list[Look]:
    """Return every picture of one frame. A screen on a display that is not in `parts` is left out.

    Args:
        profile: Cameras and mirrors.
        shown: The vehicle now.
        size: Its outer size.
        parts: Which parts of the window show the road.
        width_px: Width of the window.
        height_px: Height of the window.
    """
    kind = "chase" if profile.camera == "driver" and not size.has_seat else profile.camera
    found = []
    for screen in profile.screens:
        window = parts.displays.get(screen.display)
        if window is None:
            continue
        viewport = _inside(window, Viewport(screen.left, screen.bottom, screen.width, screen.height))
        lens = Lens(math.radians(screen.horizontal_fov_deg), _aspect(viewport, width_px, height_px), profile.horizon)
        camera = _camera(kind, shown, size, math.radians(screen.yaw_deg))
        found.append(Look(camera, lens, viewport, from_seat=kind == "driver"))
    if profile.mirrors and kind == "driver":
        for name, place in MIRROR_PLACES.items():
            lowered = place._replace(bottom=min(place.bottom, parts.below_messages - MIRROR_GAP - place.height))
            found.append(_mirror(name, shown, size, _inside(parts.front, lowered), width_px, height_px))
    return found


def _camera(kind: str, shown: ShownVehicle, size: Size, yaw_rad: float) -> Camera:
    place = np.array((shown.x_m, shown.y_m, shown.z_m))
    if kind == "driver":
        axes = rotation(shown.yaw_rad, shown.pitch_rad, shown.roll_rad)
        return Camera(place + axes @ np.array(size.eye_m), axes @ rotation(yaw_rad))
    level = rotation(shown.yaw_rad + yaw_rad)
    if kind == "chase":
        back, up = CHASE_BACK * size.width_m, CHASE_UP * size.height_m
        halfway_rad = 0.5 * math.atan2(up - 0.5 * size.height_m, back)  # between the horizon and the vehicle
        return Camera(place + level @ np.array((-back, 0.0, up)), level @ rotation(0.0, halfway_rad))
    north_up = rotation(0.5 * math.pi, math.radians(89.9))
    return Camera(place + np.array((0.0, 0.0, BIRD_UP_M * size.scale)), north_up)


def _mirror(name: str, shown: ShownVehicle, size: Size, viewport: Viewport, width_px: int, height_px: int) -> Look:
    axes = rotation(shown.yaw_rad, shown.pitch_rad, shown.roll_rad)
    eye, half = size.eye_m, 0.5 * size.width_m
    place = {
        "left": (eye[0] + 0.55, half + 0.12, eye[2] - 0.22),
        "inner": (eye[0] + 0.45, 0.0, eye[2] + 0.08),
        "right": (eye[0] + 0.55, -half - 0.12, eye[2] - 0.22),
    }[name]
    outwards = {"left": -0.10, "inner": 0.0, "right": 0.10}[name]
    lens = Lens(math.radians(MIRROR_FOV_DEG[name]), _aspect(viewport, width_px, height_px), 0.55, is_mirror=True)
    base = np.array((shown.x_m, shown.y_m, shown.z_m))
    camera = Camera(base + axes @ np.array(place), axes @ rotation(math.pi + outwards))
    return Look(camera, lens, viewport, from_seat=name == "inner", is_mirror=True)


def _inside(outer: Viewport, inner: Viewport) -> Viewport:
    return Viewport(
        outer.left + inner.left * outer.width,
        outer.bottom + inner.bottom * outer.height,
        inner.width * outer.width,
        inner.height * outer.height,
    )


def _aspect(viewport: Viewport, width_px: int, height_px: int) -> float:
    _, _, width, height = viewport.pixels(width_px, height_px)
    return width / height
