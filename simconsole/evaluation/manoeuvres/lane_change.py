"""Double lane change (ISO 3888): the fastest clean entry, and its values."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from simconsole.drivers.manoeuvre_driver.lane_changer import ConeCourse, Lane, LaneChanger, course_of
from simconsole.drivers.manoeuvre_driver.run_up import RunUp
from simconsole.evaluation.manoeuvres.attempt import Attempt, Driving, Line, Panel, Result, part, traces, undriven
from simconsole.evaluation.metrics.table import Array, Drive
from simconsole.profiles.manoeuvre import DoubleLaneChange
from simconsole.values.platform import Platform
from simconsole.values.units import DEG_PER_RAD, KMH_PER_MPS


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

    def read(names: Sequence[str]) -> Iterator[Array]:
        moved = np.array([first_cone_m if name == "vehicle.x_m" else 0.0 for name in names])
        return (block - moved for block in drive.read(names))

    return drive._replace(read=read)


def least_room_m(drive: Drive, course: ConeCourse, car: Platform) -> float:
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


def _result(course: ConeCourse, car: Platform, speed_kmh: float, drive: Drive) -> Result:
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
