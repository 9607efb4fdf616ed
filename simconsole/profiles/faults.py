"""Faults of a drive, for tests: which, when, for how long. The closed list of every kind stands at the end.

A kind is a struct with its own parameters on top of `Onset`; whoever adds one adds it to `Fault` and gives it a layer
in faults/schedule.py, the one place that maps each kind to its layer.
"""

from typing import Annotated, Any, Final, Literal, TypeAlias

import msgspec
from msgspec import Meta, Struct

from simconsole.profiles.device import RoleName
from simconsole.profiles.parts.axes import Raw

AxisName: TypeAlias = Literal["wheel", "throttle", "brake", "clutch", "handbrake"]
Seconds: TypeAlias = Annotated[float, Meta(ge=0.0, le=86_400.0)]
Seed: TypeAlias = Annotated[int, Meta(ge=0, le=2**32 - 1)]
ModeName: TypeAlias = Literal[
    "parked", "manual", "shared", "autonomous", "takeover_requested", "minimal_risk", "stopped", "emergency_stop"
]
EdgeName: TypeAlias = Literal[
    "emergency_stop",
    "reset",
    "request_manual",
    "request_autonomous",
    "request_takeover",
    "request_shared",
    "commander_lost",
    "mark",
    "loop_stall",
    "no_answer",
    "pause",
    "start",
    "restart",
    "fault",
    "toggle_anti_lock",
    "toggle_traction",
    "toggle_stability",
    "recording_failed",
    "end",
    "operator",
    "collision",
]

EARLIER_PARTS: Final = {"stations": "outputs"}
"""Names that parts of a drive had in earlier profiles and bundles, to those of now."""

MAX_FAULTS = 48
"""The state vector holds the faults that are on as bits of one float64."""

_ONSETS = (
    "at_s",
    "at_distance_m",
    "near",
    "above_mps",
    "below_mps",
    "gap_below_m",
    "headway_below_s",
    "collision_below_s",
    "on_mode",
    "on_event",
)


class Place(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A circle on the map that base_link comes into."""

    x_m: Annotated[float, Meta(ge=-1e5, le=1e5)]
    """Place of the circle's middle along x of the map."""
    y_m: Annotated[float, Meta(ge=-1e5, le=1e5)]
    """Place of the circle's middle along y of the map."""
    radius_m: Annotated[float, Meta(gt=0.0, le=1000.0)] = 5.0
    """Radius of the circle."""


class Trigger(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """When something begins, once. Exactly one of the keys before `delay_s` is given.

    What is so when it is first looked at begins at once; only `below_mps` waits until that speed was driven. A gap is
    that to whom the vehicle follows.
    """

    at_s: Seconds | None = None
    """Begin at this simulated time since the start of the drive."""
    at_distance_m: Annotated[float, Meta(ge=0.0, le=1e6)] | None = None
    """Begin when the vehicle has driven this far since the start."""
    near: Place | None = None
    """Begin when base_link comes into this circle on the map."""
    above_mps: Annotated[float, Meta(ge=0.0, le=100.0)] | None = None
    """Begin when the vehicle is faster than this."""
    below_mps: Annotated[float, Meta(gt=0.0, le=100.0)] | None = None
    """Begin when the vehicle is slower than this, after it was that fast before."""
    gap_below_m: Annotated[float, Meta(gt=0.0, le=150.0)] | None = None
    """Begin when the gap to whom the vehicle follows is shorter than this."""
    headway_below_s: Annotated[float, Meta(gt=0.0, le=60.0)] | None = None
    """Begin when the gap to whom the vehicle follows, divided by its own speed, is below this."""
    collision_below_s: Annotated[float, Meta(gt=0.0, le=60.0)] | None = None
    """Begin when the gap to whom the vehicle follows, divided by how fast it closes, is below this."""
    on_mode: ModeName | None = None
    """Begin when the console comes into this driving mode."""
    on_event: EdgeName | None = None
    """Begin when this event happens."""
    delay_s: Seconds = 0.0
    """Wait for this long after the trigger before it begins."""

    def __post_init__(self) -> None:
        """Refuse what has no trigger, or more than one.

        Raises:
            ValueError: names what is given.
        """
        given = [name for name in _ONSETS if getattr(self, name) is not None]
        if len(given) != 1:
            raise ValueError(
                f"{' and '.join(given) or 'no trigger'} given, must be exactly one of {', '.join(_ONSETS)}"
            )


class Onset(Trigger, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """When a fault begins, and how long it lasts."""

    for_s: Annotated[float, Meta(gt=0.0, le=86_400.0)] | None = None
    """How long it lasts; left out, to the end of the drive."""


class Unplug(Onset, frozen=True, kw_only=True, tag_field="kind", tag="unplug"):
    """The device is gone, and with it every role on the same plug; its axes read 0.0, as SDL leaves them."""

    device: RoleName
    """The role whose device is pulled out."""


class Freeze(Onset, frozen=True, kw_only=True, tag_field="kind", tag="freeze"):
    """The device stays open but sends nothing new: its last values stay, and their age grows."""

    device: RoleName
    """The role whose device sends nothing new."""


class Stuck(Onset, frozen=True, kw_only=True, tag_field="kind", tag="stuck"):
    """One axis stays where it is, or jumps to `raw` and stays there; its age does not grow."""

    axis: AxisName
    """The axis that no longer moves."""
    raw: Raw | None = None
    """Raw value that the axis jumps to, -1 to 1; left out, it stays where it is."""


class Swapped(Onset, frozen=True, kw_only=True, tag_field="kind", tag="swapped"):
    """Two axes have changed places."""

    axis: AxisName
    """The one of the two axes that change places."""
    other: AxisName
    """The other of the two axes that change places; not the same as `axis`."""

    def __post_init__(self) -> None:
        """Refuse an axis swapped with itself.

        Raises:
            ValueError: it is.
        """
        super().__post_init__()
        if self.axis == self.other:
            raise ValueError(f"other {self.other} must be another axis than axis {self.axis}")


class Noise(Onset, frozen=True, kw_only=True, tag_field="kind", tag="noise"):
    """Uniform noise of up to `amplitude_raw` on one axis, the same for the same seed."""

    axis: AxisName
    """The axis to which noise is added."""
    amplitude_raw: Annotated[float, Meta(gt=0.0, le=2.0)]
    """Largest noise to either side, in raw units of -1 to 1."""
    seed: Seed = 1
    """Number that the noise is drawn from: equal seeds give equal noise."""


class Late(Onset, frozen=True, kw_only=True, tag_field="kind", tag="late"):
    """Everything of one device arrives `by_ms` late. `stamped`: the device stamps its data, so the age is known."""

    device: RoleName
    """The role whose device is late."""
    by_ms: Annotated[float, Meta(gt=0.0, le=5000.0)]
    """How late everything of the device arrives."""
    stamped: bool = True
    """The device stamps its data, so that the console knows how old they are."""


class Invalid(Onset, frozen=True, kw_only=True, tag_field="kind", tag="invalid"):
    """One axis reads an impossible value: NaN, an infinity or a number far outside its range."""

    axis: AxisName
    """The axis that reads an impossible value."""
    reading: Literal["not_a_number", "infinite", "minus_infinite", "huge"] = "not_a_number"
    """What the axis reads: no number at all, an infinity, or a number far outside of its range."""


class Burst(Onset, frozen=True, kw_only=True, tag_field="kind", tag="burst"):
    """One device floods: its axes jump about by up to `amplitude_raw`, many times in a tick; the newest counts."""

    device: RoleName
    """The role whose device floods the console."""
    events_per_s: Annotated[int, Meta(ge=1, le=1_000_000)] = 100_000
    """How many events the device sends in a second."""
    amplitude_raw: Annotated[float, Meta(ge=0.0, le=2.0)] = 0.1
    """How far the axes jump about, in raw units of -1 to 1."""
    seed: Seed = 1
    """Number that the jumps are drawn from: equal seeds give equal jumps."""


class TwoGears(Onset, frozen=True, kw_only=True, tag_field="kind", tag="two_gears"):
    """The lever shows this gear as well as the one it is in (-1: reverse)."""

    gear: Annotated[int, Meta(ge=-1, le=7)]
    """The gear that the lever shows as well, -1 for reverse; not 0, for neutral has no button."""

    def __post_init__(self) -> None:
        """Refuse neutral, which no button shows.

        Raises:
            ValueError: it is asked for.
        """
        super().__post_init__()
        if self.gear == 0:
            raise ValueError("gear 0 must be -1 or 1 to 7: neutral has no button")


DeviceFault: TypeAlias = Unplug | Freeze | Stuck | Swapped | Noise | Late | Invalid | Burst | TwoGears
"""Between the devices and the cockpit (faults/cockpit_faults.py)."""

ControllerName: TypeAlias = Literal["ros", "can"]


class Silent(Onset, frozen=True, kw_only=True, tag_field="kind", tag="silent"):
    """The controller's commands stop without notice."""

    controller: ControllerName = "ros"
    """The controller whose commands stop: on the ROS side, or on the CAN bus."""


class Disconnected(Onset, frozen=True, kw_only=True, tag_field="kind", tag="disconnected"):
    """The controller's connection closes: its loss is reported once, then nothing comes."""

    controller: ControllerName = "ros"
    """The controller whose connection closes: on the ROS side, or on the CAN bus."""


class Refused(Onset, frozen=True, kw_only=True, tag_field="kind", tag="refused"):
    """Every command is refused at the bridge: an old stamp, not finite, out of range, a wrong type or frame."""

    controller: ControllerName = "ros"
    """The controller whose commands are refused: on the ROS side, or on the CAN bus."""


class LateCommands(Onset, frozen=True, kw_only=True, tag_field="kind", tag="late_commands"):
    """Commands arrive, steadily, `by_ms` older than they were: their stamps say so, they act as soon as before."""

    by_ms: Annotated[float, Meta(gt=0.0, le=5000.0)]
    """How much older than before the commands are when they arrive."""
    controller: ControllerName = "ros"
    """The controller whose commands are late: on the ROS side, or on the CAN bus."""


class DelayedCommands(Onset, frozen=True, kw_only=True, tag_field="kind", tag="delayed_commands"):
    """What is sent meanwhile arrives, and acts, `by_ms` later, in whole ticks, and is older by that."""

    by_ms: Annotated[float, Meta(gt=0.0, le=5000.0)]
    """How much later what is sent arrives and acts, in whole ticks."""
    controller: ControllerName = "ros"
    """The controller whose commands are delayed: on the ROS side, or on the CAN bus."""


class NotFinite(Onset, frozen=True, kw_only=True, tag_field="kind", tag="not_finite"):
    """A command that is not finite passes the bridge: the arbiter and the gate are the second line of defence."""

    controller: ControllerName = "ros"
    """The controller whose command is not finite: on the ROS side, or on the CAN bus."""


class Astray(Onset, frozen=True, kw_only=True, tag_field="kind", tag="astray"):
    """The controller asks for another road-wheel angle, in range and finite: the gate limits only its rate."""

    road_wheel_deg: Annotated[float, Meta(ge=-60.0, le=60.0)]
    """Road-wheel angle that the controller asks for instead of its own, left is positive."""
    controller: ControllerName = "ros"
    """The controller that asks for a wrong angle: on the ROS side, or on the CAN bus."""


CommandFault: TypeAlias = Silent | Disconnected | Refused | LateCommands | DelayedCommands | NotFinite | Astray
"""Between a controller and the arbiter (faults/command_faults.py)."""


class Stall(Onset, frozen=True, kw_only=True, tag_field="kind", tag="stall"):
    """The control loop stands still for this long, once; simulated time stands with it."""

    stall_ms: Annotated[float, Meta(gt=0.0, le=60_000.0)]
    """How long the control loop stands still, once."""


class Raises(Onset, frozen=True, kw_only=True, tag_field="kind", tag="raises"):
    """A part of the drive raises an exception whenever it is called."""

    part: Literal["devices", "ros", "can", "outputs", "stations"]
    """The part of the drive that fails; `outputs` are those who read the snapshots, and `stations` is their earlier
    name."""

    def __post_init__(self) -> None:
        """Take the earlier name of a part as the one of now."""
        super().__post_init__()
        msgspec.structs.force_setattr(self, "part", EARLIER_PARTS.get(self.part, self.part))


ProcessFault: TypeAlias = Stall | Raises
"""In the process that the loop runs in (faults/process_faults.py)."""

Fault: TypeAlias = DeviceFault | CommandFault | ProcessFault
"""Every kind there is."""

Faults: TypeAlias = Annotated[tuple[Fault, ...], Meta(max_length=MAX_FAULTS)]


def fault_label(fault: Fault) -> str:
    """Return a fault as text, without its onset: `stuck axis throttle raw -1.0`."""
    plain: dict[str, Any] = msgspec.to_builtins(fault)
    own = {key: value for key, value in plain.items() if key not in Onset.__struct_fields__ and value is not None}
    return " ".join((str(own.pop("kind")), *(f"{key} {value}" for key, value in own.items())))
