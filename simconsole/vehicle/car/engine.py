"""Engine torque: a map of ramps, an idle governor that can hold little, a limiter, a starter."""

from typing import NamedTuple

from simconsole.values.kernels import clip, kernel
from simconsole.vehicle.car.parameters import EngineParameters


class EngineTorques(NamedTuple):
    """What the engine can give at one speed, in N m."""

    friction_nm: float
    closed_nm: float  # of combustion, at closed throttle
    full_nm: float  # at the flywheel, at full throttle


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
def torques_at(p: EngineParameters, speed_radps: float) -> EngineTorques:
    """Return what the engine can give at a speed."""
    friction = engine_friction(p, speed_radps)
    return EngineTorques(friction, idle_torque(p, speed_radps, friction), full_torque(p, speed_radps))


@kernel
def combustion_torque(can: EngineTorques, throttle: float) -> float:
    """Return the torque of combustion at a throttle, in N m."""
    return can.closed_nm + throttle * (can.full_nm + can.friction_nm - can.closed_nm)


@kernel
def net_torque(can: EngineTorques, running: float, throttle: float) -> float:
    """Return what the engine gives at its flywheel at a throttle, friction taken off; 0 if it is off."""
    return combustion_torque(can, throttle) - can.friction_nm if running != 0.0 else 0.0


@kernel
def engine_drive(
    p: EngineParameters,
    can: EngineTorques,
    speed_radps: float,
    running: float,
    throttle: float,
    driveline_open: bool,
) -> EngineDrive:
    """Return the torque of one step; `can` is what the engine can give at this speed.

    Below `stall_radps` a running engine dies; then its compression adds to its friction. A dead engine is cranked by
    the starter as long as the driveline is open (clutch pressed, or no gear engaged), and burns again from
    `fire_radps`, also when the wheels turn it: there is no ignition key.
    """
    if speed_radps < (p.stall_radps if running != 0.0 else p.fire_radps):
        return EngineDrive(p.starter_nm if driveline_open else 0.0, can.friction_nm + p.hold_nm, 0.0)
    return EngineDrive(combustion_torque(can, throttle), can.friction_nm, 1.0)
