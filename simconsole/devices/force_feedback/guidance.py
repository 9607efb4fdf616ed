"""Haptic guidance: in SHARED the controller applies torque to the wheel in the person's hands. Pure kernels.

The law of four design choices (van Paassen, Boink, Abbink, Mulder, Mulder 2017, as in tud-hri/joan fdcacontroller.py):
what the controller wants is its reference; support and feedback help to hold it against the car, authority is extra
stiffness towards it. A command carries a single angle, so its slow part is taken as following the road's bend (feed
forward), the rest as the correction (feedback).
"""

from typing import NamedTuple

from simconsole.devices.force_feedback.force_settings import ForceSettings
from simconsole.devices.force_feedback.rim import Rim
from simconsole.values.kernels import clip, kernel
from simconsole.values.signals import Mode


class GuidanceReference(NamedTuple):
    """What the controller asks of the hand wheel."""

    rad: float
    slow_rad: float  # its slow part


@kernel
def guidance_reference(
    road_wheel_rad: float, slow_before_rad: float, mode: float, force: ForceSettings, tick_s: float
) -> GuidanceReference:
    """Return the controller's reference, its slow part through a first-order filter that begins at the reference.

    Args:
        road_wheel_rad: What the controller asks for, as arbitration lets it count.
        slow_before_rad: Slow part of the tick before.
        mode: Outside SHARED the slow part just follows.
        force: Of this drive.
        tick_s: Length of a tick.
    """
    rad = clip(road_wheel_rad * force.hand_wheel_per_road_wheel, -force.end_stop_rad, force.end_stop_rad)
    if mode != Mode.SHARED:
        return GuidanceReference(rad, rad)
    return GuidanceReference(rad, slow_before_rad + (rad - slow_before_rad) * (tick_s / (tick_s + force.guide_slow_s)))


@kernel
def guidance(now: GuidanceReference, rim: Rim, rolling: float, share: float, force: ForceSettings) -> float:
    """Return the guidance in N m, left-positive, bounded so that a person can always override it.

    share * (LoHS k slow + SoHF k (ref - slow) + LoHA (ref - angle) - b rate), k the car's own stiffness.

    Args:
        now: The controller's reference.
        rim: The wheel as estimated.
        rolling: 0 (standing) to 1: the share of the car's own torque that is in force.
        share: The controller's authority over steering, 0 to 1.
        force: Of this drive.
    """
    stiffness = force.guide_stiffness_nm_per_rad * rolling
    forward = force.guide_support * stiffness * now.slow_rad
    back = force.guide_feedback * stiffness * (now.rad - now.slow_rad)
    authority = force.guide_authority_nm_per_rad * (now.rad - rim.rad) - force.guide_damping_nms * rim.radps
    return share * clip(forward + back + authority, -force.guide_most_nm, force.guide_most_nm)
