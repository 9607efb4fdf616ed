"""The scenario profile: a scripted drive with what must come out of it."""

from typing import Annotated, Any, Literal

from msgspec import Meta

from simconsole.profiles.faults import EdgeName, ModeName, Trigger
from simconsole.profiles.manoeuvre import Limit, Manoeuvre
from simconsole.profiles.parts.script import ScriptProfile
from simconsole.profiles.session import Section, SessionProfile
from simconsole.profiles.traffic import MOST_ACTORS, Actor

Seconds = Annotated[float, Meta(ge=0.0, le=86_400.0)]


class RemoteStep(Section, frozen=True, kw_only=True):
    """A controller that repeats one command from `start_s` until `end_s`."""

    start_s: Seconds
    """Simulated time at which the controller begins to repeat the command."""
    end_s: Seconds
    """Simulated time at which the controller ends to repeat the command."""
    kind: Literal["acceleration", "speed", "twist", "actuation", "pose"]
    """What the command asks for; it says which of the keys below are used."""
    period_ms: Annotated[int, Meta(ge=1, le=1000)] = 20
    """From one command to the next."""
    road_wheel_deg: Annotated[float, Meta(ge=-60.0, le=60.0)] = 0.0
    """Road-wheel angle of the command, left is positive."""
    accel_mps2: Annotated[float, Meta(ge=-12.0, le=12.0)] = 0.0
    """Acceleration of the command, negative to brake."""
    speed_mps: Annotated[float, Meta(ge=-30.0, le=100.0)] = 0.0
    """Speed of the command, negative backwards."""
    yaw_rate_radps: Annotated[float, Meta(ge=-5.0, le=5.0)] = 0.0
    """Turning about the upright axis that the command asks for, left is positive; of a `twist`."""
    throttle: Annotated[float, Meta(ge=0.0, le=1.0)] = 0.0
    """Share of the throttle pedal, 0 to 1; of an `actuation`."""
    brake: Annotated[float, Meta(ge=0.0, le=1.0)] = 0.0
    """Share of the brake pedal, 0 to 1; of an `actuation`."""
    x_m: Annotated[float, Meta(ge=-1e5, le=1e5)] = 0.0
    """Target along x of the map; of a `pose`."""
    y_m: Annotated[float, Meta(ge=-1e5, le=1e5)] = 0.0
    """Target along y of the map; of a `pose`."""
    direction: Literal[-1, 0, 1] = 1
    """Which way to drive: 1 forwards, -1 backwards, 0 neither."""
    turn_indicators: Literal[-1, 0, 1] = 0
    """Turn indicators of the command: 1 left, -1 right, 0 off."""
    hazard_lights: bool = False
    """Hazard lights of the command."""


class EventStep(Trigger, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An edge at a time, a place, a speed, a gap, in a mode or after another edge: an operator's act, a lost commander.

    Every edge there is has its name here. After `pause` simulated time stands until a `start` with `on_event: pause`.
    """

    event: EdgeName
    """The event that is raised, once."""


class MessageStep(Trigger, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A message of a rosbridge client, as it would arrive over a socket; the console decodes it, or refuses it."""

    topic: Annotated[str, Meta(min_length=1, max_length=200)]
    """Name of the topic that the client publishes on."""
    message: dict[str, Any]
    """Content of the message, as JSON over rosbridge has it."""
    period_ms: Annotated[int, Meta(ge=1, le=60_000)] | None = None
    """From one message to the next; left out, it is sent once."""
    for_s: Annotated[float, Meta(gt=0.0, le=86_400.0)] | None = None
    """How long the message is repeated; left out, to the end of the drive."""


class Check(Section, frozen=True, kw_only=True):
    """A bound on one column: at `at_s`, or at every tick from `from_s` to `until_s` when `at_s` is absent."""

    column: str
    """Name of a column of the state vector, as the header of a golden has it: `vehicle.vx_mps`."""
    at_s: Seconds | None = None
    """The one simulated time at which the column is looked at; left out, it is looked at from `from_s` to `until_s`."""
    from_s: Seconds = 0.0
    """Simulated time from which the column is looked at in every tick, where `at_s` is left out."""
    until_s: Seconds | None = None
    """Simulated time up to which the column is looked at; left out, to the end of the drive."""
    min: float | None = None
    """The check fails if the column is below this; left out, there is no lower bound."""
    max: float | None = None
    """The check fails if the column is above this; left out, there is no upper bound."""


class MetricCheck(Section, frozen=True, kw_only=True):
    """A bound on one figure of the drive's metrics, by its dotted name: `autonomous.lateral_max_m`."""

    metric: str
    """Dotted name of the figure: `autonomous.lateral_max_m`."""
    min: float | None = None
    """The check fails if the figure is below this; left out, there is no lower bound."""
    max: float | None = None
    """The check fails if the figure is above this; left out, there is no upper bound."""


class Tolerance(Section, frozen=True, kw_only=True):
    """How far columns may be from their golden; with one, the drive's hash need not be equal."""

    columns: Annotated[str, Meta(min_length=1, max_length=200)]
    """Name of a column, or a pattern of several: `vehicle.*`. Of several tolerances that fit, the last counts."""
    absolute: Annotated[float, Meta(ge=0.0)] = 0.0
    """How far a value may be from its golden, in the unit of its column."""
    relative: Annotated[float, Meta(ge=0.0)] = 0.0
    """How far a value may be from its golden, as a share of the accepted value."""
    ignore: bool = False
    """Do not compare these columns at all."""


class ScenarioProfile(Section, frozen=True, kw_only=True):
    """A headless regression drive: everything that goes in, and the bounds on what comes out.

    Who drives is the `script`; or, where that is left out, what the session's `devices.driver` says: a trace, or with
    `virtual` a simulated person. Commands are those of `remote`, of `messages`, or, in a session in lockstep, of its
    live autopilot.
    """

    schema: Literal[1]
    """Version of this kind of file; always 1."""
    title: str
    """Name of the scenario for people."""
    duration_s: Annotated[float, Meta(gt=0.0, le=86_400.0)]
    """Simulated time after which the drive ends."""
    session: SessionProfile
    """The session that is driven, with the keys of a session's file."""
    script: ScriptProfile | None = None
    """A person's acts at times, where `session.devices.driver` names no trace, script or simulated person; left out,
    that key says who drives."""
    remote: tuple[RemoteStep, ...] = ()
    """A controller's commands on the ROS side, at times."""
    events: tuple[EventStep, ...] = ()
    """Events that are raised on the way, as an operator or the ROS side would raise them."""
    ecu: tuple[RemoteStep, ...] = ()
    """A controller's commands on the CAN bus, at times."""
    ecu_events: tuple[EventStep, ...] = ()
    """Events that are raised on the way by the CAN side."""
    messages: tuple[MessageStep, ...] = ()
    """Messages of a rosbridge client, which the console decodes or refuses as if they came over a socket."""
    actors: Annotated[tuple[Actor, ...], Meta(max_length=MOST_ACTORS)] = ()
    """Other road users, moved by this scenario, in the place of the session's traffic."""
    checks: tuple[Check, ...] = ()
    """Bounds on columns of the state vector, each at a time or over one."""
    modes: tuple[ModeName, ...] = ()
    """Driving modes of the whole drive that are demanded, in their order; left out, any will do."""
    metrics: tuple[MetricCheck, ...] = ()
    """Bounds on figures of the drive's metrics."""
    tolerances: tuple[Tolerance, ...] = ()
    """How far columns may be from their golden; left out, the drive must be equal to the bit."""
    manoeuvre: Manoeuvre | None = None
    """A test that drives the car in the place of script and commands, and is judged by `limits` instead of checks and
    golden."""
    limits: tuple[Limit, ...] = ()
    """Bounds on the characteristic values of the `manoeuvre`."""
    golden_hz: Literal[1, 2, 5, 10, 25, 50] = 2
    """How many rows of a second of the drive the golden keeps."""
