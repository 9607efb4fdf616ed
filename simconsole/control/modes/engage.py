"""Whether autonomy may be engaged now, and if not, why not. Names and defaults as Autoware's engage limits."""

from typing import Final

from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.person import Person
from simconsole.values.kernels import kernel
from simconsole.values.signals import Link, Mode, Reason, RemoteCommand, RemoteKind, VehicleState

GRANTED: Final = 0.0


@kernel
def engage_refusal(
    mode: float,
    person: Person,
    link: Link,
    remote: RemoteCommand,
    offered_road_wheel_rad: float,
    road_wheel_rad: float,
    vehicle: VehicleState,
    settings: ControlSettings,
) -> float:
    """Return 0 if autonomy may be engaged, else the `Reason` that refuses it. A state that is not finite refuses.

    Args:
        mode: The mode that would be left; after a fault commands must have been good for longer.
        person: Must be present and off the brake, unless the drive needs no person.
        link: Must be fresh and stable.
        remote: The command; its speed is compared with the vehicle's where it commands one.
        offered_road_wheel_rad: Where the command would put the road wheels ...
        road_wheel_rad: ... and where they are commanded now.
        vehicle: State after the tick before.
        settings: Limits.
    """
    if settings.person_required > 0.0 and person.trusted == 0.0:
        return Reason.REFUSED_NOT_ARMED
    if link.fresh == 0.0 or link.invalid > 0.0:
        return Reason.REFUSED_NO_COMMAND
    well = mode in (Mode.PARKED, Mode.MANUAL, Mode.SHARED, Mode.AUTONOMOUS)
    if link.fresh_ticks < (settings.engage_stable_ticks if well else settings.reengage_stable_ticks):
        return Reason.REFUSED_NOT_STABLE
    if person.brake >= settings.brake_override:
        return Reason.REFUSED_BRAKE_PRESSED
    if not abs(vehicle.vx_mps) <= settings.engage_speed_max_mps:
        return Reason.REFUSED_TOO_FAST
    if not abs(vehicle.ay_mps2) <= settings.engage_lateral_accel_mps2:
        return Reason.REFUSED_LATERAL_ACCELERATION
    speed_commanded = remote.kind in (RemoteKind.SPEED, RemoteKind.TWIST)
    if speed_commanded and abs(remote.speed_mps - vehicle.vx_mps) > settings.engage_speed_deviation_mps:
        return Reason.REFUSED_DEVIATION
    if abs(vehicle.vx_mps) < settings.engage_deviation_speed_mps:
        return GRANTED
    if abs(offered_road_wheel_rad - road_wheel_rad) > settings.engage_road_wheel_deviation_rad:
        return Reason.REFUSED_DEVIATION
    return GRANTED
