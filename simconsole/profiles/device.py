"""The cockpit profile: which devices make one cockpit and what their axes and buttons mean; the script of a drive."""

from typing import Annotated, Literal, NamedTuple, TypeAlias

from msgspec import Meta, Struct

from simconsole.profiles.force_feedback import ForceFeedback

RoleName: TypeAlias = Literal["wheel", "pedals", "shifter", "handbrake"]
UsbId: TypeAlias = Annotated[int, Meta(ge=0, le=0xFFFF)]
AxisIndex: TypeAlias = Annotated[int, Meta(ge=0, le=31)]
ButtonIndex: TypeAlias = Annotated[int, Meta(ge=0, le=127)]
Raw: TypeAlias = Annotated[float, Meta(ge=-1.0, le=1.0)]
Share: TypeAlias = Annotated[float, Meta(ge=0.0, le=1.0)]
Curve: TypeAlias = Annotated[float, Meta(ge=0.2, le=5.0)]
"""1: linear. Above 1: gentle at first, the slope at rest is 1 / curve of the linear one; below 1: steep at first."""
Title: TypeAlias = Annotated[str, Meta(max_length=200)]

ButtonLabel: TypeAlias = Annotated[str, Meta(min_length=1, max_length=16)]
"""What is printed on a button, or what it is called."""

MAX_BUTTONS = 128
"""As many as Windows tells of one device (DIJOYSTATE2)."""
MOST_MEANINGS = 24
"""Buttons of one device that may have a meaning: a state vector holds so many of each."""
MIN_TRAVEL_RAW = 0.2
"""A pedal whose ends lie closer together than this cannot be distinguished from its noise."""


class DeviceKey(NamedTuple):
    """One device: USB vendor and product id, and where several of them are plugged in the port of this one."""

    vendor_id: int
    product_id: int
    port: str = ""


class OtherDevice(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A device that plays the same role with the same numbers, used where the first one is not there."""

    vendor_id: UsbId
    product_id: UsbId
    name: Title
    axes: Annotated[int, Meta(ge=0, le=32)]  # at least
    buttons: Annotated[int, Meta(ge=0, le=MAX_BUTTONS)]


class RoleBinding(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One role and the device that plays it, found by its USB identity, never by its number or name."""

    role: RoleName
    vendor_id: UsbId
    product_id: UsbId
    name: Title  # as the firmware says it; shown to people, never matched
    port: Title = ""  # of two devices with one id: where this one is plugged in, as `simconsole devices list` says
    axes: Annotated[int, Meta(ge=0, le=32)]
    buttons: Annotated[int, Meta(ge=0, le=MAX_BUTTONS)]
    hats: Annotated[int, Meta(ge=0, le=4)] = 0
    button_labels: Annotated[list[ButtonLabel], Meta(max_length=MAX_BUTTONS)] = []  # of button 0, 1, ...
    others: Annotated[list[OtherDevice], Meta(max_length=8)] = []  # of a shifter only

    def __post_init__(self) -> None:
        """Refuse another device for a role whose motor and limits are asked for by its one identity.

        Raises:
            ValueError: names the role.
        """
        if self.others and self.role != "shifter":
            raise ValueError(f"others must be empty where role is {self.role}: only a shifter may be another")

    @property
    def key(self) -> DeviceKey:
        """The device."""
        return DeviceKey(self.vendor_id, self.product_id, self.port)

    @property
    def candidates(self) -> "tuple[RoleBinding | OtherDevice, ...]":
        """The device, then those that may play the role in its place."""
        return (self, *self.others)


class BootMode(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An identity under which a device of this cockpit answers while it cannot drive."""

    vendor_id: UsbId
    product_id: UsbId
    cure: Title


class SteeringAssistance(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """For keys and sticks: full deflection turns the hand wheel less and slower the faster the car is."""

    half_at_mps: Annotated[float, Meta(gt=0.0, le=100.0)] = 5.6
    """At this speed full deflection is half of the angle at standstill. 5.6 with 900 degrees from lock to lock keeps a
    passenger car below 6 m/s2 of side force at any speed."""
    full_s: Annotated[float, Meta(ge=0.1, le=5.0)] = 1.0
    """From the middle to what the speed allows."""


class WheelAxis(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The hand wheel."""

    axis: AxisIndex
    lock_to_lock_deg: Annotated[float, Meta(ge=40.0, le=2520.0)]
    grows_to: Literal["left", "right"] = "right"
    centre_raw: Annotated[float, Meta(ge=-0.5, le=0.5)] = 0.0
    dead_zone: Annotated[float, Meta(ge=0.0, le=0.1)] = 0.0
    curve: Curve = 1.0  # for sticks: the angle of a wheel is an angle
    rate_filter_s: Annotated[float, Meta(ge=0.0, le=0.5)] = 0.02
    assistance: SteeringAssistance | None = None  # none: the angle is the hand's own


class PedalAxis(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One pedal. `rest_raw` and `full_raw` carry the polarity."""

    axis: AxisIndex
    rest_raw: Raw
    full_raw: Raw
    dead_zone: Annotated[float, Meta(ge=0.0, le=0.3)] = 0.02
    curve: Curve = 1.0

    def __post_init__(self) -> None:
        """Refuse a pedal without travel.

        Raises:
            ValueError: the ends lie too close together.
        """
        if abs(self.full_raw - self.rest_raw) < MIN_TRAVEL_RAW:
            raise ValueError(
                f"rest_raw {self.rest_raw} and full_raw {self.full_raw} must lie at least {MIN_TRAVEL_RAW} apart"
            )


class Pedals(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The pedals, on the device of the role `pedals`; the handbrake on its own where the role `handbrake` is bound."""

    throttle: PedalAxis
    brake: PedalAxis
    clutch: PedalAxis | None = None
    handbrake: PedalAxis | None = None

    def __post_init__(self) -> None:
        """Refuse a throttle and a brake on one axis that do not go apart from a common rest.

        Raises:
            ValueError: names the keys.
        """
        if not self.combined:
            return
        apart = (self.throttle.full_raw - self.throttle.rest_raw) * (self.brake.full_raw - self.brake.rest_raw) < 0.0
        if not apart or abs(self.throttle.rest_raw - self.brake.rest_raw) > MIN_TRAVEL_RAW:
            raise ValueError(
                f"throttle and brake share axis {self.brake.axis}: rest_raw must be the same and full_raw on either "
                "side of it"
            )

    @property
    def combined(self) -> bool:
        """Whether one axis is throttle to one side and brake to the other."""
        return self.throttle.axis == self.brake.axis


class Shifter(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The lever: one button per gear (H pattern) or two that step."""

    pattern: Literal["h", "sequential"]
    on: Literal["wheel", "shifter"] = "shifter"
    gears: Annotated[list[ButtonIndex], Meta(max_length=7)] = []  # button of gear 1, 2, ...
    reverse: ButtonIndex | None = None
    top_gear: Annotated[int, Meta(ge=1, le=7)] = 6
    neutral_dwell_s: Annotated[float, Meta(ge=0.0, le=1.0)] = 0.1


class ButtonBinding(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A button by its number on the device of a role, or a direction of the wheel's hat."""

    on: Literal["wheel", "shifter"] = "wheel"
    button: ButtonIndex | None = None
    hat: Literal["left", "right", "up", "down"] | None = None

    def __post_init__(self) -> None:
        """Refuse both and neither, and a hat of the shifter: only the wheel's is read.

        Raises:
            ValueError: names the keys.
        """
        if (self.button is None) == (self.hat is None):
            raise ValueError("button or hat must be given, and not both")
        if self.hat is not None and self.on != "wheel":
            raise ValueError("on must be wheel where hat is given")


class Buttons(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What the buttons mean; one left out has no button."""

    autonomous: ButtonBinding | None = None
    manual: ButtonBinding | None = None
    emergency_stop: ButtonBinding | None = None
    reset: ButtonBinding | None = None
    shift_up: ButtonBinding | None = None
    shift_down: ButtonBinding | None = None
    indicator_left: ButtonBinding | None = None
    indicator_right: ButtonBinding | None = None
    mark: ButtonBinding | None = None
    pause: ButtonBinding | None = None  # and start again
    restart: ButtonBinding | None = None
    takeover: ButtonBinding | None = None
    shared: ButtonBinding | None = None
    fault: ButtonBinding | None = None
    hazard: ButtonBinding | None = None
    handbrake_button: ButtonBinding | None = None  # a handbrake that is one: pulled fully while held
    horn: ButtonBinding | None = None


class Limits(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """When an input counts as at rest, and how long a silent one is held (facts: 100 ms)."""

    arming: Annotated[float, Meta(gt=0.0, le=0.2)] = 0.05
    stale_s: Annotated[float, Meta(gt=0.0, le=0.5)] = 0.1
    rearm_deg: Annotated[float, Meta(gt=0.0, le=90.0)] = 5.0  # a wheel that was lost obeys again this near the car's


class Provenance(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Source of a part of the profile, so that no guess is mistaken for a measurement."""

    status: Literal["captured", "documented", "unverified", "chosen"]
    source: Title


class CockpitProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Devices that make one cockpit, in whatever order they are plugged in."""

    schema: Literal[1]
    title: Title
    roles: list[RoleBinding] = []
    boot_modes: list[BootMode] = []
    wheel: WheelAxis
    pedals: Pedals
    shifter: Shifter
    buttons: Buttons = Buttons()
    limits: Limits = Limits()
    force_feedback: ForceFeedback | None = None
    provenance: dict[str, Provenance] = {}  # by dotted key, the longest prefix counts

    def __post_init__(self) -> None:
        """Refuse a profile in which a role is bound twice, only some roles are bound, or two gears share a button.

        Raises:
            ValueError: one of these; the message names the key.
        """
        names = [binding.role for binding in self.roles]
        own_handbrake = "handbrake" in names
        if self.wheel.assistance is not None and self.force_feedback is not None:
            raise ValueError("wheel.assistance must not be given where force_feedback is: the motor moves a real wheel")
        if names and sorted(names) != [*(["handbrake"] if own_handbrake else []), "pedals", "shifter", "wheel"]:
            raise ValueError("roles must bind wheel, pedals and shifter once each (handbrake may follow), or none")
        if own_handbrake and self.pedals.handbrake is None:
            raise ValueError("pedals.handbrake must name the axis where roles bind a handbrake")
        lever = [*self.shifter.gears, *([] if self.shifter.reverse is None else [self.shifter.reverse])]
        if len(set(lever)) != len(lever):
            raise ValueError("shifter.gears and shifter.reverse must be different buttons")
        if self.shifter.pattern == "h" and not self.shifter.gears:
            raise ValueError("shifter.gears must name at least one button where shifter.pattern is h")
        _check_count(self)
        for binding in self.roles:
            _check_indices(binding, self)
            if any(binding.key[:2] == other.key[:2] and not binding.port and other.port for other in self.roles):
                raise ValueError(f"roles.port must be given for all devices {binding.key[0]:04x}:{binding.key[1]:04x}")

    def button_label(self, action: str) -> str:
        """Return what the button with this meaning is called, empty where no button has it.

        Args:
            action: A name of `Buttons`.
        """
        bound: ButtonBinding | None = getattr(self.buttons, action)
        if bound is None:
            return ""
        if bound.button is None:
            return f"hat {bound.hat}"
        labels = next((role.button_labels for role in self.roles if role.role == bound.on), [])
        return labels[bound.button] if bound.button < len(labels) else f"button {bound.button}"

    def played_by(self, pedal: str) -> RoleName:
        """Return the role on whose device this pedal is: a handbrake may have one of its own."""
        own = pedal == "handbrake" and any(binding.role == "handbrake" for binding in self.roles)
        return "handbrake" if own else "pedals"


def _check_count(profile: CockpitProfile) -> None:
    for role in ("wheel", "shifter"):
        bound = (getattr(profile.buttons, name) for name in Buttons.__struct_fields__)
        used = {button.button for button in bound if button is not None and button.on == role}
        if profile.shifter.on == role:
            used |= {*profile.shifter.gears, profile.shifter.reverse}
        count = len(used - {None})
        if count > MOST_MEANINGS:
            raise ValueError(f"buttons: {count} of the {role} have a meaning, must be at most {MOST_MEANINGS}")


def _check_indices(binding: RoleBinding, profile: CockpitProfile) -> None:
    pedals = profile.pedals
    if binding.role == "wheel" and profile.wheel.axis >= binding.axes:
        raise ValueError(f"wheel.axis {profile.wheel.axis} must be below {binding.axes}, the axes of {binding.name}")
    for name in ("throttle", "brake", "clutch", "handbrake"):
        pedal: PedalAxis | None = getattr(pedals, name)
        if pedal is not None and profile.played_by(name) == binding.role and pedal.axis >= binding.axes:
            raise ValueError(f"pedals.{name}.axis {pedal.axis} must be below {binding.axes}")
    for key, bound in ((name, getattr(profile.buttons, name)) for name in Buttons.__struct_fields__):
        if bound is None or bound.on != binding.role:
            continue
        if bound.button is not None and bound.button >= binding.buttons:
            raise ValueError(f"buttons.{key}.button {bound.button} must be below {binding.buttons}")
        if bound.hat is not None and binding.hats == 0:
            raise ValueError(f"buttons.{key}.hat must not be given: {binding.name} has none")
    if profile.shifter.on == binding.role:
        for button in (*profile.shifter.gears, profile.shifter.reverse):
            if button is not None and button >= binding.buttons:
                raise ValueError(f"shifter button {button} must be below {binding.buttons}")


ButtonName: TypeAlias = Literal[
    "autonomous",
    "manual",
    "emergency_stop",
    "reset",
    "shift_up",
    "shift_down",
    "indicator_left",
    "indicator_right",
    "mark",
    "pause",
    "restart",
    "takeover",
    "shared",
    "fault",
    "hazard",
    "handbrake_button",
    "horn",
]


class ScriptPoint(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What the person does at one instant. A key left out is interpolated to its next mention."""

    time_s: Annotated[float, Meta(ge=0.0, le=86_400.0)]
    throttle: Share | None = None
    brake: Share | None = None
    clutch: Share | None = None
    handbrake: Share | None = None
    hand_wheel_deg: Annotated[float, Meta(ge=-1260.0, le=1260.0)] | None = None
    gear: Annotated[int, Meta(ge=-1, le=7)] | None = None
    press: list[ButtonName] = []  # held for 0.2 s


class ScriptProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A person as a script: pedals and wheel go in straight lines from mention to mention, the lever in steps."""

    schema: Literal[1] = 1
    title: Title = ""
    points: Annotated[list[ScriptPoint], Meta(min_length=1, max_length=100_000)]

    def __post_init__(self) -> None:
        """Refuse points whose time does not grow.

        Raises:
            ValueError: names the first such point.
        """
        for index in range(1, len(self.points)):
            earlier, later = self.points[index - 1].time_s, self.points[index].time_s
            if later <= earlier:
                raise ValueError(f"points[{index}].time_s {later} must be above {earlier}, time only goes forward")
