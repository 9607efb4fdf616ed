"""Test manoeuvres as descriptions: what is driven, not how; simconsole.evaluation.manoeuvres drives and evaluates them.

The default values are those of the standard that is named with each kind.
"""

from typing import Annotated, Literal, TypeAlias

from msgspec import Meta

from simconsole.profiles.session import Section

Kmh: TypeAlias = Annotated[float, Meta(ge=5.0, le=250.0)]
HandDeg: TypeAlias = Annotated[float, Meta(ge=1.0, le=500.0)]
DegPerS: TypeAlias = Annotated[float, Meta(ge=1.0, le=1500.0)]
Frequency: TypeAlias = Annotated[float, Meta(ge=0.05, le=5.0)]

SINES_HZ = (0.2, 0.4, 0.6, 0.8, 1.0, 1.25, 1.5, 2.0)
"""Frequencies of the sinusoidal input; ISO 7401 asks for 0.2 to 2 Hz."""


class SteadyCircle(Section, frozen=True, kw_only=True, tag_field="kind", tag="steady_state_circle"):
    """ISO 4138, constant speed with slowly increasing steering, up to the limit of grip."""

    speed_kmh: Kmh = 80.0
    """Speed that is kept during the whole test."""
    hand_wheel_degps: DegPerS = 13.5
    """How fast the hand wheel is turned further."""
    fit_from_mps2: Annotated[float, Meta(ge=0.1, le=12.0)] = 1.0
    """Lateral acceleration from which the gradients are fitted."""
    fit_to_mps2: Annotated[float, Meta(ge=0.2, le=12.0)] = 4.0
    """Lateral acceleration up to which the gradients are fitted."""


class StepSteer(Section, frozen=True, kw_only=True, tag_field="kind", tag="step_steer"):
    """ISO 7401, step input: a fast turn of the hand wheel, then held; the throttle keeps its place."""

    speed_kmh: Kmh = 100.0
    """Speed at which the hand wheel is turned."""
    hand_wheel_deg: HandDeg = 30.0
    """Angle to which the hand wheel is turned."""
    hand_wheel_degps: DegPerS = 500.0
    """How fast the hand wheel is turned."""
    hold_s: Annotated[float, Meta(ge=1.0, le=20.0)] = 4.0
    """How long the hand wheel is held after that."""


class SineWithDwell(Section, frozen=True, kw_only=True, tag_field="kind", tag="sine_with_dwell"):
    """FMVSS 126 (49 CFR 571.126): with ESC from 1.5 A to 270 deg, and once more without it."""

    speed_kmh: Kmh = 80.0
    """Speed at which the steering begins."""
    frequency_hz: Annotated[float, Meta(ge=0.1, le=3.0)] = 0.7
    """Frequency of the sine of the hand wheel."""
    dwell_s: Annotated[float, Meta(ge=0.0, le=2.0)] = 0.5
    """How long the hand wheel is held at its second peak."""
    factors: Annotated[tuple[float, ...], Meta(min_length=1, max_length=30)] = tuple(0.5 * n for n in range(3, 14))
    """Amplitudes of the runs as multiples of A, the hand-wheel angle of 0.3 g in a slowly tightened turn; none goes
    beyond 300 degrees."""
    final_hand_wheel_deg: HandDeg = 270.0
    """Amplitude of the last run, where the factors do not come that far."""
    without_factor: Annotated[float, Meta(ge=0.5, le=10.0)] = 6.5
    """Amplitude of the run without stability control, as a multiple of A."""


class DoubleLaneChange(Section, frozen=True, kw_only=True, tag_field="kind", tag="double_lane_change"):
    """ISO 3888-1 or -2: the highest entry speed at which no corner of the car leaves the lanes, found by halving."""

    course: Literal["iso_3888_1", "iso_3888_2"] = "iso_3888_2"
    """Which of the standard's two courses is driven: 3888-1, or 3888-2 of the obstacle avoidance test."""
    from_kmh: Kmh = 30.0
    """Lowest entry speed that is tried."""
    to_kmh: Kmh = 130.0
    """Highest entry speed that is tried."""
    within_kmh: Annotated[float, Meta(ge=0.1, le=20.0)] = 1.0
    """The search ends when the highest clean entry speed is known this exactly."""


class StraightBraking(Section, frozen=True, kw_only=True, tag_field="kind", tag="straight_braking"):
    """Full braking in a straight line (ISO 21994), with the anti-lock brakes and once more without them.

    The driver keeps to the line with the hand wheel, so that it also serves on split friction.
    """

    speed_kmh: Kmh = 100.0
    """Speed at which the brake is pressed."""
    brake: Annotated[float, Meta(gt=0.0, le=1.0)] = 1.0
    """Share of the brake pedal, 0 to 1."""
    without: bool = True
    """Drive it once more without the anti-lock brakes."""


class CoastDown(Section, frozen=True, kw_only=True, tag_field="kind", tag="coast_down"):
    """Out of gear from one speed to another: air and rolling resistance."""

    from_kmh: Kmh = 100.0
    """Speed at which the car is put out of gear."""
    to_kmh: Kmh = 20.0
    """Speed at which the measurement ends."""


class Weave(Section, frozen=True, kw_only=True, tag_field="kind", tag="weave"):
    """ISO 13674-1: a slow sine of the hand wheel at constant speed; torque at the rim over lateral acceleration."""

    speed_kmh: Kmh = 100.0
    """Speed that is kept during the whole test."""
    frequency_hz: Annotated[float, Meta(ge=0.05, le=1.0)] = 0.2
    """Frequency of the sine of the hand wheel."""
    lateral_mps2: Annotated[float, Meta(ge=0.5, le=4.0)] = 2.0
    """Lateral acceleration that the sine reaches."""
    cycles: Annotated[int, Meta(ge=1, le=20)] = 3
    """How many settled periods of the sine are evaluated."""


class ParkingEffort(Section, frozen=True, kw_only=True, tag_field="kind", tag="parking_effort"):
    """The hand wheel turned slowly to both sides on the spot, with the brake on: torque at the rim."""

    hand_wheel_deg: HandDeg = 360.0
    """Angle to which the hand wheel is turned to each side."""
    hand_wheel_degps: DegPerS = 90.0
    """How fast the hand wheel is turned."""


class FrequencyResponse(Section, frozen=True, kw_only=True, tag_field="kind", tag="frequency_response"):
    """ISO 7401, continuous sinusoidal input: a small sine of the hand wheel at each frequency, at constant speed."""

    speed_kmh: Kmh = 100.0
    """Speed that is kept during the whole test."""
    hand_wheel_deg: HandDeg = 15.0
    """Amplitude of the sine of the hand wheel."""
    frequencies_hz: Annotated[tuple[Frequency, ...], Meta(min_length=2, max_length=20)] = SINES_HZ
    """Frequencies that are driven one after the other."""


class BendBraking(Section, frozen=True, kw_only=True, tag_field="kind", tag="bend_braking"):
    """ISO 7975, open loop: a steady circle, then braking with the steering held."""

    radius_m: Annotated[float, Meta(ge=20.0, le=500.0)] = 100.0
    """Radius of the steady circle."""
    lateral_mps2: Annotated[float, Meta(ge=1.0, le=8.0)] = 5.0
    """Lateral acceleration on the steady circle, which sets the speed."""
    deceleration_mps2: Annotated[float, Meta(ge=1.0, le=8.0)] = 3.4
    """How hard the car brakes in the bend."""


class LiftOff(Section, frozen=True, kw_only=True, tag_field="kind", tag="lift_off"):
    """ISO 9816: a steady circle, then the throttle released with the steering held."""

    radius_m: Annotated[float, Meta(ge=20.0, le=500.0)] = 100.0
    """Radius of the steady circle."""
    lateral_mps2: Annotated[float, Meta(ge=1.0, le=8.0)] = 5.0
    """Lateral acceleration on the steady circle, which sets the speed."""


class Acceleration(Section, frozen=True, kw_only=True, tag_field="kind", tag="acceleration"):
    """Full throttle from rest until the car gains no more."""

    to_kmh: Kmh = 100.0
    """Speed up to which the time is measured."""


class Observed(Section, frozen=True, kw_only=True, tag_field="kind", tag="observed"):
    """The scenario's own script, observed from one time to another: launch, stall, hill start, reverse, parking."""

    from_s: Annotated[float, Meta(ge=0.0, le=3600.0)] = 0.0
    """Simulated time at which the observation begins."""
    until_s: Annotated[float, Meta(gt=0.0, le=3600.0)] | None = None
    """Simulated time at which the observation ends; left out, the end of the drive."""


Manoeuvre: TypeAlias = (
    SteadyCircle
    | StepSteer
    | SineWithDwell
    | DoubleLaneChange
    | StraightBraking
    | CoastDown
    | Weave
    | ParkingEffort
    | FrequencyResponse
    | BendBraking
    | LiftOff
    | Acceleration
    | Observed
)


class Limit(Section, frozen=True, kw_only=True):
    """Bounds on a characteristic value."""

    value: str
    """Name of the characteristic value, as the check prints it."""
    min: float | None = None
    """The check fails if the value is below this; left out, there is no lower bound."""
    max: float | None = None
    """The check fails if the value is above this; left out, there is no upper bound."""
