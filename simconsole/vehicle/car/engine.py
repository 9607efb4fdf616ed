"""Engine torque: a map of ramps, an idle governor that can hold little, a limiter, a starter."""

from typing import NamedTuple

from simconsole.values.kernels import clip, kernel
from simconsole.vehicle.car.parameters import EngineParameters


class EngineDrive(NamedTuple):
    """Combustion torque of this step. Friction is separate: it acts even without combustion."""

    torque_nm: float
    friction_nm: float
    running: float


@kernel
def ramp(speed_radps: float, from_radps: float, slope_nms: float) -> float:
    """Return one ramp of the torque map."""
    return (speed_radps - from_radps) * slope_nms if speed_radps > from_radps else 0.0


@kernel
def full_torque(p: EngineParameters, speed_radps: float) -> float:
    """Return the net torque at full throttle in N m (brake torque, friction already taken off), limiter included."""
    torque = (
        ramp(speed_radps, p.ramp_1_radps, p.ramp_1_nms)
        + ramp(speed_radps, p.ramp_2_radps, p.ramp_2_nms)
        + ramp(speed_radps, p.ramp_3_radps, p.ramp_3_nms)
        + ramp(speed_radps, p.ramp_4_radps, p.ramp_4_nms)
        + ramp(speed_radps, p.ramp_5_radps, p.ramp_5_nms)
        + ramp(speed_radps, p.ramp_6_radps, p.ramp_6_nms)
        + ramp(speed_radps, p.ramp_7_radps, p.ramp_7_nms)
        + ramp(speed_radps, p.ramp_8_radps, p.ramp_8_nms)
    )
    friction = engine_friction(p, speed_radps)
    cut = clip((p.limit_radps - speed_radps) * p.per_limit_band_radps, 0.0, 1.0)
    return (torque + friction) * cut - friction


@kernel
def engine_friction(p: EngineParameters, speed_radps: float) -> float:
    """Return the friction and pumping torque in N m, always positive."""
    return p.drag_nm + p.drag_nms * abs(speed_radps)


@kernel
def above_idle(p: EngineParameters, speed_radps: float) -> float:
    """Return 0 at idle speed and below, 1 where a closed throttle gives the full engine brake: half as fast again."""
    return clip((speed_radps - p.idle_radps) * (2.0 * p.per_idle_radps), 0.0, 1.0)


@kernel
def idle_torque(p: EngineParameters, speed_radps: float, friction_nm: float) -> float:
    """Return the combustion torque at closed throttle: the friction at idle speed, more below, less and less above."""
    below = p.idle_radps - speed_radps
    if below <= 0.0:
        return friction_nm * (1.0 - above_idle(p, speed_radps))
    return clip(friction_nm + p.idle_gain_nms * below, 0.0, p.idle_max_nm)


@kernel
def net_torque(p: EngineParameters, speed_radps: float, running: float, throttle: float) -> float:
    """Return what the engine gives at its flywheel at this speed and throttle, friction taken off; 0 if it is off."""
    if running == 0.0:
        return 0.0
    friction = engine_friction(p, speed_radps)
    closed = idle_torque(p, speed_radps, friction)
    return closed + throttle * (full_torque(p, speed_radps) + friction - closed) - friction


@kernel
def engine_drive(
    p: EngineParameters, speed_radps: float, running: float, throttle: float, driveline_open: bool
) -> EngineDrive:
    """Return the torque of one step.

    Below `stall_radps` a running engine dies; then its compression adds to its friction. A dead engine is cranked by
    the starter as long as the driveline is open (clutch pressed, or no gear engaged), and burns again from
    `fire_radps`, also when the wheels turn it: there is no ignition key.
    """
    friction = engine_friction(p, speed_radps)
    if speed_radps < (p.stall_radps if running != 0.0 else p.fire_radps):
        return EngineDrive(p.starter_nm if driveline_open else 0.0, friction + p.hold_nm, 0.0)
    closed = idle_torque(p, speed_radps, friction)
    return EngineDrive(closed + throttle * (full_torque(p, speed_radps) + friction - closed), friction, 1.0)
