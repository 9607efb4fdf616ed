"""The tracker drives the house's own car, without bridge and arbitration: what is left is tracking alone."""

import math

import numpy as np

from simconsole.drivers.path_tracker.state_estimator import VehicleMotion
from simconsole.drivers.path_tracker.tracker import Tracker
from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import VehicleProfile
from simconsole.values.host.jit import compiled
from simconsole.values.platform import Ground, Pose
from simconsole.values.signals import VehicleCommand, VehicleState
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT
from simconsole.vehicle.platforms import build
from simconsole.world.course import Course

TICK_HZ = 250
NOTHING = VehicleCommand(*(0.0,) * len(VehicleCommand._fields))
TICKS_PER_COMMAND = 5


def pedals(accel_mps2: float, vehicle: VehicleState) -> tuple[float, float]:
    coast = vehicle.coast_accel_mps2
    if accel_mps2 > coast:
        return min(1.0, (accel_mps2 - coast) / max(0.1, vehicle.full_throttle_accel_mps2 - coast)), 0.0
    return 0.0, min(1.0, (coast - accel_mps2) / max(0.1, coast - vehicle.full_brake_accel_mps2))


def test_a_lap_in_the_hatchback_keeps_the_bars(course: Course) -> None:
    car = build(load("vehicles", "hatchback", VehicleProfile), Pose(0.0, 0.0, 0.0), Ground(1.0, 0.0, 0.0))  # type: ignore[arg-type]
    step, tracker = compiled(car.step), Tracker(course)
    row = np.zeros(PLATFORM_AT + len(car.initial_state))
    row[LAYOUT.vehicle.slice], row[PLATFORM_AT:] = car.initial_vehicle, car.initial_state
    wheel = accel = 0.0
    lateral: list[float] = []
    tick = 0
    while (tracker.s_m or 0.0) < course.length_m:
        vehicle = VehicleState(*row[LAYOUT.vehicle.slice].tolist())
        if tick % TICKS_PER_COMMAND == 0:
            motion = (vehicle.vx_mps, vehicle.vy_mps, vehicle.yaw_rate_radps)
            answer = tracker.step(VehicleMotion(vehicle.x_m, vehicle.y_m, vehicle.yaw_rad, *motion))
            wheel, accel = answer.road_wheel_rad, answer.accel_mps2
            lateral.append(tracker.lateral_m)
        throttle, brake = pedals(accel, vehicle)
        after = row.copy()
        after[LAYOUT.command.slice] = NOTHING._replace(
            road_wheel_rad=wheel, throttle=throttle, brake=brake, gear=1.0, automatic=1.0
        )
        step(row, after, car.parameters, car.ground, 1000 // TICK_HZ)
        row, tick = after, tick + 1
        assert tick < 300 * TICK_HZ, "the lap takes too long"
    errors = np.array(lateral)
    rms_m = math.sqrt(float(np.mean(errors**2)))
    print(f"measured: RMS {100.0 * rms_m:.3f} cm, max {100.0 * np.abs(errors).max():.2f} cm")
    assert rms_m <= 0.0012, "the controller's model of the car is no longer the car's"
    assert float(np.abs(errors).max()) <= 0.01
    assert course.length_m / (tick / TICK_HZ) > 35.0 / 3.6
