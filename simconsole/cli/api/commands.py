"""What a controller written as a function may answer: the kinds of command that the bridge knows, in SI units.

Angles are left-positive, of the road wheels; a positive acceleration is faster, in reverse too.
"""

from typing import Final

from simconsole.values.signals import NO_COMMAND, RemoteCommand, RemoteKind

Command = RemoteCommand
"""A command; its sequence number and age are the console's to fill in."""

_FORWARDS: Final = 1.0


def accelerate(accel_mps2: float, road_wheel_rad: float = 0.0, *, reverse: bool = False) -> Command:
    """Ask for an acceleration in m/s2 and a road-wheel angle in rad; the console works pedals and gears."""
    return _command(RemoteKind.ACCELERATION, reverse, accel_mps2=accel_mps2, road_wheel_rad=road_wheel_rad)


def hold_speed(speed_mps: float, road_wheel_rad: float = 0.0) -> Command:
    """Ask for a speed in m/s, negative backwards, and a road-wheel angle in rad."""
    return _command(RemoteKind.SPEED, False, speed_mps=speed_mps, road_wheel_rad=road_wheel_rad)


def twist(speed_mps: float, yaw_rate_radps: float) -> Command:
    """Ask for a speed in m/s and a yaw rate in rad/s, as `cmd_vel` does; robots turn in place by it."""
    return _command(RemoteKind.TWIST, False, speed_mps=speed_mps, yaw_rate_radps=yaw_rate_radps)


def actuate(throttle: float, brake: float, road_wheel_rad: float = 0.0, *, reverse: bool = False) -> Command:
    """Press the pedals, 0 to 1 each, and turn the road wheels to an angle in rad."""
    return _command(RemoteKind.ACTUATION, reverse, throttle=throttle, brake=brake, road_wheel_rad=road_wheel_rad)


def go_to(x_m: float, y_m: float, yaw_rad: float = 0.0, speed_mps: float = 0.0) -> Command:
    """Ask for a pose in map, which a ball follows; a car does not."""
    return _command(RemoteKind.POSE, False, x_m=x_m, y_m=y_m, yaw_rad=yaw_rad, speed_mps=speed_mps)


def _command(kind: RemoteKind, reverse: bool, **values: float) -> Command:
    return NO_COMMAND._replace(kind=float(kind), direction=-_FORWARDS if reverse else _FORWARDS, **values)
