"""Other road users that a scenario moves itself: where they begin, what they do, and what makes them do it."""

from itertools import pairwise
from typing import Annotated, Literal

from msgspec import Meta, Struct

from simconsole.profiles.faults import Seconds, Trigger

MOST_ACTORS = 32
Metres = Annotated[float, Meta(ge=-1e5, le=1e5)]
Degrees = Annotated[float, Meta(ge=-360.0, le=360.0)]
Kmh = Annotated[float, Meta(ge=0.0, le=250.0)]
Name = Annotated[str, Meta(pattern=r"^[A-Za-z_][A-Za-z0-9_.:-]{0,60}$")]


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
