"""Double lane change (ISO 3888): the courses, a driver who looks ahead along a path, and the fastest clean entry.

Lengths and widths are general knowledge of the standards (the totals of 125 m and 61 m stand in their public
previews); the car's width is that of its body.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.drivers.manoeuvre_driver.run_up import HoldSpeed, RunUp
from simconsole.evaluation.manoeuvres.attempt import Attempt, Driving, Line, Panel, Result, part, traces, undriven
from simconsole.evaluation.metrics.table import Array, Drive
from simconsole.profiles.manoeuvre import DoubleLaneChange
from simconsole.values.platform import Platform
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import DEG_PER_RAD, KMH_PER_MPS, MPS_PER_KMH

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
"""What a practised driver's hands reach for a moment."""


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


class Course(NamedTuple):
    """Lanes in their order, the way through them, and where the throttle is released (None: held all through)."""

    lanes: tuple[Lane, ...]
    way: tuple[Bend, ...]
    release_m: float | None


def course_of(name: str, width_m: float) -> Course:
    """Return a course for a car of this width. Lanes shift to the left."""
    if name == "iso_3888_1":
        lanes = (
            Lane(0.0, 15.0, 0.0, 1.1 * width_m + 0.25),
            Lane(45.0, 70.0, 3.5, 1.2 * width_m + 0.25),
            Lane(95.0, 125.0, 0.0, 1.3 * width_m + 0.25),
        )
        return Course(lanes, _way(lanes, (6.9, 50.9), (68.6, 95.7), (-0.05, -0.14, 0.15)), None)
    first, second, third = 1.1 * width_m + 0.25, width_m + 1.0, max(1.3 * width_m + 0.25, 3.0)
    lanes = (
        Lane(0.0, 12.0, 0.0, first),
        Lane(25.5, 36.5, 0.5 * first + 1.0 + 0.5 * second, second),  # 1 m between the lanes
        Lane(49.0, 61.0, 0.5 * first - 0.5 * third, third),
    )
    return Course(lanes, _way(lanes, (8.4, 30.2), (30.2, 55.6), (0.03, 0.22, -0.25)), 2.0)


def _way(
    lanes: tuple[Lane, ...],
    first: tuple[float, float],
    second: tuple[float, float],
    shares: tuple[float, float, float],
) -> tuple[Bend, ...]:
    """Return two bends; `shares` of half a lane's width say how far left of its middle the driver goes."""
    sides = [lane.middle_m + 0.5 * share * lane.width_m for lane, share in zip(lanes, shares, strict=True)]
    return Bend(*first, sides[0], sides[1]), Bend(*second, sides[1], sides[2])


def path_at(course: Course, s_m: float) -> tuple[float, float, float]:
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

    def __init__(self, course: Course, car: Platform, speed_kmh: float) -> None:
        self._car = car
        self._course = course
        self._hold = HoldSpeed(speed_kmh * MPS_PER_KMH)
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
        """Turn as the path does a moment ahead, and back to it: side and heading of where the car will be then."""
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


def lane_change(spec: DoubleLaneChange, car: Platform) -> Driving:
    """Halve the interval between a clean entry speed and one that is not."""
    course = course_of(spec.course, car.width_m)
    low, high = spec.from_kmh, spec.to_kmh
    best: Drive | None = None
    while best is None or high - low > spec.within_kmh:
        speed = low if best is None else 0.5 * (low + high)
        driver = LaneChanger(course, car, speed)
        pilot = RunUp(speed, car.steering_ratio, driver, rolling=False)
        driven = yield Attempt(f"{speed:.1f} km/h", pilot, 180.0)
        if pilot.began_tick is None or driver.first_cone_m is None:
            return undriven(f"{speed:.1f} km/h", speed)
        test = _from_cone(part(driven, pilot.began_tick - driven.first_tick), driver.first_cone_m)
        if least_room_m(test, course, car) > 0.0:
            low, best = speed, test
        elif best is None:
            return Result({}, (), f"not clean at {speed:g} km/h, the lowest speed asked for")
        else:
            high = speed
    return _result(course, car, low, best)


def _from_cone(drive: Drive, first_cone_m: float) -> Drive:
    """Return the drive with x counted from the first cone."""
    rows = drive.rows.copy()
    rows[:, drive.places["vehicle.x_m"]] -= first_cone_m
    return drive._replace(rows=rows)


def least_room_m(drive: Drive, course: Course, car: Platform) -> float:
    """Return the least distance of a corner of the car from the cones' line; negative: outside.

    A drive that does not get through has none.
    """
    x, y, yaw = (drive.column(f"vehicle.{name}") for name in ("x_m", "y_m", "yaw_rad"))
    if x[-1] < course.lanes[-1].to_m:
        return -math.inf
    least = math.inf
    for along in (car.length_m - car.rear_overhang_m, -car.rear_overhang_m):
        for side in (0.5 * car.width_m, -0.5 * car.width_m):
            corner_x = x + along * np.cos(yaw) - side * np.sin(yaw)
            corner_y = y + along * np.sin(yaw) + side * np.cos(yaw)
            for lane in course.lanes:
                inside = (corner_x >= lane.from_m) & (corner_x <= lane.to_m)
                if inside.any():
                    room = 0.5 * lane.width_m - np.abs(corner_y[inside] - lane.middle_m)
                    least = min(least, float(room.min()))
    return least


def _result(course: Course, car: Platform, speed_kmh: float, drive: Drive) -> Result:
    x, y = drive.column("vehicle.x_m"), drive.column("vehicle.y_m")
    entry = int(np.argmax(x + car.length_m - car.rear_overhang_m >= 0.0))
    exit_ = min(len(x) - 1, int(np.argmax(x >= course.lanes[-1].to_m)))
    inside = part(drive, entry, exit_ + 1)
    rate = np.gradient(inside.column("driver.hand_wheel_rad")) * inside.tick_hz * DEG_PER_RAD
    values = {
        "highest_clean_entry_speed_kmh": speed_kmh,
        "entry_speed_kmh": float(drive.column("vehicle.vx_mps")[entry] * KMH_PER_MPS),
        "exit_speed_kmh": float(drive.column("vehicle.vx_mps")[exit_] * KMH_PER_MPS),
        "highest_lateral_acceleration_mps2": float(np.abs(inside.column("vehicle.ay_mps2")).max()),
        "highest_steering_wheel_rate_degps": float(np.abs(rate).max()),
        "highest_roll_angle_deg": float(np.abs(inside.column("vehicle.roll_rad")).max() * DEG_PER_RAD),
        "least_room_m": least_room_m(drive, course, car),
    }
    kept = slice(entry, exit_ + 1, 4)
    cones = tuple(_cones(lane, sign) for lane in course.lanes for sign in (1.0, -1.0))
    way = Panel("Way of base_link", "distance / m", "to the left / m", (Line("driven", x[kept], y[kept]), *cones))
    hand = inside.column("driver.hand_wheel_rad") * DEG_PER_RAD
    return Result(values, (way, traces("Steering-wheel angle", "angle / deg", {"": (inside, hand)})))


def _cones(lane: Lane, sign: float) -> Line:
    side = lane.middle_m + 0.5 * sign * lane.width_m
    ends: Array = np.array([lane.from_m, lane.to_m])
    return Line("", ends, np.array([side, side]))
