"""The session profile: one drive, in the paper's six sections."""

from typing import Annotated, Literal

from msgspec import Meta, Struct

from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.can import CanProfile
from simconsole.profiles.control import ControlProfile
from simconsole.profiles.faults import Faults
from simconsole.profiles.person import PersonPlan
from simconsole.profiles.traffic import TrafficProfile
from simconsole.profiles.validation import ProfileName, RegisteredName, worded
from simconsole.profiles.view import HudProfile, SceneProfile, SoundProfile


class Section(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Base of every section: unknown keys are errors."""


class Start(Section, frozen=True, kw_only=True):
    """Where base_link stands at tick 0."""

    x_m: Annotated[float, Meta(ge=-1e5, le=1e5)] = 0.0
    y_m: Annotated[float, Meta(ge=-1e5, le=1e5)] = 0.0
    yaw_deg: Annotated[float, Meta(ge=-180.0, le=180.0)] = 0.0


class FrictionPatch(Section, frozen=True, kw_only=True):
    """A rectangle of map with another friction: ice, a puddle, a strip of tiles."""

    from_x_m: Annotated[float, Meta(ge=-1e5, le=1e5)]
    to_x_m: Annotated[float, Meta(ge=-1e5, le=1e5)]
    from_y_m: Annotated[float, Meta(ge=-1e5, le=1e5)]
    to_y_m: Annotated[float, Meta(ge=-1e5, le=1e5)]
    friction_share: Annotated[float, Meta(ge=0.0, le=2.0)]  # of the environment's friction


class Environment(Section, frozen=True, kw_only=True):
    """The world and the ground under the wheels."""

    world: ProfileName | None = None
    friction: Annotated[float, Meta(gt=0.0, le=2.0)] = 1.0
    friction_right_share: Annotated[float, Meta(ge=0.0, le=1.0)] = 1.0  # of it, under the right wheels
    friction_patches: Annotated[tuple[FrictionPatch, ...], Meta(max_length=4)] = ()  # where they overlap, the later one
    slope_x_percent: Annotated[float, Meta(ge=-40.0, le=40.0)] = 0.0
    slope_y_percent: Annotated[float, Meta(ge=-40.0, le=40.0)] = 0.0
    wind_mps: Annotated[float, Meta(ge=0.0, le=60.0)] = 0.0
    wind_to_deg: Annotated[float, Meta(ge=-180.0, le=180.0)] = 0.0  # where the air moves to; 0: along x of map
    traffic: TrafficProfile | None = None
    """Other vehicles, where the world is a road map."""


DriverName = Annotated[
    str,
    worded(
        r"^(none|sdl|keyboard|virtual|(trace|script):.+)$", "none, sdl, keyboard, virtual, trace:FILE or script:FILE"
    ),
]
"""Who sits in a seat."""


class PlatformSection(Section, frozen=True, kw_only=True):
    """One of several platforms of a session."""

    name: Annotated[str, worded(r"^[A-Za-z][A-Za-z0-9_]{0,31}$", "letters, digits and _, up to 32, a letter first")]
    """Its namespace: topics are /NAME/..., frames NAME/...; and its folder in the bundle."""
    vehicle: ProfileName | None = None
    """Without it that of the scenario."""
    start: Start | None = None
    """Without it the arena's start of its name, or of its number; on another world the beginning of the route, and 15 m
    further along it for each platform before this one."""
    driver: DriverName | None = None
    """Who sits in it. Without it `devices.driver` in the one of `scenario.seat`, nobody in the others."""
    person: PersonPlan | None = None
    """What its simulated person does; without it `devices.person`."""
    autopilot: bool = True
    """Whether `features.autopilot`, where there is one, starts a program for it, too."""


class Scenario(Section, frozen=True, kw_only=True):
    """What is driven: the vehicle, from where, how long, and what goes wrong on the way."""

    vehicle: ProfileName = "hatchback"
    start: Start | None = None
    """Where the world's route begins, unless it says otherwise; without a world at the origin of `map`."""
    duration_s: Annotated[float, Meta(gt=0.0, le=86_400.0)] | None = None
    faults: Faults = ()
    platforms: Annotated[tuple[PlatformSection, ...], Meta(max_length=16)] = ()
    """Those that drive together, without a clock; none: one, the scenario's vehicle."""
    seat: str | None = None
    """The platform that `devices.driver`, `faults`, display and report belong to; without it the first."""

    def __post_init__(self) -> None:
        """Refuse platforms of one name, and a seat in none of them.

        Raises:
            ValueError: names key and value.
        """
        names = [platform.name for platform in self.platforms]
        if len(set(names)) < len(names):
            raise ValueError(f"platforms: name: a name twice in {', '.join(names)}: each one once")
        if self.seat is not None and self.seat not in names:
            raise ValueError(
                f"seat: value {self.seat}: the name of a platform, of {', '.join(names) or 'which there are none'}"
            )


class Aids(Section, frozen=True, kw_only=True):
    """Driver aids switched on or off for this drive; what is not mentioned is as in the vehicle's profile."""

    anti_lock: bool | None = None
    traction_control: bool | None = None
    stability_control: bool | None = None
    hill_hold: bool | None = None


class ControllerChoice(Section, frozen=True, kw_only=True):
    """A controller that another package has registered (entry point `simconsole.controllers`)."""

    name: RegisteredName
    parameters: dict[str, float] = {}
    """What differs from its own values; each has bounds of its own."""


class Features(Section, frozen=True, kw_only=True):
    """What the console does beside driving: who may command, and how it supervises them."""

    control: ControlProfile = ControlProfile()
    aids: Aids = Aids()
    commander: Literal["ros", "can"] = "ros"
    """Whose commands drive where both could: the ROS side's or, on `outputs.can`, the ECU's (requests/commander.py)."""
    commands: Annotated[str, worded(r"^bag:.{1,1000}$", "bag:FILE or bag:FILE:/TOPIC")] | None = None
    """bag:FILE or bag:FILE:/TOPIC plays recorded commands in place of a controller's, where `mode.pacing` is free."""
    controller: ControllerChoice | None = None
    """Called in the place of a program behind the bridge, where `mode.pacing` is lockstep."""
    autopilot: ProfileName | None = None
    """Start `simconsole autopilot` on this course, as a program of its own that only speaks rosbridge."""
    tracker: Literal["preview", "pure_pursuit", "stanley"] = "preview"
    """How that program steers."""
    speed_advice: bool = False
    """Show the driver how fast to come to the next light at green; the autopilot does so. Needs a bridge."""


class Outputs(Section, frozen=True, kw_only=True):
    """Who sees the drive."""

    bridge: BridgeProfile | None = None
    can: CanProfile | None = None
    hud: HudProfile | None = HudProfile()
    scene: SceneProfile | None = SceneProfile()
    sound: SoundProfile | None = SoundProfile()
    """In a paced drive with a window."""
    report: bool = True


class Devices(Section, frozen=True, kw_only=True):
    """The cockpit."""

    cockpit: ProfileName = "t500rs_th8rs"
    driver: DriverName = "sdl"
    person: PersonPlan | None = None
    """What the simulated person does where `driver` is virtual; without it they drive the world's route by hand."""


class ModeSection(Section, frozen=True, kw_only=True):
    """How time passes."""

    tick_hz: Literal[50, 100, 125, 200, 250, 500, 1000] = 250
    pacing: Literal["realtime", "free", "lockstep"] = "realtime"
    start: Literal["at_once", "on_request"] = "at_once"
    """On request: simulated time stands until an operator starts it, or the wheel's pause button does."""
    control_period_ms: Annotated[int, Meta(ge=1, le=1000)] = 20
    wait_for_controller_s: Annotated[float, Meta(gt=0.0, le=3600.0)] = 60.0
    answer_timeout_s: Annotated[float, Meta(gt=0.0, le=60.0)] = 2.0

    @property
    def control_period_ticks(self) -> int:
        """Ticks from one answer of the controller to the next, in lockstep."""
        return max(1, self.control_period_ms * self.tick_hz // 1000)

    @property
    def control_hz(self) -> float:
        """How often the controller is told where it is and answers, in lockstep."""
        return self.tick_hz / self.control_period_ticks


class SessionProfile(Section, frozen=True, kw_only=True):
    """One drive."""

    schema: Literal[1]
    title: str = ""
    environment: Environment = Environment()
    scenario: Scenario = Scenario()
    features: Features = Features()
    outputs: Outputs = Outputs()
    devices: Devices = Devices()
    mode: ModeSection = ModeSection()
