"""A driver through the cones of a double lane change (ISO 3888), who looks ahead along a path of their own. Pure.

Lengths and widths are general knowledge of the standards (the totals of 125 m and 61 m stand in their public
previews); the car's width is that of its body.
"""

import math
from typing import Final, NamedTuple

from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.drivers.speed_holder import SpeedHolder
from simconsole.values.platform import Platform
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import MPS_PER_KMH

APPROACH_M: Final = 20.0
"""From the end of the run-up to the first cones."""
RUN_OUT_M: Final = 30.0

# How the driver steers and where the path lies in the lanes: found by trying, for fast clean drives of both courses.
LOOK_AHEAD_S: Final = 0.16
OFFSET_GAIN_RADPM: Final = 0.14
HEADING_GAIN: Final = 0.75
CHARACTERISTIC_MPS: Final = 25.0
"""Speed at which the driver expects the car to turn half as sharply as its wheels point."""
HAND_DEGPS: Final = 1000.0
"""Highest hand-wheel rate of a practised driver, held for a short time."""


class Lane(NamedTuple):
    """Cones on both sides, between two distances from the first cone."""

    from_m: float
    to_m: float
    middle_m: float
    width_m: float


class Bend(NamedTuple):
    """The driver's way from one lane to the next: sides and distances from the first cone."""

    from_m: float
    to_m: float
    from_side_m: float
    to_side_m: float


class ConeCourse(NamedTuple):
    """Lanes in their order, the way through them, and where the throttle is released (None: held all through)."""

    lanes: tuple[Lane, ...]
    way: tuple[Bend, ...]
    release_m: float | None


def course_of(name: str, width_m: float) -> ConeCourse:
    """Return a course for a car of this width. Lanes shift to the left."""
    if name == "iso_3888_1":
        lanes = (
            Lane(0.0, 15.0, 0.0, 1.1 * width_m + 0.25),
            Lane(45.0, 70.0, 3.5, 1.2 * width_m + 0.25),
            Lane(95.0, 125.0, 0.0, 1.3 * width_m + 0.25),
        )
        return ConeCourse(lanes, _way(lanes, (6.9, 50.9), (68.6, 95.7), (-0.05, -0.14, 0.15)), None)
    first, second, third = 1.1 * width_m + 0.25, width_m + 1.0, max(1.3 * width_m + 0.25, 3.0)
    lanes = (
        Lane(0.0, 12.0, 0.0, first),
        Lane(25.5, 36.5, 0.5 * first + 1.0 + 0.5 * second, second),  # 1 m between the lanes
        Lane(49.0, 61.0, 0.5 * first - 0.5 * third, third),
    )
    return ConeCourse(lanes, _way(lanes, (8.4, 30.2), (30.2, 55.6), (0.03, 0.22, -0.25)), 2.0)


def _way(
    lanes: tuple[Lane, ...],
    first: tuple[float, float],
    second: tuple[float, float],
    shares: tuple[float, float, float],
) -> tuple[Bend, ...]:
    """Return two bends; `shares` of half a lane's width say how far left of its middle the driver goes."""
    sides = [lane.middle_m + 0.5 * share * lane.width_m for lane, share in zip(lanes, shares, strict=True)]
    return Bend(*first, sides[0], sides[1]), Bend(*second, sides[1], sides[2])


def path_at(course: ConeCourse, s_m: float) -> tuple[float, float, float]:
    """Return the driver's path: side in m, its slope and its curvature, at a distance from the first cone.

    A bend is a polynomial whose slope and curvature vanish at both ends (quintic).
    """
    side = course.way[0].from_side_m
    for bend in course.way:
        if s_m <= bend.from_m:
            return side, 0.0, 0.0
        side = bend.to_side_m
        if s_m < bend.to_m:
            length, rise = bend.to_m - bend.from_m, bend.to_side_m - bend.from_side_m
            u = (s_m - bend.from_m) / length
            return (
                bend.from_side_m + rise * u**3 * (10.0 - 15.0 * u + 6.0 * u * u),
                rise / length * 30.0 * u * u * (1.0 - u) ** 2,
                rise / length**2 * 60.0 * u * (1.0 - 3.0 * u + 2.0 * u * u),
            )
    return side, 0.0, 0.0


class LaneChanger:
    """The driver of one attempt, after the run-up."""

    def __init__(self, course: ConeCourse, car: Platform, speed_kmh: float) -> None:
        self._car = car
        self._course = course
        self._hold = SpeedHolder(speed_kmh * MPS_PER_KMH)
        self._hand = 0.0
        self.first_cone_m: float | None = None

    def __call__(self, snapshot: Snapshot, time_s: float) -> Intent | None:
        """Return what hands and feet do now."""
        seen = snapshot.vehicle
        ahead = self._car.length_m - self._car.rear_overhang_m
        if self.first_cone_m is None:
            self.first_cone_m = seen.x_m + ahead + APPROACH_M
        s_m = seen.x_m - self.first_cone_m
        if s_m > self._course.lanes[-1].to_m + RUN_OUT_M or seen.vx_mps < 2.0:
            return None
        release = self._course.release_m
        throttle = self._hold(snapshot) if release is None or s_m + ahead < release else 0.0
        self._hand = self._steer(snapshot, s_m)
        return Intent(hand_wheel_rad=self._hand, throttle=throttle, gear=1.0)

    def _steer(self, snapshot: Snapshot, s_m: float) -> float:
        """Steer by the path's curvature at a preview point, and by the offset and heading predicted there."""
        seen = snapshot.vehicle
        speed = max(seen.vx_mps, 1.0)
        middle = 0.4 * self._car.wheelbase_m  # about the centre of gravity
        side, slope, curvature = path_at(self._course, s_m + middle + speed * LOOK_AHEAD_S)
        across = seen.vy_mps + middle * seen.yaw_rate_radps
        coming_y = seen.y_m + middle * seen.yaw_rad + LOOK_AHEAD_S * (speed * seen.yaw_rad + across)
        coming_yaw = seen.yaw_rad + LOOK_AHEAD_S * seen.yaw_rate_radps
        wanted = self._car.wheelbase_m * curvature * (1.0 + (speed / CHARACTERISTIC_MPS) ** 2)
        wanted += OFFSET_GAIN_RADPM * (side - coming_y) + HEADING_GAIN * (math.atan(slope) - coming_yaw)
        hand = self._car.steering_ratio * wanted
        most = math.radians(HAND_DEGPS) / snapshot.tick_hz
        return self._hand + min(most, max(-most, hand - self._hand))
