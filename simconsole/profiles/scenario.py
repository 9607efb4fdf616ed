"""The scenario profile: a scripted drive with what must come out of it."""

from typing import Annotated, Literal

from msgspec import Meta

from simconsole.profiles.device import ScriptProfile
from simconsole.profiles.manoeuvre import Limit, Manoeuvre
from simconsole.profiles.session import Section, SessionProfile

Seconds = Annotated[float, Meta(ge=0.0, le=86_400.0)]
EventName = Literal[
    "emergency_stop",
    "reset",
    "request_manual",
    "request_autonomous",
    "request_takeover",
    "commander_lost",
    "mark",
    "toggle_anti_lock",
    "toggle_traction",
    "toggle_stability",
]


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


class EventStep(Section, frozen=True, kw_only=True):
    """An edge at one instant: an operator's act or a lost commander."""

    at_s: Seconds
    event: EventName


class Check(Section, frozen=True, kw_only=True):
    """A bound on one column: at `at_s`, or at every tick from `from_s` to `until_s` when `at_s` is absent."""

    column: str
    at_s: Seconds | None = None
    from_s: Seconds = 0.0
    until_s: Seconds | None = None
    min: float | None = None
    max: float | None = None


class ScenarioProfile(Section, frozen=True, kw_only=True):
    """A headless regression drive: everything that goes in, and the bounds on what comes out."""

    schema: Literal[1]
    title: str
    duration_s: Annotated[float, Meta(gt=0.0, le=86_400.0)]
    session: SessionProfile
    script: ScriptProfile | None = None
    remote: tuple[RemoteStep, ...] = ()
    events: tuple[EventStep, ...] = ()
    ecu: tuple[RemoteStep, ...] = ()
    ecu_events: tuple[EventStep, ...] = ()
    checks: tuple[Check, ...] = ()
    manoeuvre: Manoeuvre | None = None
    """Drives the car in the place of script and commands, and is judged by `limits` instead of checks and golden."""
    limits: tuple[Limit, ...] = ()
    golden_hz: Literal[1, 2, 5, 10, 25, 50] = 2
