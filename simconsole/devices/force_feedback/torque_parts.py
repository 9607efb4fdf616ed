"""What the torque of the wheel's motor is made of: the car's, the servo's, the guidance's, the wheel's own effects.

Pure kernels, without a memory.
"""

from typing import Final, NamedTuple

from simconsole.devices.force_feedback.aligning import FAST_MPS, aligning, share_of, stiffness
from simconsole.devices.force_feedback.force_settings import ForceSettings
from simconsole.devices.force_feedback.guidance import GuidanceReference, guidance
from simconsole.devices.force_feedback.rim import Rim
from simconsole.values.kernels import clip, kernel
from simconsole.values.signals import VehicleState
from simconsole.values.trigonometry import sin

FRICTION_RADPS: Final = 1.0
"""Rate over which simulated friction changes its sign; a steeper change would chatter due to the motor's delay."""
END_STOP_NMS: Final = 1.0
LONG_WAVE_RADPM: Final = 3.7
SHORT_WAVE_RADPM: Final = 9.97
"""Two waves of rough road, 1.7 m and 0.63 m long: 6 to 32 Hz between 36 and 72 km/h, incommensurable."""


class TorqueParts(NamedTuple):
    """What the torque is made of."""

    car_nm: float
    servo_nm: float
    guide_nm: float
    effects_nm: float  # damping, friction, end stop, road
    car_share: float  # of the car's torque that the motor bears


@kernel
def servo(target: Rim, rim: Rim, force: ForceSettings) -> float:
    """Return the torque in N m that brings the rim to a target that moves itself (PD on the angle)."""
    return force.servo_nm_per_rad * (target.rad - rim.rad) + force.servo_damping_nms * (target.radps - rim.radps)


@kernel
def soft_clip(torque_nm: float, force: ForceSettings) -> float:
    """Return the torque below the motor's limit: unchanged up to the knee, then compressed, so that detail is kept.

    Beyond the knee k, with room r above it: k + r x / (r + x) for an excess x; continuous in value and slope.
    """
    knee = force.soft_clip_from * force.max_torque_nm
    size = abs(torque_nm)
    if size <= knee:
        return torque_nm
    room = force.max_torque_nm - knee
    bent = knee + room * (size - knee) / (room + size - knee)
    return bent if torque_nm > 0.0 else -bent


@kernel
def end_stop(rim: Rim, force: ForceSettings) -> float:
    """Return the spring at the lock: nothing inside it, and no pull back out of it when the rim already returns."""
    beyond = abs(rim.rad) - force.end_stop_rad
    if beyond <= 0.0:
        return 0.0
    side = 1.0 if rim.rad > 0.0 else -1.0
    outwards = side * rim.radps
    push = force.end_stop_nm_per_rad * beyond + (END_STOP_NMS * outwards if outwards > 0.0 else 0.0)
    return -side * push


@kernel
def centring_spring(answered_rad: float, force: ForceSettings) -> float:
    """Return the spring to the middle in N m that stands in for tyres which pull the wheel nowhere."""
    return clip(
        -force.centring_spring_nm_per_rad * answered_rad, -force.centring_spring_most_nm, force.centring_spring_most_nm
    )


@kernel
def road(vehicle: VehicleState, rolling: float, force: ForceSettings) -> float:
    """Return the torque of the road's texture: a function of distance only, so it rests with the car and replays."""
    waves = sin(LONG_WAVE_RADPM * vehicle.distance_m) + sin(SHORT_WAVE_RADPM * vehicle.distance_m)
    return 0.5 * force.texture_nm * rolling * waves


@kernel
def torque_parts(
    follows: bool,
    target: Rim,
    rim: Rim,
    vehicle: VehicleState,
    asked: GuidanceReference,
    share: float,
    by_hand: float,
    answered_rad: float,
    swing_radps: float,
    force: ForceSettings,
) -> TorqueParts:
    """Return the parts of the torque, unlimited.

    Args:
        follows: The wheel is to follow the road wheels; else it is the car's.
        target: Where the road wheels have it.
        rim: The wheel when this torque acts on it.
        vehicle: The vehicle after this tick.
        asked: What the controller asks of the hand wheel.
        share: How much of its guidance there is, 0 to 1.
        by_hand: How much of the road wheels' angle is the hand wheel's, 0 to 1; the rest is the controller's.
        answered_rad: Of that part, what the car's tyres have answered, at the hand wheel.
        swing_radps: The car's yaw rate, less its slow part.
        force: Of this drive.
    """
    speed = abs(vehicle.vx_mps)
    rolling = speed / (speed + force.fade_mps)
    texture = road(vehicle, rolling, force)
    if follows:
        return TorqueParts(0.0, servo(target, rim, force), 0.0, texture, 0.0)
    friction = force.friction_nm + (1.0 - rolling) * force.standstill_friction_nm
    drag = -force.damping_nms * rim.radps - friction * rim.radps / (abs(rim.radps) + FRICTION_RADPS)
    stiff = force.car_share * rolling * stiffness(speed, force)
    fast = speed / FAST_MPS
    bears = share_of(stiff, fast, force)
    felt = by_hand * bears
    car = aligning(
        felt * force.car_share * rolling * (vehicle.hand_wheel_torque_nm + centring_spring(answered_rad, force)),
        by_hand * rim.rad - answered_rad,
        swing_radps,
        rim.radps,
        felt * stiff,
        fast,
        share,
        force,
    )
    guide = guidance(asked, rim, rolling, share, force)
    return TorqueParts(car, 0.0, guide, drag + end_stop(rim, force) + texture, bears)
