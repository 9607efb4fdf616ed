"""Whether a wheel's motor is known well enough to turn the wheel by itself while the controller drives. Pure."""

from typing import Final

from simconsole.profiles.force_feedback import ForceFeedback

ACCEL_PER_NM: Final = (4.0, 90.0)
"""Torque over inertia in rad/s2 per N m: a quarter and four times the usual, with a little room."""
FRICTION_RADPS2: Final = 14.0
DELAY_S: Final = 0.036
CURE: Final = "simconsole devices identify"


def servo_refusal(force: ForceFeedback) -> str | None:
    """Return why the motor may not follow the road wheels, as a line that names the key; None where it may."""
    motor = force.motor
    if motor.identified == "no":
        return f"force_feedback.motor.identified: value no: ratios or weight, as {CURE} writes it"
    accel_per_nm, friction = 1.0 / motor.inertia_kgm2, motor.friction_nm / motor.inertia_kgm2
    low, high = ACCEL_PER_NM
    if not low <= accel_per_nm <= high:
        return f"force_feedback.motor.inertia_kgm2: value {motor.inertia_kgm2:g}: {1.0 / high:.3f} to {1.0 / low:.3f}"
    if friction > FRICTION_RADPS2:
        most = FRICTION_RADPS2 * motor.inertia_kgm2
        return f"force_feedback.motor.friction_nm: value {motor.friction_nm:g}: at most {most:.2f} with this inertia"
    if motor.delay_s > DELAY_S:
        return f"force_feedback.motor.delay_s: value {motor.delay_s:g}: at most {DELAY_S:g}"
    return None
