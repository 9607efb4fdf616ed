"""How the axes of wheel and pedals are read."""

from typing import Annotated, Literal, TypeAlias

from msgspec import Meta, Struct

AxisIndex: TypeAlias = Annotated[int, Meta(ge=0, le=31)]
Raw: TypeAlias = Annotated[float, Meta(ge=-1.0, le=1.0)]
Curve: TypeAlias = Annotated[float, Meta(ge=0.2, le=5.0)]
"""1: linear. Above 1: gentle at first, the slope at rest is 1 / curve of the linear one; below 1: steep at first."""

MIN_TRAVEL_RAW = 0.2
"""A pedal whose ends lie closer together than this cannot be distinguished from its noise."""


class SteeringAssistance(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """For keys and sticks: full deflection turns the hand wheel less and slower the faster the car is."""

    half_at_mps: Annotated[float, Meta(gt=0.0, le=100.0)] = 5.6
    """At this speed full deflection is half of the angle at standstill. 5.6 with 900 degrees from lock to lock keeps a
    passenger car below 6 m/s2 of side force at any speed."""
    full_s: Annotated[float, Meta(ge=0.1, le=5.0)] = 1.0
    """How long the hand wheel takes from the middle to what the speed allows."""


class WheelAxis(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The hand wheel."""

    axis: AxisIndex
    """Number of the wheel's axis on its device, from 0."""
    lock_to_lock_deg: Annotated[float, Meta(ge=40.0, le=2520.0)]
    """How far the hand wheel turns from its one end to the other."""
    grows_to: Literal["left", "right"] = "right"
    """The side to which the wheel is turned when the raw value grows."""
    centre_raw: Annotated[float, Meta(ge=-0.5, le=0.5)] = 0.0
    """Raw value of the centred wheel, -1 to 1."""
    dead_zone: Annotated[float, Meta(ge=0.0, le=0.1)] = 0.0
    """Share of the travel about the centre that counts as centred."""
    curve: Curve = 1.0
    """Shape of the answer, for sticks. 1 is linear; above 1 the middle is gentler, below 1 it is steeper. A real wheel
    keeps 1."""
    rate_filter_s: Annotated[float, Meta(ge=0.0, le=0.5)] = 0.02
    """Time constant of the filter on the speed at which the wheel turns."""
    assistance: SteeringAssistance | None = None
    """Makes keys and sticks steer less the faster the car is; left out, the angle is the hand's own. Not together with
    `force_feedback`."""


class PedalAxis(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One pedal. `rest_raw` and `full_raw` carry the polarity."""

    axis: AxisIndex
    """Number of the pedal's axis on its device, from 0."""
    rest_raw: Raw
    """Raw value of the released pedal, -1 to 1. It must be at least 0.2 from `full_raw`."""
    full_raw: Raw
    """Raw value of the pedal pressed fully, -1 to 1."""
    dead_zone: Annotated[float, Meta(ge=0.0, le=0.3)] = 0.02
    """Share of the travel from rest that counts as released."""
    curve: Curve = 1.0
    """Shape of the answer. 1 is linear; above 1 the pedal is gentle at first, below 1 it is steep at first."""

    def __post_init__(self) -> None:
        """Refuse a pedal without travel.

        Raises:
            ValueError: the ends lie too close together.
        """
        if abs(self.full_raw - self.rest_raw) < MIN_TRAVEL_RAW:
            raise ValueError(
                f"rest_raw {self.rest_raw} and full_raw {self.full_raw} must lie at least {MIN_TRAVEL_RAW} apart"
            )
