"""Commands of the controller to one request: acceleration, speed, twist, actuation and pose mean different things.

Longitudinal figures are along the commanded direction of travel: positive is faster, also in reverse, as Autoware's
pid_longitudinal_controller publishes them. A vehicle that rolls the wrong way is braked first.
"""

from typing import Final, NamedTuple

from simconsole.control.requests.angles import limited_angle
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.longitudinal import Pedals, finite_or, integrate, pedals_for
from simconsole.control.requests.stops import travel_direction
from simconsole.values.kernels import clip, is_finite, kernel
from simconsole.values.signals import RemoteCommand, RemoteKind, VehicleState
from simconsole.values.trigonometry import atan

_MOST_MPS: Final = 100.0
_MOST_MPS2: Final = 20.0
_MOST_RADPS: Final = 20.0
_MOST_RAD: Final = 2.0
_STEERABLE_MPS: Final = 0.5  # slower than this a twist's curvature is taken as if driven at this speed
_STANDING_MPS: Final = 0.05  # a commanded speed below this means standstill
_CLOSING_MPS2: Final = 0.5  # least deceleration towards a commanded standstill: proportional control alone only creeps
_WRONG_WAY_MPS: Final = 0.5


class RemoteRequest(NamedTuple):
    """What the remote side asks for."""

    road_wheel_rad: float
    throttle: float
    brake: float
    direction: float  # 1 drive, -1 reverse, 0 neutral
    speed_integral_mps2: float


@kernel
def command_finite(remote: RemoteCommand) -> bool:
    """Return whether every field of the command is finite: one that is not makes the whole command invalid."""
    for value in remote:  # noqa: SIM110  (numba has no `all`)
        if not is_finite(value):
            return False
    return True


@kernel
def known_kind(kind: float) -> bool:
    """Return whether the command's kind is one that can be turned into a request."""
    return kind in (RemoteKind.ACCELERATION, RemoteKind.SPEED, RemoteKind.TWIST, RemoteKind.ACTUATION, RemoteKind.POSE)


@kernel
def implausible(remote: RemoteCommand, vehicle: VehicleState, settings: ControlSettings) -> bool:
    """Return whether a finite command asks for an implausible lateral acceleration at the present speed.

    An angle by the kinematic single track, as the gate judges it; a twist says its yaw rate itself. Full lock is
    plausible at walking pace, and an error of the sender at speed.
    """
    most_mps2 = settings.implausible_lateral_accel_mps2
    if remote.kind == RemoteKind.TWIST:
        speed_mps = clip(finite_or(vehicle.vx_mps, 0.0), -_MOST_MPS, _MOST_MPS)
        return abs(speed_mps * remote.yaw_rate_radps) > most_mps2
    return limited_angle(remote.road_wheel_rad, most_mps2, vehicle, settings) != remote.road_wheel_rad


@kernel
def remote_request(
    remote: RemoteCommand,
    held_road_wheel_rad: float,
    integral_mps2: float,
    vehicle: VehicleState,
    settings: ControlSettings,
    tick_s: float,
) -> RemoteRequest:
    """Return what a finite command asks for.

    Args:
        remote: A command that `command_finite` has passed.
        held_road_wheel_rad: The angle in force, kept where the command says nothing about steering.
        integral_mps2: Of the longitudinal controller, from the tick before.
        vehicle: State after the tick before; its fields may be anything.
        settings: Gains and limits.
        tick_s: Length of a tick in s.
    """
    direction = commanded_direction(remote)
    if remote.kind == RemoteKind.ACTUATION:
        brake = clip(remote.brake, 0.0, 1.0)
        throttle = 0.0 if brake >= settings.brake_override else clip(remote.throttle, 0.0, 1.0)
        return RemoteRequest(clip(remote.road_wheel_rad, -_MOST_RAD, _MOST_RAD), throttle, brake, direction, 0.0)
    if remote.kind == RemoteKind.POSE or (remote.kind == RemoteKind.TWIST and settings.turns_in_place > 0.0):
        # Targets bypass steering and pedals (control/gate.py): a platform that reads them has neither.
        return RemoteRequest(0.0, 0.0, 0.0, direction, 0.0)
    road_wheel_rad = clip(remote.road_wheel_rad, -_MOST_RAD, _MOST_RAD)
    if remote.kind == RemoteKind.TWIST:
        road_wheel_rad = twist_road_wheel(remote.speed_mps, remote.yaw_rate_radps, held_road_wheel_rad, settings)
    pedals, integral = _pedals(remote, direction, integral_mps2, vehicle, settings, tick_s)
    return RemoteRequest(road_wheel_rad, pedals.throttle, pedals.brake, direction, integral)


@kernel
def commanded_direction(remote: RemoteCommand) -> float:
    """Return 1 (drive), -1 (reverse: by gear or, for speed and twist, by a negative speed) or 0 (neutral)."""
    if remote.direction == 0.0:
        return 0.0
    backward = (remote.kind == RemoteKind.SPEED or remote.kind == RemoteKind.TWIST) and remote.speed_mps < 0.0
    return -1.0 if backward or remote.direction < 0.0 else 1.0


@kernel
def twist_road_wheel(
    speed_mps: float, yaw_rate_radps: float, held_road_wheel_rad: float, settings: ControlSettings
) -> float:
    """Return the road-wheel angle whose curvature turns at `yaw_rate_radps` when driven at `speed_mps`.

    Kinematic single track, tan(angle) = wheelbase * yaw rate / speed. A standing car cannot turn: the angle is held.
    """
    if abs(speed_mps) < _STANDING_MPS:
        return held_road_wheel_rad
    if speed_mps > 0.0:
        speed = clip(speed_mps, _STEERABLE_MPS, _MOST_MPS)
    else:
        speed = clip(speed_mps, -_MOST_MPS, -_STEERABLE_MPS)
    return atan(settings.wheelbase_m * clip(yaw_rate_radps, -_MOST_RADPS, _MOST_RADPS) / speed)


@kernel
def _pedals(
    remote: RemoteCommand,
    direction: float,
    integral_mps2: float,
    vehicle: VehicleState,
    settings: ControlSettings,
    tick_s: float,
) -> tuple[Pedals, float]:
    travel = direction if direction != 0.0 else travel_direction(vehicle)
    along_mps = clip(finite_or(travel * vehicle.vx_mps, 0.0), -_MOST_MPS, _MOST_MPS)
    if along_mps < -_WRONG_WAY_MPS:
        return pedals_for(-settings.stop_decel_mps2, -travel, vehicle, settings), 0.0
    by_speed = remote.kind != RemoteKind.ACCELERATION
    speed_mps = clip(abs(remote.speed_mps), 0.0, _MOST_MPS)
    stand = speed_mps < _STANDING_MPS if by_speed else remote.accel_mps2 <= 0.0
    if stand and abs(along_mps) < settings.standstill_speed_mps:
        return Pedals(0.0, settings.hold_brake), 0.0
    wanted = clip(remote.accel_mps2, -_MOST_MPS2, _MOST_MPS2)
    error = wanted - clip(finite_or(travel * vehicle.ax_mps2, wanted), -_MOST_MPS2, _MOST_MPS2)
    free = True
    if by_speed:
        error = settings.speed_gain_per_s * (speed_mps - along_mps)
        limit = settings.accel_max_mps2
        if remote.accel_mps2 > 0.0:
            limit = clip(remote.accel_mps2, 0.0, limit)
        wanted = clip(error, -settings.decel_max_mps2, limit)
        free = wanted == error
        if stand:
            wanted = clip(wanted, -settings.decel_max_mps2, -_CLOSING_MPS2)
    pedals = pedals_for(wanted + integral_mps2, travel, vehicle, settings)
    if direction == 0.0 and pedals.throttle > 0.0:
        return Pedals(0.0, 0.0), 0.0
    if not free or pedals.throttle >= 1.0 or pedals.brake >= 1.0:
        return pedals, integral_mps2
    return pedals, integrate(integral_mps2, error, settings, tick_s)
