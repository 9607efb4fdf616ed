"""How stiff a car holds its hand wheel about the middle: from its tyres, trails and steering assistance. Pure.

For a way as short as a swing's the steering's own friction is a spring, too; of a car without trail it is all there is.
"""

from typing import Final

from simconsole.profiles.vehicle import CarProfile, VehicleProfile
from simconsole.values.platform import NO_STIFFNESS, RimStiffness
from simconsole.values.units import RAD_PER_DEG

SMALL_RAD: Final = 0.1 * RAD_PER_DEG
"""Angle of the road wheels to either side over which the stiffness is taken."""


def rim_stiffness(profile: VehicleProfile) -> RimStiffness:
    """Return the stiffness of a vehicle's steering on level, dry ground, of tyres or friction, whichever is stiffer.

    It is `NO_STIFFNESS` where the hand wheel feels nothing.
    """
    if not isinstance(profile, CarProfile):
        return NO_STIFFNESS
    from simconsole.vehicle.car.car_platform import car_parameters
    from simconsole.vehicle.car.steering import hand_wheel_torque

    car = car_parameters(profile)
    front, steering = car.front, car.steering
    stiff_n_per_rad = 2.0 * front.stiffness_y_per_m / front.decay_y_per_m * front.static_n
    moment_nm = stiff_n_per_rad * (steering.caster_trail_m + steering.pneumatic_trail_m) * SMALL_RAD
    across_rad = 2.0 * SMALL_RAD * profile.steering.ratio
    friction_nm_per_rad = steering.hand_friction_nm * steering.per_friction_rad / profile.steering.ratio

    def slope(speed_mps: float) -> float:
        left_nm, right_nm = (hand_wheel_torque(steering, side * moment_nm, 0.0, speed_mps, 0.0) for side in (1.0, -1.0))
        return max((left_nm - right_nm) / across_rad, friction_nm_per_rad)

    return RimStiffness(
        at_0mps=slope(0.0),
        at_12mps=slope(12.0),
        at_24mps=slope(24.0),
        at_36mps=slope(36.0),
        at_48mps=slope(48.0),
        relaxation_m=1.0 / front.decay_y_per_m,
        pulls=float(moment_nm > 0.0),
    )
