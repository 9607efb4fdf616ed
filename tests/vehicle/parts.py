"""The hatchback's parameters, and one of its tyres, by themselves and in plain Python."""

from simconsole.profiles.files.loader import load
from simconsole.profiles.vehicle import CarProfile
from simconsole.vehicle.car.car_platform import car_parameters
from simconsole.vehicle.car.tyre import Tyre, tyre

CAR = car_parameters(load("vehicles", "hatchback", CarProfile))
LOAD_N = CAR.front.static_n
STEP_S = 0.001


def settled(vx: float, vy: float, omega: float, seconds: float = 1.0, load_n: float = LOAD_N) -> Tyre:
    """Return the tyre after sliding steadily; slip velocities follow from the wheel's own."""
    now = Tyre(0.0, 0.0, 0.0, 0.0, 0.0)
    for _ in range(round(seconds / STEP_S)):
        slip = vx - omega * CAR.front.radius_m
        now = tyre(CAR.front, 1.0, load_n, slip, vy, omega, now.deflection_x_m, now.deflection_y_m, 0.0, 1.0, STEP_S)
    return now
