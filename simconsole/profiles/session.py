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
    """Place of base_link along x of the map."""
    y_m: Annotated[float, Meta(ge=-1e5, le=1e5)] = 0.0
    """Place of base_link along y of the map."""
    yaw_deg: Annotated[float, Meta(ge=-180.0, le=180.0)] = 0.0
    """Heading, left-positive from x of the map."""


class FrictionPatch(Section, frozen=True, kw_only=True):
    """A rectangle of map with another friction: ice, a puddle, a strip of tiles."""

    from_x_m: Annotated[float, Meta(ge=-1e5, le=1e5)]
    """Lower edge of the rectangle along x of the map."""
    to_x_m: Annotated[float, Meta(ge=-1e5, le=1e5)]
    """Upper edge of the rectangle along x of the map."""
    from_y_m: Annotated[float, Meta(ge=-1e5, le=1e5)]
    """Lower edge of the rectangle along y of the map."""
    to_y_m: Annotated[float, Meta(ge=-1e5, le=1e5)]
    """Upper edge of the rectangle along y of the map."""
    friction_share: Annotated[float, Meta(ge=0.0, le=2.0)]
    """Friction inside of the rectangle, as a share of the environment's."""


class Environment(Section, frozen=True, kw_only=True):
    """The world and the ground under the wheels."""

    world: ProfileName | None = None
    """Name of a shipped world or a world's file in the session's folder; left out, an endless plane."""
    friction: Annotated[float, Meta(gt=0.0, le=2.0)] = 1.0
    """Friction of the ground, as a factor on the tyres' own: 1 is dry asphalt."""
    friction_right_share: Annotated[float, Meta(ge=0.0, le=1.0)] = 1.0
    """Friction under the right wheels, as a share of that under the left ones."""
    friction_patches: Annotated[tuple[FrictionPatch, ...], Meta(max_length=4)] = ()
    """Rectangles of the map with another friction; where they overlap, the later one counts."""
    slope_x_percent: Annotated[float, Meta(ge=-40.0, le=40.0)] = 0.0
    """Rise of the ground along x of the map, per way."""
    slope_y_percent: Annotated[float, Meta(ge=-40.0, le=40.0)] = 0.0
    """Rise of the ground along y of the map, per way."""
    wind_mps: Annotated[float, Meta(ge=0.0, le=60.0)] = 0.0
    """Speed of the wind; 0 for none."""
    wind_to_deg: Annotated[float, Meta(ge=-180.0, le=180.0)] = 0.0
    """Direction that the wind blows to, left-positive from x of the map."""
    traffic: TrafficProfile | None = None
    """Other vehicles, where the world is a road map; left out, there are none."""


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
    """Namespace of the platform: its topics are /NAME/..., its frames NAME/..., and NAME is its folder in the
    bundle."""
    vehicle: ProfileName | None = None
    """Vehicle of this platform; left out, that of the scenario."""
    start: Start | None = None
    """Where the platform stands at first. Left out, at the arena's start of its name or of its number; on another world
    at the beginning of the route, 15 m further along it for each platform before this one."""
    driver: DriverName | None = None
    """Who sits in this platform; left out, `devices.driver` in the one of `scenario.seat`, and nobody in the others."""
    person: PersonPlan | None = None
    """What the platform's simulated person does; left out, what `devices.person` says."""
    cockpit: ProfileName | None = None
    """Wheel, pedals and shifter of this platform: a shipped cockpit, or a file in the session's folder; left out,
    `devices.cockpit`."""
    hud: HudProfile | None = None
    """Instruments and window of who sits in this platform, where a clock paces the drive; left out, `outputs.hud` in
    the one of `scenario.seat`, and none in the others."""
    autopilot: bool = True
    """Whether `features.autopilot`, where there is one, drives it, too; one program drives all cars of a profile."""


class Scenario(Section, frozen=True, kw_only=True):
    """What is driven: the vehicle, from where, how long, and what goes wrong on the way."""

    vehicle: ProfileName = "hatchback"
    """Name of a shipped vehicle, or a vehicle's file in the session's folder."""
    start: Start | None = None
    """Where base_link stands at first; left out, at the beginning of the world's route, or without a world at the
    origin of the map."""
    duration_s: Annotated[float, Meta(gt=0.0, le=86_400.0)] | None = None
    """Simulated time after which the drive ends; left out, it goes on until somebody ends it, or its driver has
    finished."""
    faults: Faults = ()
    """What goes wrong on the way, each with its trigger; none if left out."""
    platforms: Annotated[tuple[PlatformSection, ...], Meta(max_length=16)] = ()
    """Vehicles that drive together; left out, there is one, the scenario's vehicle. Only a session that is driven has
    several, not that of a scenario."""
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
    """Anti-lock brakes on or off for this drive; left out, as in the vehicle's profile."""
    traction_control: bool | None = None
    """Traction control on or off for this drive; left out, as in the vehicle's profile."""
    stability_control: bool | None = None
    """Stability control on or off for this drive; left out, as in the vehicle's profile."""
    hill_hold: bool | None = None
    """Hill hold on or off for this drive; left out, as in the vehicle's profile."""


class ControllerChoice(Section, frozen=True, kw_only=True):
    """A controller that another package has registered (entry point `simconsole.controllers`)."""

    name: RegisteredName
    """Name under which the other package has registered the controller."""
    parameters: dict[str, float] = {}
    """Parameters of the controller that differ from its own values; each has bounds of its own."""


class Features(Section, frozen=True, kw_only=True):
    """What the console does beside driving: who may command, and how it supervises them."""

    control: ControlProfile = ControlProfile()
    """When a person takes over, when the car stops by itself, what the last gate lets pass; without it the defaults."""
    aids: Aids = Aids()
    """Driver aids switched on or off for this drive; without it as in the vehicle's profile."""
    commander: Literal["ros", "can"] = "ros"
    """Whose commands drive where both could: those of the ROS side, or those of the ECU, which needs `outputs.can` and
    `mode.pacing` realtime or free."""
    commands: Annotated[str, worded(r"^bag:.{1,1000}$", "bag:FILE or bag:FILE:/TOPIC")] | None = None
    """Recorded commands that are played in the place of a controller's, as `bag:FILE` or `bag:FILE:/TOPIC`, where
    `mode.pacing` is free."""
    controller: ControllerChoice | None = None
    """A controller of another package that is called in the place of a program behind the bridge, where `mode.pacing`
    is lockstep; not together with `scenario.platforms`."""
    autopilot: ProfileName | None = None
    """World whose route `simconsole autopilot` drives, started as a program of its own that only speaks rosbridge; left
    out, none is started."""
    tracker: Literal["preview", "pure_pursuit", "stanley"] = "preview"
    """How the program of `autopilot` steers."""
    speed_advice: bool = False
    """Show the driver how fast to come to the next light at green, as the autopilot knows it. Needs
    `outputs.bridge`."""


class Outputs(Section, frozen=True, kw_only=True):
    """Who sees the drive."""

    bridge: BridgeProfile | None = None
    """The rosbridge server that controllers connect to; left out, there is none."""
    can: CanProfile | None = None
    """The CAN bus that an ECU drives by; left out, there is none."""
    hud: HudProfile | None = HudProfile()
    """The driver's instruments and their window; `null` opens none."""
    scene: SceneProfile | None = SceneProfile()
    """The operators' recording in rerun; `null` makes none."""
    sound: SoundProfile | None = SoundProfile()
    """What the driver hears in a paced drive with a window; `null` is silent."""
    report: bool = True
    """Write a report into the bundle when the drive has ended."""


class Devices(Section, frozen=True, kw_only=True):
    """The cockpit."""

    cockpit: ProfileName = "t500rs_th8rs"
    """Name of a shipped cockpit, or a cockpit's file in the session's folder."""
    driver: DriverName = "sdl"
    """Who sits in the seat: `sdl` for a person at the devices, `keyboard` for one at the keyboard, which needs a
    window, `virtual` for a simulated person, `trace:FILE`, `script:FILE`, or `none`."""
    person: PersonPlan | None = None
    """What the simulated person does where `driver` is virtual; without it they drive the world's route by hand."""


class ModeSection(Section, frozen=True, kw_only=True):
    """How time passes."""

    tick_hz: Literal[50, 100, 125, 200, 250, 500, 1000] = 250
    """Control ticks in a second of simulated time."""
    pacing: Literal["realtime", "free", "lockstep"] = "realtime"
    """How time passes: by the clock (`realtime`), as fast as the machine can (`free`), or waiting for each answer of
    the controller (`lockstep`, which needs `outputs.bridge` or `features.controller`)."""
    start: Literal["at_once", "on_request"] = "at_once"
    """When simulated time begins: `at_once`, or `on_request` of an operator or of the wheel's pause button."""
    control_period_ms: Annotated[int, Meta(ge=1, le=1000)] = 20
    """In lockstep, from one answer of the controller to the next; rounded down to whole ticks."""
    wait_for_controller_s: Annotated[float, Meta(gt=0.0, le=3600.0)] = 60.0
    """In lockstep, how long the drive waits for a controller to come before it gives up."""
    answer_timeout_s: Annotated[float, Meta(gt=0.0, le=60.0)] = 2.0
    """In lockstep, how long the drive waits for one answer of the controller before the controller counts as lost."""

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
    """Version of this kind of file; always 1."""
    title: str = ""
    """Name of the session for people."""
    environment: Environment = Environment()
    """The world and the ground under the wheels; without it an endless flat plane."""
    scenario: Scenario = Scenario()
    """What is driven, from where, and what goes wrong on the way."""
    features: Features = Features()
    """What the console does beside driving: who may command, and how it supervises them."""
    outputs: Outputs = Outputs()
    """Who sees the drive: controllers, driver, operators, the report."""
    devices: Devices = Devices()
    """The cockpit and who sits in it."""
    mode: ModeSection = ModeSection()
    """How time passes."""
