"""Force feedback of a cockpit: what its motor can do, and how the wheel should feel."""

from typing import Annotated, Literal, TypeAlias

from msgspec import Meta, Struct

Torque: TypeAlias = Annotated[float, Meta(ge=0.0, le=30.0)]
Percent: TypeAlias = Annotated[int, Meta(ge=0, le=100)]


class Motor(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Mechanics of the wheel. Take-over detection and the torque estimate rest on these figures."""

    inertia_kgm2: Annotated[float, Meta(ge=0.005, le=0.5)] = 0.05
    """Moment of inertia of rim, shaft and motor about the wheel's axis."""
    damping_nms: Annotated[float, Meta(ge=0.0, le=2.0)] = 0.03
    """Friction torque of the wheel's mechanics per speed of turning."""
    friction_nm: Annotated[float, Meta(ge=0.0, le=2.0)] = 0.2
    """Dry friction torque of the wheel's mechanics."""
    delay_s: Annotated[float, Meta(ge=0.0, le=0.05)] = 0.01
    """Time from a torque that is asked for to the torque at the rim."""
    level_steps: Annotated[int, Meta(ge=10, le=32_767)] = 127
    """How many steps of torque the device distinguishes to one side."""
    identified: Literal["no", "ratios", "weight"] = "no"
    """Whether these figures were measured by `simconsole devices identify`: not, without a weight (only ratios), or
    with one."""


Gain: TypeAlias = Annotated[float, Meta(ge=0.0, le=3.0)]


class Guidance(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Haptic guidance while control is shared: gains, each times the controller's authority over steering.

    Support and feedback are JOAN's; stiffness is a hatchback's in slow bends. A belt-driven wheel needs more authority
    than JOAN's 1 N m/rad to be moved.
    """

    support: Gain = 1.0
    """Level of haptic support: share of the torque that the road's bend needs."""
    feedback: Gain = 1.0
    """Strength of haptic feedback: share of the torque that corrections need."""
    authority_nm_per_rad: Annotated[float, Meta(ge=0.0, le=20.0)] = 6.0
    """Level of haptic authority: torque towards the controller's angle per deviation of the hand wheel."""
    stiffness_nm_per_rad: Annotated[float, Meta(ge=0.0, le=10.0)] = 5.0
    """Stiffness of the car's own steering about the middle, at the hand wheel."""
    damping_nms: Annotated[float, Meta(ge=0.0, le=3.0)] = 0.8
    """Torque against the turning of the wheel while it is guided."""
    slow_s: Annotated[float, Meta(ge=0.05, le=10.0)] = 0.8
    """Changes of the controller's angle slower than this time constant count as the road's bend, faster ones as
    corrections."""
    most_nm: Annotated[float, Meta(ge=0.0, le=10.0)] = 4.0
    """Largest torque of the guidance."""


class ForceFeedback(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How torque is composed and handed to the device. Without this section the wheel has no motor."""

    max_torque_nm: Annotated[float, Meta(ge=0.5, le=30.0)]
    """Torque of the motor at full level, at the rim's axis."""
    level_pushes: Literal["left", "right"] = "left"
    """The side to which a positive level turns the wheel; the sign test of `simconsole devices feel` tells."""
    motor: Motor = Motor()
    """Mechanics of the wheel, on which take-over detection rests; without it the defaults."""
    back_end: Literal["auto", "sdl", "evdev"] = "auto"
    """Library that drives the motor; `auto` takes SDL, or evdev where SDL finds no motor."""
    # What is felt.
    car_share: Annotated[float, Meta(ge=0.0, le=2.0)] = 1.0
    """Share of the real car's torque at the rim that the driver feels."""
    damping_nms: Annotated[float, Meta(ge=0.0, le=2.0)] = 0.08
    """Torque against the turning of the wheel, felt as damping."""
    friction_nm: Torque = 0.1
    """Dry friction that is felt while the car drives."""
    standstill_friction_nm: Torque = 0.5
    """Dry friction that is felt while the car stands."""
    fade_kmh: Annotated[float, Meta(ge=0.5, le=50.0)] = 5.0
    """Below this speed the car's torque fades and friction grows."""
    centring_spring_nm_per_rad: Annotated[float, Meta(ge=0.0, le=20.0)] = 0.0
    """Spring to the middle for a vehicle whose tyres pull the wheel nowhere; it fades as the car's torque does."""
    centring_spring_most_nm: Torque = 2.5
    """Most torque of that spring."""
    road_texture_nm: Annotated[float, Meta(ge=0.0, le=0.5)] = 0.04
    """Torque of the road's texture that is felt; 0 for none."""
    end_stop_nm_per_rad: Annotated[float, Meta(ge=0.0, le=200.0)] = 25.0
    """Stiffness of the end stop that is felt at the car's steering lock."""
    end_stop_margin_deg: Annotated[float, Meta(ge=0.0, le=90.0)] = 20.0
    """How far before the wheel's own lock the end stop begins at the latest."""
    # The wheel that follows the road wheels while the controller drives.
    servo_nm_per_rad: Annotated[float, Meta(ge=0.0, le=100.0)] = 18.0
    """Stiffness with which the wheel follows the road wheels while the controller drives."""
    servo_damping_nms: Annotated[float, Meta(ge=0.0, le=10.0)] = 1.1
    """Damping of the wheel while it follows the road wheels."""
    guidance: Guidance = Guidance()
    """Haptic guidance while control is shared; without it the defaults."""
    # Limits.
    ramp_s: Annotated[float, Meta(ge=0.1, le=5.0)] = 0.7
    """How long the torque takes to full strength when the wheel is switched on."""
    slew_nmps: Annotated[float, Meta(ge=5.0, le=2000.0)] = 150.0
    """Fastest change of the torque."""
    soft_clip_from: Annotated[float, Meta(ge=0.3, le=0.99)] = 0.8
    """Share of the largest torque from which the torque is bent towards that maximum instead of being cut off."""
    # The device.
    update_hz: Annotated[int, Meta(ge=10, le=250)] = 125
    """How often a torque is sent to the device in a second, at most."""
    gain_percent: Percent = 100
    """Gain that is set on the device while the console has the wheel."""
    autocentre_percent: Percent = 0
    """Centring spring of the device itself while the console has the wheel; 0 for none."""
    gain_after_percent: Percent = 100
    """Gain that is left on the device when the console lets go of the wheel."""
    autocentre_after_percent: Annotated[int, Meta(ge=0, le=99)] = 20
    """Centring spring that is left on the device when the console lets go of the wheel."""
    device_damper: Annotated[float, Meta(ge=0.0, le=1.0)] = 0.1
    """Share of the device's own damper that is used, 0 to 1; 0 for none."""
    # Hands. The first is the largest torque of hands that only rest on the rim while the wheel turns under them: their
    # drag (0.8 N m), and their mass in a tight turn at walking pace, where the wheel spins up with 30 rad/s2.
    resting_hands_nm: Annotated[float, Meta(ge=0.0, le=3.0)] = 1.4
    """Largest torque of hands that only rest on the rim while the wheel turns under them; less is no take-over."""
    hands_on_nm: Annotated[float, Meta(ge=0.05, le=5.0)] = 0.25
    """Torque from which hands count as being on the wheel."""
