"""Vehicles by the platform name of their profile. A platform's modules load when one is built."""

from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.vehicle import BallProfile, OwnProfile, VehicleProfile
from simconsole.values.platform import NO_OBSTACLES, Ground, Obstacles, Platform, Pose


def build(
    profile: VehicleProfile, pose: Pose, ground: Ground, obstacles: Obstacles = NO_OBSTACLES, others: int = 0
) -> Platform:
    """Return the vehicle of `profile`, standing at `pose` (m, rad, of base_link in map) on `ground`.

    Only robots run into `obstacles`, and into as many `others` as the session has beside this one.

    Raises:
        ProfileError: a vehicle of another package is not there, or refuses its parameters.
    """
    if isinstance(profile, BallProfile):
        from simconsole.vehicle.ball.ball_platform import build_ball

        return build_ball(profile, pose, ground)
    if isinstance(profile, TurtlebotProfile):
        from simconsole.vehicle.turtlebot.turtlebot_platform import build_turtlebot

        return build_turtlebot(profile, pose, ground, obstacles, others)
    if isinstance(profile, OwnProfile):
        from simconsole.vehicle.registered import build_own

        return build_own(profile, pose, ground)
    from simconsole.vehicle.car.car_platform import build_car

    return build_car(profile, pose, ground)
