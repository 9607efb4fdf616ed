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
    """Simulated time from which the vehicle tends to this speed."""
    speed_kmh: Annotated[float, Meta(ge=0.0, le=200.0)]
    """The speed that the vehicle tends to."""


class LeadVehicle(TrafficSection, frozen=True, kw_only=True):
    """A vehicle that drives on the world's route before the console's own, and looks at nobody."""

    gap_m: Annotated[float, Meta(ge=8.0, le=1000.0)] = 40.0
    """How far the vehicle's middle is ahead of where the console's vehicle starts, along the route."""
    speeds: Annotated[tuple[SpeedFrom, ...], Meta(min_length=1, max_length=200)]
    """The speeds that the vehicle tends to, one after the other."""
    acceleration_mps2: Annotated[float, Meta(gt=0.0, le=8.0)] = 2.0
    """How hard the vehicle speeds up and brakes."""


class SumoProfile(TrafficSection, frozen=True, kw_only=True):
    """SUMO in the place of built-in traffic: its vehicles, people on foot and signals. Needs the extra `sumo`."""

    config: Annotated[str, worded(r"^.{1,1000}\.sumocfg$", "a file that ends in .sumocfg")] | None = None
    """A configuration of SUMO's, beside the session's file, on the world's own map; left out, the seed makes the
    demand."""
    vehicles: Annotated[int, Meta(ge=0, le=MOST_OF_SUMO)] = 50
    """How many vehicles SUMO has at a time, where there is no `config`."""
    pedestrians: Annotated[int, Meta(ge=0, le=MOST_OF_SUMO)] = 0
    """How many people walk at a time, where there is no `config`; nobody on a map without pavements."""
    backend: Literal["libsumo", "traci"] = "libsumo"
    """How SUMO runs: in this process, which can have one (`libsumo`), or in a process of its own (`traci`), which
    several drives at a time need."""
    address: Annotated[str, worded(r"^[^:\s]{1,253}:[0-9]{1,5}$", "HOST:PORT")] | None = None
    """`HOST:PORT` of a SUMO that waits for clients, only for `traci`; left out, one is started."""
    radius_m: Annotated[float, Meta(ge=20.0, le=2000.0)] = 300.0
    """Road users further than this from the vehicle are not asked for."""
    warm_up_s: Annotated[float, Meta(ge=0.0, le=86_400.0)] = 10.0
    """How long SUMO runs before the drive."""
    timeout_s: Annotated[float, Meta(ge=0.1, le=600.0)] = 5.0
    """A SUMO behind `traci` that does not answer for this long is given up: the drive goes on without traffic."""


class TrafficProfile(TrafficSection, frozen=True, kw_only=True):
    """Traffic on a road map, built-in or SUMO's. Nothing of it is drawn by chance but from the seed."""

    vehicles: Annotated[int, Meta(ge=0, le=MOST_VEHICLES)] = 30
    """How many vehicles drive on the map."""
    parked: Annotated[int, Meta(ge=0, le=MOST_PARKED)] = 8
    """How many vehicles are parked at the roadside."""
    pedestrians: Annotated[int, Meta(ge=0, le=MOST_PEDESTRIANS)] = 0
    """People who walk over the crossings of the map; nobody on a map that has none."""
    seed: Annotated[int, Meta(ge=0, le=2**53)] = 1
    """Number that the traffic is drawn from: equal seeds give equal traffic."""
    period_ms: Annotated[int, Meta(ge=10, le=200)] = 40
    """From one step of traffic to the next; it must be a whole number of ticks."""
    lead: LeadVehicle | None = None
    """A vehicle that drives ahead on the route at given speeds; left out, there is none."""
    sumo: SumoProfile | None = None
    """SUMO in the place of built-in traffic: `seed` and `period_ms` are then SUMO's, and the rest of this section says
    nothing. Left out, traffic is built-in."""


class Vertex(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A place of a trajectory and when it is reached, counted from when the trajectory begins."""

    time_s: Seconds
    """When the place is reached, counted from when the trajectory begins; later than the one before."""
    x_m: Metres
    """Place along x of the map."""
    y_m: Metres
    """Place along y of the map."""
    yaw_deg: Degrees | None = None
    """Heading, left-positive from x of the map; left out, the way it moves."""


class Act(Trigger, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Something that an actor does from a trigger on: exactly one of a speed, a place beside its path, a trajectory.

    Modes and edges are the console's; times, places, speeds and gaps are those of `of`.
    """

    of: Name | None = None
    """The actor that the trigger looks at; left out, the console's vehicle."""
    to: Name | None = None
    """The actor to whom the trigger's gap is measured, between the middles of both; left out, the console's vehicle."""
    bumper_to_bumper: bool = False
    """Measure the gap between the bumpers: it is less by half the length of each."""
    not_before_s: Seconds = 0.0
    """The trigger is looked at from this simulated time on."""
    rising: bool = False
    """Begin only if what the trigger says was not so when it was first looked at."""
    speed_kmh: Kmh | None = None
    """Speed that the actor comes to. Exactly one of `speed_kmh`, `lateral_m` and `trajectory` is given."""
    accel_mps2: Annotated[float, Meta(gt=0.0, le=100.0)] = 3.0
    """How hard the actor speeds up or brakes towards `speed_kmh`."""
    lateral_m: Annotated[float, Meta(ge=-100.0, le=100.0)] | None = None
    """Place beside its path that the actor moves to, left is positive."""
    relative: bool = False
    """Count `lateral_m` from where the actor is then, not from its path."""
    over_s: Annotated[float, Meta(gt=0.0, le=600.0)] | None = None
    """How long the act takes, in the place of `accel_mps2`; left out, moving beside the path takes 3 s."""
    trajectory: Annotated[tuple[Vertex, ...], Meta(max_length=1000)] = ()
    """Places that the actor comes to at times, which lead it off its path."""

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
    """What the actor is called, for `of` and `to`; each name once."""
    kind: Literal["car", "van", "pedestrian"] = "car"
    """What the actor is; it says how large it is, unless the keys below do."""
    gap_m: Metres | None = None
    """How far the actor's middle begins ahead of where the console's vehicle starts, along the route. Either this, or
    `x_m` and `y_m`."""
    x_m: Metres | None = None
    """Where the actor's middle begins along x of the map; given together with `y_m`."""
    y_m: Metres | None = None
    """Where the actor's middle begins along y of the map; given together with `x_m`."""
    yaw_deg: Degrees = 0.0
    """Heading at the beginning, left-positive from x of the map, where `x_m` and `y_m` are given."""
    lateral_m: Annotated[float, Meta(ge=-100.0, le=100.0)] = 0.0
    """How far to the left of the route the actor begins."""
    speed_kmh: Kmh = 0.0
    """Speed at the beginning."""
    length_m: Annotated[float, Meta(gt=0.0, le=30.0)] | None = None
    """Length of the actor; left out, that of its kind."""
    width_m: Annotated[float, Meta(gt=0.0, le=5.0)] | None = None
    """Width of the actor; left out, that of its kind."""
    height_m: Annotated[float, Meta(gt=0.0, le=6.0)] | None = None
    """Height of the actor; left out, that of its kind."""
    acts: Annotated[tuple[Act, ...], Meta(max_length=64)] = ()
    """What the actor does on the way, each from its trigger on."""

    def __post_init__(self) -> None:
        """Refuse an actor that begins nowhere, or at two places.

        Raises:
            ValueError: names what is given.
        """
        on_route, at = self.gap_m is not None, (self.x_m is not None, self.y_m is not None)
        if on_route == any(at) or at[0] != at[1]:
            raise ValueError("gap_m, or x_m and y_m, must be given")
