"""The traffic of a session, drawn by a seed or SUMO's, and road users that a scenario moves itself."""

from itertools import pairwise
from typing import Annotated, Final, Literal, TypeAlias

from msgspec import Meta, Struct

from simconsole.profiles.faults import Seconds, Trigger
from simconsole.profiles.validation import worded

MOST_VEHICLES: Final = 60
MOST_PARKED: Final = 30
MOST_PEDESTRIANS: Final = 30
MOST_OF_SUMO: Final = 2000
MOST_ACTORS: Final = 32
Metres: TypeAlias = Annotated[float, Meta(ge=-1e5, le=1e5)]
Degrees: TypeAlias = Annotated[float, Meta(ge=-360.0, le=360.0)]
Kmh: TypeAlias = Annotated[float, Meta(ge=0.0, le=250.0)]
Name: TypeAlias = Annotated[
    str, worded(r"^[A-Za-z_][A-Za-z0-9_.:-]{0,60}$", "letters, digits and _.:-, up to 61, a letter or _ first")
]


class TrafficSection(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Base of every part: unknown keys are errors."""


class SpeedFrom(TrafficSection, frozen=True, kw_only=True):
    """The speed that a lead vehicle tends to from a time on."""

    from_s: Annotated[float, Meta(ge=0.0, le=86_400.0)] = 0.0
    speed_kmh: Annotated[float, Meta(ge=0.0, le=200.0)]


class LeadVehicle(TrafficSection, frozen=True, kw_only=True):
    """A vehicle that drives on the world's route before the console's own, and looks at nobody."""

    gap_m: Annotated[float, Meta(ge=8.0, le=1000.0)] = 40.0
    """Of its middle from where the console's vehicle starts, along the route."""
    speeds: Annotated[tuple[SpeedFrom, ...], Meta(min_length=1, max_length=200)]
    acceleration_mps2: Annotated[float, Meta(gt=0.0, le=8.0)] = 2.0


class SumoProfile(TrafficSection, frozen=True, kw_only=True):
    """SUMO in the place of built-in traffic: its vehicles, people on foot and signals. Needs the extra `sumo`."""

    config: Annotated[str, worded(r"^.{1,1000}\.sumocfg$", "a file that ends in .sumocfg")] | None = None
    """A configuration of SUMO's, beside the session's file, on the world's own map; else demand is made by the seed."""
    vehicles: Annotated[int, Meta(ge=0, le=MOST_OF_SUMO)] = 50
    """At a time, without a configuration."""
    pedestrians: Annotated[int, Meta(ge=0, le=MOST_OF_SUMO)] = 0
    """Likewise; nobody on a map without pavements."""
    backend: Literal["libsumo", "traci"] = "libsumo"
    """SUMO in this process, once in each, or in one of its own."""
    address: Annotated[str, worded(r"^[^:\s]{1,253}:[0-9]{1,5}$", "HOST:PORT")] | None = None
    """host:port of a SUMO that waits for clients, for traci; else one is started."""
    radius_m: Annotated[float, Meta(ge=20.0, le=2000.0)] = 300.0
    """Who is further from the vehicle is not asked for."""
    warm_up_s: Annotated[float, Meta(ge=0.0, le=86_400.0)] = 10.0
    """SUMO runs so long before the drive."""
    timeout_s: Annotated[float, Meta(ge=0.1, le=600.0)] = 5.0
    """A SUMO behind traci that does not answer for so long is given up: the drive goes on without traffic."""


class TrafficProfile(TrafficSection, frozen=True, kw_only=True):
    """Traffic on a road map, built-in or SUMO's. Nothing of it is drawn by chance but from the seed."""

    vehicles: Annotated[int, Meta(ge=0, le=MOST_VEHICLES)] = 30
    parked: Annotated[int, Meta(ge=0, le=MOST_PARKED)] = 8
    pedestrians: Annotated[int, Meta(ge=0, le=MOST_PEDESTRIANS)] = 0
    """People who walk over the crossings of the map; nobody on a map that has none."""
    seed: Annotated[int, Meta(ge=0, le=2**53)] = 1
    period_ms: Annotated[int, Meta(ge=10, le=200)] = 40
    """From one step of traffic to the next: a whole number of ticks."""
    lead: LeadVehicle | None = None
    sumo: SumoProfile | None = None
    """With it `seed` and `period_ms` are SUMO's, and the rest of this section says nothing."""


class Vertex(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A place of a trajectory and when it is reached, counted from when the trajectory begins."""

    time_s: Seconds
    x_m: Metres
    y_m: Metres
    yaw_deg: Degrees | None = None  # the way it moves, where it is left out


class Act(Trigger, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Something that an actor does from a trigger on: exactly one of a speed, a place beside its path, a trajectory.

    Modes and edges are the console's; times, places, speeds and gaps are those of `of`.
    """

    of: Name | None = None  # an actor; None: the console's vehicle
    to: Name | None = None  # a gap is that between the middles of these two; None: the console's vehicle
    bumper_to_bumper: bool = False  # the gap is less by half the length of each
    not_before_s: Seconds = 0.0
    rising: bool = False  # only what is not so when it is first looked at
    speed_kmh: Kmh | None = None
    accel_mps2: Annotated[float, Meta(gt=0.0, le=100.0)] = 3.0  # with which it comes to that speed, either way
    lateral_m: Annotated[float, Meta(ge=-100.0, le=100.0)] | None = None  # left of its path
    relative: bool = False  # that is counted from where it is then
    over_s: Annotated[float, Meta(gt=0.0, le=600.0)] | None = None
    """How long it takes, in the place of `accel_mps2`; to another place beside the path 3 s."""
    trajectory: Annotated[tuple[Vertex, ...], Meta(max_length=1000)] = ()

    def __post_init__(self) -> None:
        """Refuse an act that is none, or several, and a trajectory that goes back in time.

        Raises:
            ValueError: names what is given.
        """
        super().__post_init__()
        given = [name for name in ("speed_kmh", "lateral_m") if getattr(self, name) is not None]
        given += ["trajectory"] if self.trajectory else []
        if len(given) != 1:
            raise ValueError(
                f"{' and '.join(given) or 'no act'} given, must be one of speed_kmh, lateral_m, trajectory"
            )
        if any(two.time_s <= one.time_s for one, two in pairwise(self.trajectory)):
            raise ValueError("trajectory: each time_s must be later than the one before")


class Actor(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A road user that looks at nobody. Without a place it begins on the world's route, `gap_m` before the vehicle."""

    name: Name
    kind: Literal["car", "van", "pedestrian"] = "car"
    gap_m: Metres | None = None  # along the route, between the middle of it and where the console's vehicle starts
    x_m: Metres | None = None  # of its middle
    y_m: Metres | None = None
    yaw_deg: Degrees = 0.0
    lateral_m: Annotated[float, Meta(ge=-100.0, le=100.0)] = 0.0  # left of the route
    speed_kmh: Kmh = 0.0
    length_m: Annotated[float, Meta(gt=0.0, le=30.0)] | None = None
    width_m: Annotated[float, Meta(gt=0.0, le=5.0)] | None = None
    height_m: Annotated[float, Meta(gt=0.0, le=6.0)] | None = None
    acts: Annotated[tuple[Act, ...], Meta(max_length=64)] = ()

    def __post_init__(self) -> None:
        """Refuse an actor that begins nowhere, or at two places.

        Raises:
            ValueError: names what is given.
        """
        on_route, at = self.gap_m is not None, (self.x_m is not None, self.y_m is not None)
        if on_route == any(at) or at[0] != at[1]:
            raise ValueError("gap_m, or x_m and y_m, must be given")
