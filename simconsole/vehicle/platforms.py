"""Vehicles by the platform name of their profile. A platform's modules load when one is built."""

from simconsole.profiles.vehicle import BallProfile, VehicleProfile
from simconsole.values.platform import Ground, Platform, Pose


def build(profile: VehicleProfile, pose: Pose, ground: Ground) -> Platform:
    """Return the vehicle of `profile`, standing at `pose` (m, rad, of base_link in map) on `ground`."""
    if isinstance(profile, BallProfile):
        from simconsole.vehicle.ball.ball_platform import build_ball

        return build_ball(profile, pose, ground)
    from simconsole.vehicle.car.car_platform import build_car

    return build_car(profile, pose, ground)
