"""The controller's linear single-track model of a car, from the car's profile."""

from typing import Final

from simconsole.drivers.path_tracker.tracker_settings import HATCHBACK, CarModel
from simconsole.profiles.parts.chassis import AxleProfile
from simconsole.profiles.vehicle import CarProfile, VehicleProfile
from simconsole.values.units import RAD_PER_DEG, STANDARD_GRAVITY_MPS2

AT_WORK: Final = 7.0 / 8.0
"""What is left of a tyre's stiffness at small slip in curves of 2.5 m/s2: measured with the hatchback as the value with
which it follows random courses best, without noise and delay (RMS 0.08 to 0.10 cm; 0.12 to 0.14 cm with 11/12). It is
the light van's, too."""


_RACK_S: Final = 0.01
"""The rack follows its own lag, and the tyres' relaxation comes on top: measured as above."""


def car_model(vehicle: VehicleProfile) -> CarModel:
    """Return the model of a car; a vehicle without tyres is steered as the hatchback."""
    if not isinstance(vehicle, CarProfile):
        return HATCHBACK
    body, steering = vehicle.body, vehicle.steering
    front_m = body.wheelbase_m * (1.0 - body.front_mass_share)
    return CarModel(
        mass_kg=body.mass_kg,
        yaw_inertia_kgm2=body.yaw_inertia_kgm2,
        front_m=front_m,
        rear_m=body.wheelbase_m - front_m,
        front_stiffness_nprad=_stiffness(vehicle, vehicle.front, body.front_mass_share),
        rear_stiffness_nprad=_stiffness(vehicle, vehicle.rear, 1.0 - body.front_mass_share),
        steering_lag_s=steering.lag_s + _RACK_S,
        max_road_wheel_rad=steering.max_road_wheel_deg * RAD_PER_DEG,
    )


def _stiffness(vehicle: CarProfile, axle: AxleProfile, share: float) -> float:
    """Return the cornering stiffness of both wheels of an axle at rest, in N/rad."""
    load = vehicle.body.mass_kg * STANDARD_GRAVITY_MPS2 * share
    return AT_WORK * axle.cornering_stiffness_per_rad * load
