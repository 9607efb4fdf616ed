"""The simulated person's plan: what they do in a drive, and their habits in doing so."""

from typing import Annotated, Final, Literal, TypeAlias

from msgspec import Meta, Struct

Metres: TypeAlias = Annotated[float, Meta(ge=0.0, le=1e6)]
Seconds: TypeAlias = Annotated[float, Meta(ge=0.0, le=86_400.0)]


class When(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A point of the drive: reached when every given limit has been reached."""

    distance_m: Metres | None = None  # driven since the start
    time_s: Seconds | None = None  # since the start

    def __post_init__(self) -> None:
        """Refuse a point without any limit: it would never be reached.

        Raises:
            ValueError: neither limit is given.
        """
        if self.distance_m is None and self.time_s is None:
            raise ValueError("distance_m or time_s must be given")


class Habits(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How a person works the cockpit. Rates of hand and foot are those of an unhurried driver."""

    steering_ratio: Annotated[float, Meta(ge=5.0, le=30.0)] = 15.5  # what they are used to
    wheelbase_m: Annotated[float, Meta(ge=1.0, le=6.0)] = 2.6
    hand_degps: Annotated[float, Meta(ge=30.0, le=1000.0)] = 240.0
    foot_per_s: Annotated[float, Meta(ge=0.5, le=20.0)] = 4.0
    look_ahead_s: Annotated[float, Meta(ge=0.3, le=3.0)] = 1.2
    look_ahead_min_m: Annotated[float, Meta(ge=2.0, le=50.0)] = 7.0
    bite_release_per_s: Annotated[float, Meta(ge=0.1, le=2.0)] = 0.45  # the clutch through its bite point
    launch_rpm: Annotated[float, Meta(ge=900.0, le=4000.0)] = 1800.0
    shift_up_rpm: Annotated[float, Meta(ge=1200.0, le=7000.0)] = 2300.0
    throttle_max: Annotated[float, Meta(gt=0.0, le=1.0)] = 0.6
    brake: Annotated[float, Meta(gt=0.0, le=1.0)] = 0.3
    take_back_deg: Annotated[float, Meta(ge=1.0, le=90.0)] = 12.0


class RoadHabits(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How a person drives along a road: what they look at, how late and how exactly they act, how briskly they drive.

    `drivers/simulated_person/two_point.py`, `along_route.py` and `following.py` name the sources of the figures.
    """

    near_m: Annotated[float, Meta(ge=4.0, le=20.0)] = 8.0  # how far ahead the near point is, at most
    far_s: Annotated[float, Meta(ge=0.5, le=3.0)] = 1.3  # how far ahead the far point is
    near_gain: Annotated[float, Meta(ge=0.0, le=1.0)] = 0.2
    near_rate_1ps: Annotated[float, Meta(ge=0.0, le=1.0)] = 0.15
    visual_delay_s: Annotated[float, Meta(ge=0.0, le=0.5)] = 0.2  # from the eye to the hand
    reaction_s: Annotated[float, Meta(ge=0.0, le=3.0)] = 0.75  # to what others do and to signals
    aim_deviation_m: Annotated[float, Meta(ge=0.0, le=0.5)] = 0.22  # of what they take for the middle of their lane
    aim_time_s: Annotated[float, Meta(ge=1.0, le=60.0)] = 6.0
    hand_deviation_deg: Annotated[float, Meta(ge=0.0, le=5.0)] = 0.2
    hand_time_s: Annotated[float, Meta(ge=0.1, le=5.0)] = 0.4
    understeer_radps2pm: Annotated[float, Meta(ge=0.0, le=0.02)] = 0.007  # of the car and of their arms
    lateral_mps2: Annotated[float, Meta(ge=0.5, le=6.0)] = 2.0
    accelerate_mps2: Annotated[float, Meta(ge=0.3, le=4.0)] = 1.5
    brake_mps2: Annotated[float, Meta(ge=0.5, le=5.0)] = 1.7
    below_limit_mps: Annotated[float, Meta(ge=0.0, le=5.0)] = 0.8
    headway_s: Annotated[float, Meta(ge=0.5, le=4.0)] = 1.5
    gap_m: Annotated[float, Meta(ge=1.0, le=10.0)] = 2.0  # to who stands ahead, and to a stop line
    shift_down_rpm: Annotated[float, Meta(ge=900.0, le=3000.0)] = 1200.0
    hurried_rpm: Annotated[float, Meta(ge=1500.0, le=7000.0)] = 3600.0  # to shift up while they want to be faster


class PersonPlan(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One drive: drive off, hand over, take back, stop. A point left out is never reached (`stop`: at once).

    Along a route the person keeps to its limits and bends, no faster than `cruise_kmh`, and stops at its end: that of
    a closed one is a lap, where no `stop` is given.
    """

    schema: Literal[1] = 1
    title: Annotated[str, Meta(max_length=200)] = ""
    sit_s: Seconds = 1.0
    cruise_kmh: Annotated[float, Meta(ge=5.0, le=130.0)] = 40.0
    top_gear: Annotated[int, Meta(ge=1, le=7)] = 3
    autonomy: When | None = None
    take_back: When | None = None
    stop: When | None = None
    habits: Habits = Habits()
    along: Literal["straight", "route"] = "straight"
    """Where to: straight on from the start and from each take-over, or along the route of the session's world."""
    seed: Annotated[int, Meta(ge=0, le=2**53)] = 0
    """Which person: what their eyes and hands do wrong along a route."""
    road: RoadHabits = RoadHabits()


ROUTE_DRIVER: Final = PersonPlan(title="drives the route by hand", cruise_kmh=130.0, top_gear=6, along="route")
"""What a simulated person does who is not told."""
