"""The plan of a sweep: which sessions or scenarios are driven, with which values and seeds."""

from typing import Annotated, Literal

from msgspec import Meta, field

from simconsole.profiles.session import Section
from simconsole.profiles.validation import ProfileName, worded

MOST_DRIVES = 100_000
Key = Annotated[str, worded(r"^[a-z][A-Za-z0-9_.]{0,120}$", "KEY.KEY of letters, digits and _, up to 121")]
Value = float | int | bool | str


class Span(Section, frozen=True, kw_only=True):
    """Equal steps from one value to another, both included."""

    first: float = field(name="from")
    """First of the values, written as `from`."""
    last: float = field(name="to")
    """Last of the values, written as `to`."""
    count: Annotated[int, Meta(ge=2, le=MOST_DRIVES)]
    """How many values there are from the first to the last, both included."""


class Seeds(Section, frozen=True, kw_only=True):
    """Seeds one after the other, each written into all of these keys."""

    of: Annotated[tuple[Key, ...], Meta(min_length=1, max_length=20)]
    """Dotted keys that each seed is written into."""
    first: Annotated[int, Meta(ge=0, le=2**31)] = 1
    """The first seed; each next one is 1 more."""
    count: Annotated[int, Meta(ge=1, le=MOST_DRIVES)]
    """How many seeds there are."""


class SweepProfile(Section, frozen=True, kw_only=True):
    """Every session or scenario with every combination of values and every seed."""

    schema: Literal[1]
    """Version of this kind of file; always 1."""
    title: str = ""
    """Name of the sweep for people."""
    sessions: tuple[ProfileName, ...] = ()
    """Sessions to drive, by shipped names or files in the sweep's folder; at least one session or scenario is given."""
    scenarios: tuple[ProfileName, ...] = ()
    """Scenarios to drive, by shipped names or files in the sweep's folder."""
    values: dict[Key, tuple[Value, ...] | Span] = field(default_factory=dict)
    """Values to drive with, lists or equal steps, by dotted key as of `simconsole replay --set`:
    `environment.friction`, `body.mass_kg`."""
    seeds: Seeds | None = None
    """Seeds to drive each combination with; left out, each is driven once."""
    duration_s: Annotated[float, Meta(gt=0.0, le=86_400.0)] | None = None
    """Longest simulated time of a session's drive; left out, the session's own."""
    timeout_s: Annotated[float, Meta(gt=0.0, le=86_400.0)] = 600.0
    """Time after which a drive is given up: it may wait for a controller that never comes."""
