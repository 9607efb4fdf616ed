"""The scenario profile: a scripted drive with what must come out of it."""

from typing import Annotated, Any, Literal

from msgspec import Meta

from simconsole.profiles.device import ScriptProfile
from simconsole.profiles.faults import EdgeName, ModeName, Trigger
from simconsole.profiles.manoeuvre import Limit, Manoeuvre
from simconsole.profiles.session import Section, SessionProfile
from simconsole.profiles.traffic import MOST_ACTORS, Actor

Seconds = Annotated[float, Meta(ge=0.0, le=86_400.0)]


class RemoteStep(Section, frozen=True, kw_only=True):
    """A controller that repeats one command from `start_s` until `end_s`."""

    start_s: Seconds
    end_s: Seconds
    kind: Literal["acceleration", "speed", "twist", "actuation", "pose"]
    period_ms: Annotated[int, Meta(ge=1, le=1000)] = 20
    road_wheel_deg: Annotated[float, Meta(ge=-60.0, le=60.0)] = 0.0
    accel_mps2: Annotated[float, Meta(ge=-12.0, le=12.0)] = 0.0
    speed_mps: Annotated[float, Meta(ge=-30.0, le=100.0)] = 0.0
    yaw_rate_radps: Annotated[float, Meta(ge=-5.0, le=5.0)] = 0.0
    throttle: Annotated[float, Meta(ge=0.0, le=1.0)] = 0.0
    brake: Annotated[float, Meta(ge=0.0, le=1.0)] = 0.0
    x_m: Annotated[float, Meta(ge=-1e5, le=1e5)] = 0.0
    y_m: Annotated[float, Meta(ge=-1e5, le=1e5)] = 0.0
    direction: Literal[-1, 0, 1] = 1
    turn_indicators: Literal[-1, 0, 1] = 0  # 1 left
    hazard_lights: bool = False


class EventStep(Trigger, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An edge at a time, a place, a speed, a gap, in a mode or after another edge: an operator's act, a lost commander.

    Every edge there is has its name here. After `pause` simulated time stands until a `start` with `on_event: pause`.
    """

    event: EdgeName


class MessageStep(Trigger, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A message of a rosbridge client, as it would arrive over a socket; the console decodes it, or refuses it."""

    topic: Annotated[str, Meta(min_length=1, max_length=200)]
    message: dict[str, Any]
    period_ms: Annotated[int, Meta(ge=1, le=60_000)] | None = None  # None: once
    for_s: Annotated[float, Meta(gt=0.0, le=86_400.0)] | None = None  # how long it is repeated; None: to the end


class Check(Section, frozen=True, kw_only=True):
    """A bound on one column: at `at_s`, or at every tick from `from_s` to `until_s` when `at_s` is absent."""

    column: str
    at_s: Seconds | None = None
    from_s: Seconds = 0.0
    until_s: Seconds | None = None
    min: float | None = None
    max: float | None = None


class MetricCheck(Section, frozen=True, kw_only=True):
    """A bound on one figure of the drive's metrics, by its dotted name: `autonomous.lateral_max_m`."""

    metric: str
    min: float | None = None
    max: float | None = None


class Tolerance(Section, frozen=True, kw_only=True):
    """How far columns may be from their golden; with one, the drive's hash need not be equal."""

    columns: Annotated[str, Meta(min_length=1, max_length=200)]
    """A name, or a pattern: `vehicle.*`. Of several that fit, the last counts."""
    absolute: Annotated[float, Meta(ge=0.0)] = 0.0
    relative: Annotated[float, Meta(ge=0.0)] = 0.0  # of the accepted value
    ignore: bool = False


class ScenarioProfile(Section, frozen=True, kw_only=True):
    """A headless regression drive: everything that goes in, and the bounds on what comes out.

    Who drives is the `script`; or, where that is left out, what the session's `devices.driver` says: a trace, or with
    `virtual` a simulated person. Commands are those of `remote`, of `messages`, or, in a session in lockstep, of its
    live autopilot.
    """

    schema: Literal[1]
    title: str
    duration_s: Annotated[float, Meta(gt=0.0, le=86_400.0)]
    session: SessionProfile
    script: ScriptProfile | None = None
    remote: tuple[RemoteStep, ...] = ()
    events: tuple[EventStep, ...] = ()
    ecu: tuple[RemoteStep, ...] = ()
    ecu_events: tuple[EventStep, ...] = ()
    messages: tuple[MessageStep, ...] = ()
    actors: Annotated[tuple[Actor, ...], Meta(max_length=MOST_ACTORS)] = ()
    """Other road users, moved by this scenario, in the place of the session's traffic."""
    checks: tuple[Check, ...] = ()
    modes: tuple[ModeName, ...] = ()
    """The modes of the whole drive, in their order; empty: any."""
    metrics: tuple[MetricCheck, ...] = ()
    tolerances: tuple[Tolerance, ...] = ()
    manoeuvre: Manoeuvre | None = None
    """Drives the car in the place of script and commands, and is judged by `limits` instead of checks and golden."""
    limits: tuple[Limit, ...] = ()
    golden_hz: Literal[1, 2, 5, 10, 25, 50] = 2
