"""Force feedback of a cockpit: what its motor can do, and how the wheel should feel."""

from typing import Annotated, Literal, TypeAlias

from msgspec import Meta, Struct

Torque: TypeAlias = Annotated[float, Meta(ge=0.0, le=30.0)]
Percent: TypeAlias = Annotated[int, Meta(ge=0, le=100)]


class Motor(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Mechanics of the wheel. Take-over detection and the torque estimate rest on these figures."""

    inertia_kgm2: Annotated[float, Meta(ge=0.005, le=0.5)] = 0.05
    damping_nms: Annotated[float, Meta(ge=0.0, le=2.0)] = 0.03
    friction_nm: Annotated[float, Meta(ge=0.0, le=2.0)] = 0.2
    delay_s: Annotated[float, Meta(ge=0.0, le=0.05)] = 0.01
    level_steps: Annotated[int, Meta(ge=10, le=32_767)] = 127
    identified: Literal["no", "ratios", "weight"] = "no"  # by `simconsole devices identify`, with a weight or without


Gain: TypeAlias = Annotated[float, Meta(ge=0.0, le=3.0)]


class Guidance(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Haptic guidance while control is shared: gains, each times the controller's authority over steering.

    Support and feedback are JOAN's; stiffness is a hatchback's in slow bends. A belt-driven wheel needs more authority
    than JOAN's 1 N m/rad to be moved.
    """

    support: Gain = 1.0  # level of haptic support: of the torque that the road's bend needs
    feedback: Gain = 1.0  # strength of haptic feedback: of the torque that corrections need
    authority_nm_per_rad: Annotated[float, Meta(ge=0.0, le=20.0)] = 6.0  # level of haptic authority
    stiffness_nm_per_rad: Annotated[float, Meta(ge=0.0, le=10.0)] = 5.0  # of the car's steering about the middle
    damping_nms: Annotated[float, Meta(ge=0.0, le=3.0)] = 0.8
    slow_s: Annotated[float, Meta(ge=0.05, le=10.0)] = 0.8  # slower than this is the road's bend
    most_nm: Annotated[float, Meta(ge=0.0, le=10.0)] = 4.0


class ForceFeedback(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How torque is composed and handed to the device. Without this section the wheel has no motor."""

    max_torque_nm: Annotated[float, Meta(ge=0.5, le=30.0)]
    level_pushes: Literal["left", "right"] = "left"  # where a positive level turns the wheel: a sign test tells
    motor: Motor = Motor()
    back_end: Literal["auto", "sdl", "evdev"] = "auto"  # auto: SDL, or evdev where SDL finds no motor
    # What is felt.
    car_share: Annotated[float, Meta(ge=0.0, le=2.0)] = 1.0  # of the torque at the rim of the real car
    damping_nms: Annotated[float, Meta(ge=0.0, le=2.0)] = 0.08
    friction_nm: Torque = 0.1
    standstill_friction_nm: Torque = 0.5
    fade_kmh: Annotated[float, Meta(ge=0.5, le=50.0)] = 5.0  # below it the car's torque fades, friction grows
    # A spring to the middle for a vehicle whose tyres pull the wheel nowhere; it fades as the car's torque does.
    centring_spring_nm_per_rad: Annotated[float, Meta(ge=0.0, le=20.0)] = 0.0
    centring_spring_most_nm: Torque = 2.5
    road_texture_nm: Annotated[float, Meta(ge=0.0, le=0.5)] = 0.04
    end_stop_nm_per_rad: Annotated[float, Meta(ge=0.0, le=200.0)] = 25.0
    end_stop_margin_deg: Annotated[float, Meta(ge=0.0, le=90.0)] = 20.0  # before the wheel's own lock
    # The wheel that follows the road wheels while the controller drives.
    servo_nm_per_rad: Annotated[float, Meta(ge=0.0, le=100.0)] = 18.0
    servo_damping_nms: Annotated[float, Meta(ge=0.0, le=10.0)] = 1.1
    guidance: Guidance = Guidance()
    # Limits.
    ramp_s: Annotated[float, Meta(ge=0.1, le=5.0)] = 0.7
    slew_nmps: Annotated[float, Meta(ge=5.0, le=2000.0)] = 150.0
    soft_clip_from: Annotated[float, Meta(ge=0.3, le=0.99)] = 0.8
    # The device.
    update_hz: Annotated[int, Meta(ge=10, le=250)] = 125
    gain_percent: Percent = 100
    autocentre_percent: Percent = 0
    gain_after_percent: Percent = 100  # what is left behind when the console lets go of the wheel
    autocentre_after_percent: Annotated[int, Meta(ge=0, le=99)] = 20
    device_damper: Annotated[float, Meta(ge=0.0, le=1.0)] = 0.1  # share of the device's own damper; 0: none
    # Hands. The first is the largest torque of hands that only rest on the rim while the wheel turns under them: their
    # drag (0.8 N m), and their mass in a tight turn at walking pace, where the wheel spins up with 30 rad/s2.
    resting_hands_nm: Annotated[float, Meta(ge=0.0, le=3.0)] = 1.4
    hands_on_nm: Annotated[float, Meta(ge=0.05, le=5.0)] = 0.25
