"""The traffic of a session: how many vehicles, drawn by which seed, and a lead vehicle that drives by a script."""

from typing import Annotated, Final, Literal

from msgspec import Meta, Struct

MOST_VEHICLES: Final = 60
MOST_PARKED: Final = 30
MOST_PEDESTRIANS: Final = 30
MOST_OF_SUMO: Final = 2000


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

    config: Annotated[str, Meta(pattern=r"^.{1,1000}\.sumocfg$")] | None = None
    """A configuration of SUMO's, beside the session's file, on the world's own map; else demand is made by the seed."""
    vehicles: Annotated[int, Meta(ge=0, le=MOST_OF_SUMO)] = 50
    """At a time, without a configuration."""
    pedestrians: Annotated[int, Meta(ge=0, le=MOST_OF_SUMO)] = 0
    """Likewise; nobody on a map without pavements."""
    backend: Literal["libsumo", "traci"] = "libsumo"
    """SUMO in this process, once in each, or in one of its own."""
    address: Annotated[str, Meta(pattern=r"^[^:\s]{1,253}:[0-9]{1,5}$")] | None = None
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
