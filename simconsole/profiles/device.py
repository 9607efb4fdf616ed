"""The cockpit profile: which devices make one cockpit and what their axes and buttons mean; the script of a drive."""

from typing import Annotated, Literal, NamedTuple, TypeAlias

from msgspec import Meta, Struct

from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.profiles.parts.axes import MIN_TRAVEL_RAW, PedalAxis, WheelAxis
from simconsole.profiles.parts.ranges import Title

RoleName: TypeAlias = Literal["wheel", "pedals", "shifter", "handbrake"]
UsbId: TypeAlias = Annotated[int, Meta(ge=0, le=0xFFFF)]
ButtonIndex: TypeAlias = Annotated[int, Meta(ge=0, le=127)]

ButtonLabel: TypeAlias = Annotated[str, Meta(min_length=1, max_length=16)]
"""What is printed on a button, or what it is called."""

MAX_BUTTONS = 128
"""As many as Windows tells of one device (DIJOYSTATE2)."""
MOST_MEANINGS = 24
"""Buttons of one device that may have a meaning: a state vector holds so many of each."""


class DeviceKey(NamedTuple):
    """One device: USB vendor and product id, and where several of them are plugged in the port of this one."""

    vendor_id: int
    product_id: int
    port: str = ""


class OtherDevice(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A device that plays the same role with the same numbers, used where the first one is not there."""

    vendor_id: UsbId
    """USB vendor number of the other device, as `simconsole devices list` says."""
    product_id: UsbId
    """USB product number of the other device, as `simconsole devices list` says."""
    name: Title
    """What the other device is called; shown to people, never compared."""
    axes: Annotated[int, Meta(ge=0, le=32)]
    """How many axes the other device has at least."""
    buttons: Annotated[int, Meta(ge=0, le=MAX_BUTTONS)]
    """How many buttons the other device has at least."""


class RoleBinding(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One role and the device that plays it, found by its USB identity, never by its number or name."""

    role: RoleName
    """What the device is in the cockpit."""
    vendor_id: UsbId
    """USB vendor number of the device, as `simconsole devices list` says."""
    product_id: UsbId
    """USB product number of the device, as `simconsole devices list` says."""
    name: Title
    """What the device's firmware calls itself; shown to people, never compared."""
    port: Title = ""
    """Where this device is plugged in, as `simconsole devices list` says; needed where two devices have one number."""
    axes: Annotated[int, Meta(ge=0, le=32)]
    """How many axes the device has at least."""
    buttons: Annotated[int, Meta(ge=0, le=MAX_BUTTONS)]
    """How many buttons the device has at least."""
    hats: Annotated[int, Meta(ge=0, le=4)] = 0
    """How many hats (direction pads) the device has at least."""
    button_labels: Annotated[list[ButtonLabel], Meta(max_length=MAX_BUTTONS)] = []
    """What is printed on button 0, 1 and so on, for the display; a button without a label is called by its number."""
    others: Annotated[list[OtherDevice], Meta(max_length=8)] = []
    """Devices with the same axes and buttons that are used where this one is not there; only for a shifter."""

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
    """USB vendor number under which the device answers while it cannot drive."""
    product_id: UsbId
    """USB product number under which the device answers while it cannot drive."""
    cure: Title
    """What a person must do so that the device can drive; shown to them."""


class Pedals(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The pedals, on the device of the role `pedals`; the handbrake on its own where the role `handbrake` is bound."""

    throttle: PedalAxis
    """Axis of the throttle. It may share the brake's axis if the two go to opposite sides of one rest."""
    brake: PedalAxis
    """Axis of the brake."""
    clutch: PedalAxis | None = None
    """Axis of the clutch; left out, there is none."""
    handbrake: PedalAxis | None = None
    """Axis of the handbrake, on its own device where `roles` bind one; left out, there is none."""

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
    """How the lever works: `h` has one button for each gear, `sequential` has one to shift up and one down."""
    on: Literal["wheel", "shifter"] = "shifter"
    """The role on whose device the lever's buttons are."""
    gears: Annotated[list[ButtonIndex], Meta(max_length=7)] = []
    """Button of gear 1, 2 and so on; at least one where `pattern` is `h`. All differ from each other and from
    `reverse`."""
    reverse: ButtonIndex | None = None
    """Button of the reverse gear; left out, there is none."""
    top_gear: Annotated[int, Meta(ge=1, le=7)] = 6
    """Highest gear of a sequential lever."""
    neutral_dwell_s: Annotated[float, Meta(ge=0.0, le=1.0)] = 0.1
    """How long no gear must be in before it counts as neutral: between two gears there is a moment without one."""


class ButtonBinding(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A button by its number on the device of a role, or a direction of the wheel's hat."""

    on: Literal["wheel", "shifter"] = "wheel"
    """The role on whose device the button is; `wheel` where `hat` is given."""
    button: ButtonIndex | None = None
    """Number of the button on its device, from 0. Exactly one of `button` and `hat` is given."""
    hat: Literal["left", "right", "up", "down"] | None = None
    """Direction of the wheel's hat (direction pad) that takes the place of a button."""

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
    """Asks for autonomous driving; left out, no button does."""
    manual: ButtonBinding | None = None
    """Asks for driving by hand; left out, no button does."""
    emergency_stop: ButtonBinding | None = None
    """Stops the car at once with the full brake; left out, no button does."""
    reset: ButtonBinding | None = None
    """Ends an emergency stop or another stop once the car stands; left out, no button does."""
    shift_up: ButtonBinding | None = None
    """Shifts one gear up with a sequential lever; left out, no button does."""
    shift_down: ButtonBinding | None = None
    """Shifts one gear down with a sequential lever; left out, no button does."""
    indicator_left: ButtonBinding | None = None
    """Switches the left turn indicator; left out, no button does."""
    indicator_right: ButtonBinding | None = None
    """Switches the right turn indicator; left out, no button does."""
    mark: ButtonBinding | None = None
    """Puts a mark into the recording at this moment; left out, no button does."""
    pause: ButtonBinding | None = None
    """Lets simulated time stand, and go on again; left out, no button does."""
    restart: ButtonBinding | None = None
    """Begins the drive anew from its start; left out, no button does."""
    takeover: ButtonBinding | None = None
    """Raises a request to take over, as a controller can; left out, no button does."""
    shared: ButtonBinding | None = None
    """Asks for shared control; left out, no button does."""
    fault: ButtonBinding | None = None
    """Raises the event `fault`, which faults with `on_event: fault` wait for; left out, no button does."""
    hazard: ButtonBinding | None = None
    """Switches the hazard lights; left out, no button does."""
    handbrake_button: ButtonBinding | None = None
    """A handbrake that is a button: pulled fully while it is held; left out, there is none."""
    horn: ButtonBinding | None = None
    """Sounds the horn while it is held; left out, no button does."""


class Limits(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """When an input counts as at rest, and how long a silent one is held (facts: 100 ms)."""

    arming: Annotated[float, Meta(gt=0.0, le=0.2)] = 0.05
    """Share of the travel below which a pedal counts as released when the cockpit is armed."""
    stale_s: Annotated[float, Meta(gt=0.0, le=0.5)] = 0.1
    """An input that says nothing for longer than this counts as lost."""
    rearm_deg: Annotated[float, Meta(gt=0.0, le=90.0)] = 5.0
    """A wheel that was lost obeys again when it is this near to the car's own steering."""


class Provenance(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Source of a part of the profile, so that no guess is mistaken for a measurement."""

    status: Literal["captured", "documented", "unverified", "chosen"]
    """Whether the values were measured on the device, are documented, unverified, or simply chosen."""
    source: Title
    """Where the values come from: a file, a page, a date."""


class CockpitProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Devices that make one cockpit, in whatever order they are plugged in."""

    schema: Literal[1]
    """Version of this kind of file; always 1."""
    title: Title
    """Name of the cockpit for people."""
    roles: list[RoleBinding] = []
    """Which device is wheel, pedals and shifter, each bound once, and a handbrake if there is one; empty for a cockpit
    of keys."""
    boot_modes: list[BootMode] = []
    """Other identities of these devices, under which they cannot drive, each with its cure."""
    wheel: WheelAxis
    """How the axis of the hand wheel is read."""
    pedals: Pedals
    """How the axes of the pedals are read."""
    shifter: Shifter
    """How the lever's buttons are read."""
    buttons: Buttons = Buttons()
    """What the other buttons mean."""
    limits: Limits = Limits()
    """When an input counts as at rest and when as lost; without it the defaults."""
    force_feedback: ForceFeedback | None = None
    """The wheel's motor and how the wheel should feel; left out, the wheel has no motor."""
    provenance: dict[str, Provenance] = {}
    """Where values come from, by dotted key; the longest key that fits counts. Nothing is computed with it."""

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
