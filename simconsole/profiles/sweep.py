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
    last: float = field(name="to")
    count: Annotated[int, Meta(ge=2, le=MOST_DRIVES)]


class Seeds(Section, frozen=True, kw_only=True):
    """Seeds one after the other, each written into all of these keys."""

    of: Annotated[tuple[Key, ...], Meta(min_length=1, max_length=20)]
    first: Annotated[int, Meta(ge=0, le=2**31)] = 1
    count: Annotated[int, Meta(ge=1, le=MOST_DRIVES)]


class SweepProfile(Section, frozen=True, kw_only=True):
    """Every session or scenario with every combination of values and every seed."""

    schema: Literal[1]
    title: str = ""
    sessions: tuple[ProfileName, ...] = ()
    scenarios: tuple[ProfileName, ...] = ()
    values: dict[Key, tuple[Value, ...] | Span] = field(default_factory=dict)
    """By dotted key, as of `simconsole replay --set`: `environment.friction`, `body.mass_kg`."""
    seeds: Seeds | None = None
    duration_s: Annotated[float, Meta(gt=0.0, le=86_400.0)] | None = None
    """Longest simulated time of a session's drive (default: the session's own)."""
    timeout_s: Annotated[float, Meta(gt=0.0, le=86_400.0)] = 600.0
    """Time after which a drive is given up: it may wait for a controller that never comes."""
