"""The simulated person's plan: what they do in a drive, and their habits in doing so."""

from typing import Annotated, Final, Literal, TypeAlias

from msgspec import Meta, Struct

Metres: TypeAlias = Annotated[float, Meta(ge=0.0, le=1e6)]
Seconds: TypeAlias = Annotated[float, Meta(ge=0.0, le=86_400.0)]


class When(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A point of the drive: reached when every given limit has been reached."""

    distance_m: Metres | None = None
    """Distance driven since the start. At least one of `distance_m` and `time_s` is given."""
    time_s: Seconds | None = None
    """Simulated time since the start. Where both are given, both must be reached."""

    def __post_init__(self) -> None:
        """Refuse a point without any limit: it would never be reached.

        Raises:
            ValueError: neither limit is given.
        """
        if self.distance_m is None and self.time_s is None:
            raise ValueError("distance_m or time_s must be given")


class Habits(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How a person works the cockpit. Rates of hand and foot are those of an unhurried driver."""

    steering_ratio: Annotated[float, Meta(ge=5.0, le=30.0)] = 15.5
    """Turning of the hand wheel per turning of the road wheels that the person is used to."""
    wheelbase_m: Annotated[float, Meta(ge=1.0, le=6.0)] = 2.6
    """Wheelbase that the person is used to."""
    hand_degps: Annotated[float, Meta(ge=30.0, le=1000.0)] = 240.0
    """Fastest that the hands turn the wheel."""
    foot_per_s: Annotated[float, Meta(ge=0.5, le=20.0)] = 4.0
    """Fastest that a foot moves a pedal, in strokes per second."""
    look_ahead_s: Annotated[float, Meta(ge=0.3, le=3.0)] = 1.2
    """On a straight way the person steers for a point this far ahead in time."""
    look_ahead_min_m: Annotated[float, Meta(ge=2.0, le=50.0)] = 7.0
    """On a straight way the point that the person steers for is at least this far ahead."""
    bite_release_per_s: Annotated[float, Meta(ge=0.1, le=2.0)] = 0.45
    """How fast the clutch is let through its bite point, in strokes per second."""
    launch_rpm: Annotated[float, Meta(ge=900.0, le=4000.0)] = 1800.0
    """Engine speed that the person holds while driving off."""
    shift_up_rpm: Annotated[float, Meta(ge=1200.0, le=7000.0)] = 2300.0
    """Engine speed at which the person shifts up."""
    throttle_max: Annotated[float, Meta(gt=0.0, le=1.0)] = 0.6
    """Most throttle that the person gives, as a share of the pedal."""
    brake: Annotated[float, Meta(gt=0.0, le=1.0)] = 0.3
    """How far the person presses the brake to stop on a straight way, as a share of the pedal."""
    take_back_deg: Annotated[float, Meta(ge=1.0, le=90.0)] = 12.0
    """How far the person turns the hand wheel to take over from autonomy."""


class RoadHabits(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How a person drives along a road: what they look at, how late and how exactly they act, how briskly they drive.

    `drivers/simulated_person/two_point.py`, `along_route.py` and `following.py` name the sources of the figures.
    """

    near_m: Annotated[float, Meta(ge=4.0, le=20.0)] = 8.0
    """How far ahead the near point is that the person steers by, at most."""
    far_s: Annotated[float, Meta(ge=0.5, le=3.0)] = 1.3
    """How far ahead in time the far point is that the person steers by."""
    near_gain: Annotated[float, Meta(ge=0.0, le=1.0)] = 0.2
    """How much the person steers by the near point in place of the far one, before distances are weighed."""
    near_rate_1ps: Annotated[float, Meta(ge=0.0, le=1.0)] = 0.15
    """How fast the wheel goes from where it is felt to be to where the near point wants it."""
    visual_delay_s: Annotated[float, Meta(ge=0.0, le=0.5)] = 0.2
    """Time from what the eyes see to what the hands do."""
    reaction_s: Annotated[float, Meta(ge=0.0, le=3.0)] = 0.75
    """Time from what others and signals do to what the feet do."""
    aim_deviation_m: Annotated[float, Meta(ge=0.0, le=0.5)] = 0.22
    """Standard deviation of what the person takes for the middle of the lane."""
    aim_time_s: Annotated[float, Meta(ge=1.0, le=60.0)] = 6.0
    """How long that aim takes to wander from one place to another."""
    hand_deviation_deg: Annotated[float, Meta(ge=0.0, le=5.0)] = 0.2
    """Standard deviation of the trembling of the hands, at the hand wheel."""
    hand_time_s: Annotated[float, Meta(ge=0.1, le=5.0)] = 0.4
    """How long the trembling takes from one value to another."""
    understeer_radps2pm: Annotated[float, Meta(ge=0.0, le=0.02)] = 0.007
    """By how much more the person steers per lateral acceleration, for what car and arms give way."""
    lateral_mps2: Annotated[float, Meta(ge=0.5, le=6.0)] = 2.0
    """Lateral acceleration with which the person drives through bends; it sets the speed there."""
    accelerate_mps2: Annotated[float, Meta(ge=0.3, le=4.0)] = 1.5
    """Acceleration with which the person speeds up."""
    brake_mps2: Annotated[float, Meta(ge=0.5, le=5.0)] = 1.7
    """Braking that the person finds comfortable."""
    below_limit_mps: Annotated[float, Meta(ge=0.0, le=5.0)] = 0.8
    """How far below the speed limit the person drives."""
    headway_s: Annotated[float, Meta(ge=0.5, le=4.0)] = 1.5
    """Time gap that the person keeps to who drives ahead."""
    gap_m: Annotated[float, Meta(ge=1.0, le=10.0)] = 2.0
    """Distance that the person keeps to who stands ahead, and to a stop line."""
    follows_advice: bool = True
    """Whether the person drives as the display advises (`features.speed_advice` of a paced drive), where that is slower
    than they would."""
    shift_down_rpm: Annotated[float, Meta(ge=900.0, le=3000.0)] = 1200.0
    """Engine speed below which the person shifts down along a route."""
    hurried_rpm: Annotated[float, Meta(ge=1500.0, le=7000.0)] = 3600.0
    """Engine speed at which the person shifts up while they want to be faster."""


class PersonPlan(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One drive: drive off, hand over, take back, stop. A point left out is never reached (`stop`: at once).

    Along a route the person keeps to its limits and bends, no faster than `cruise_kmh`, and stops at its end: that of
    a closed one is a lap, where no `stop` is given.
    """

    schema: Literal[1] = 1
    """Version of this part; always 1."""
    title: Annotated[str, Meta(max_length=200)] = ""
    """What the plan is called for people."""
    sit_s: Seconds = 1.0
    """How long the person sits still before they drive off."""
    cruise_kmh: Annotated[float, Meta(ge=5.0, le=130.0)] = 40.0
    """Speed that the person drives at, or does not exceed along a route."""
    top_gear: Annotated[int, Meta(ge=1, le=7)] = 3
    """Highest gear that the person uses."""
    autonomy: When | None = None
    """When the person hands over to the controller; left out, never."""
    take_back: When | None = None
    """When the person takes the car back; left out, never."""
    stop: When | None = None
    """When the person stops; left out, as soon as all else in the plan is done."""
    habits: Habits = Habits()
    """How the person works the cockpit; without it the defaults."""
    along: Literal["straight", "route"] = "straight"
    """Where the person drives to: straight on from the start and from each take-over, or along the route of the
    session's world, which must then have one."""
    seed: Annotated[int, Meta(ge=0, le=2**53)] = 0
    """Which person it is: the number that the errors of eyes and hands along a route are drawn from."""
    road: RoadHabits = RoadHabits()
    """How the person drives along a route; without it the defaults."""


ROUTE_DRIVER: Final = PersonPlan(title="drives the route by hand", cruise_kmh=130.0, top_gear=6, along="route")
"""What a simulated person does who is not told."""
