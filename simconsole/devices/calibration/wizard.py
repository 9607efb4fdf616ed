"""Calibration step by step: the questions, their order, and the resulting profile.

It reaches the outside through three functions: ask a question, print a line, read the devices while they are held.
"""

import itertools
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, Literal, TypeVar

import msgspec

from simconsole.devices.calibration.input_detection import (
    BUTTONS,
    HATS,
    AxisAt,
    ButtonAt,
    SteadyReadings,
    moved_axis,
    pedal_axis_of,
    pressed_button,
    wheel_axis_of,
)
from simconsole.profiles.device import (
    ButtonBinding,
    Buttons,
    CockpitProfile,
    DeviceKey,
    Pedals,
    Provenance,
    RoleBinding,
    Shifter,
)
from simconsole.profiles.parts.axes import PedalAxis, WheelAxis
from simconsole.values.errors import DeviceError

Ask = Callable[[str, str], str]
"""Puts a question about a step (`throttle`, `gear 3`, ...) and returns what was typed: nothing means go on."""
Look = Callable[[], SteadyReadings]
Say = Callable[[str], None]
Learnt = TypeVar("Learnt")

SKIP: Final = "s"
QUIT: Final = "q"
TRIES: Final = 5
PEDALS: Final = ("throttle", "brake", "clutch", "handbrake")
NEEDED: Final = ("throttle", "brake")
UNLEARNT: Final = ("boot_modes", "force_feedback", "limits", "roles.0.button_labels")
TUNED: Final = (".curve", ".dead_zone", ".rate_filter_s", ".assistance", ".top_gear", ".neutral_dwell_s")
"""Keys, by how they begin and end, whose values a profile that knows the wheel gives."""
_GEARS: Final = 7


class Skipped(Exception):  # nothing went wrong
    """The person has no such part (pedal, lever, button)."""


class Entry(msgspec.Struct, frozen=True):
    """A device that is plugged in: its name, and how many axes, buttons and hats it has."""

    name: str
    axes: int
    buttons: int
    hats: int


class Wizard:
    """Asks for one input after the other until a profile is complete."""

    def __init__(
        self,
        base: CockpitProfile,
        entries: dict[DeviceKey, Entry],
        *,
        ask: Ask,
        say: Say,
        look: Look,
        known: Sequence[CockpitProfile] = (),
        learnt: Mapping[str, Any] | None = None,
        save: Callable[[dict[str, Any]], None] = lambda learnt: None,
    ) -> None:
        """Begin.

        Args:
            base: Gives the degrees that are offered, and the force feedback of a wheel that it knows.
            entries: Every device that is plugged in.
            ask: Puts a question.
            say: Prints a line.
            look: Reads all devices for a moment while they are held still.
            known: Other profiles; the first whose wheel is the one at hand takes the place of `base`.
            learnt: Steps that are done already, as `save` got them; they are not asked again.
            save: Takes all steps done so far, as plain values, after each of them.
        """
        self._base = base
        self._entries = entries
        self._ask = ask
        self._say = say
        self._look = look
        self._axes: list[tuple[DeviceKey, int]] = []
        self._pressed: list[ButtonAt] = []
        self._known = known
        self._learnt = dict(learnt or {})
        self._save = save
        self._unanswered: DeviceError | None = None

    def run(self, origin: str) -> CockpitProfile:
        """Ask everything and return the profile; `origin` says in it where the values come from.

        A step that fails is asked again until it succeeds or the person gives up.

        Raises:
            DeviceError: nobody answers.
            KeyboardInterrupt: the person gave up.
        """
        self._question("rest", "Hands and feet off everything, lever in neutral.")
        self._rest = self._look()
        wheel_key, wheel = self._learn_wheel()
        pedals_key, pedals, handbrake_key = self._learn_pedals()
        shifter_key, shifter = self._learn_lever(wheel_key)
        shifter_key, buttons = self._learn_buttons(wheel_key, shifter_key, shifter)
        keys = {"wheel": wheel_key, "pedals": pedals_key, "shifter": shifter_key}
        if handbrake_key not in (None, pedals_key):
            keys["handbrake"] = handbrake_key
        known = [(role.vendor_id, role.product_id) for role in self._base.roles if role.role == "wheel"]
        profile = CockpitProfile(
            schema=1,
            title=f"{self._entries[wheel_key].name}, calibrated",
            roles=[self._role(role, key) for role, key in keys.items()],
            wheel=wheel,
            pedals=pedals,
            shifter=shifter,
            buttons=buttons,
            provenance=_provenance(origin),
        )
        return _with_unlearnt(profile, self._base) if known == [wheel_key[:2]] else profile

    def _learn_wheel(self) -> tuple[DeviceKey, WheelAxis]:
        def learn() -> tuple[DeviceKey, WheelAxis]:
            left = self._moved("left", "Turn the wheel fully to the LEFT and hold it.")
            right = self._moved("right", "Turn the wheel fully to the RIGHT and hold it.")
            self._question("centre", "Turn the wheel straight ahead and hold it.")
            centre = self._look()
            self._base = self._profile_of(left.device)
            return left.device, wheel_axis_of(left, right, centre, self._degrees())

        key, wheel = self._tried("wheel", tuple[DeviceKey, WheelAxis], learn)
        self._base = self._profile_of(key)
        self._axes.append((key, wheel.axis))
        return key, wheel

    def _profile_of(self, key: DeviceKey) -> CockpitProfile:
        """Return the profile that knows this wheel, the base itself where none does."""
        for profile in (self._base, *self._known):
            if any(role.role == "wheel" and role.key[:2] == key[:2] for role in profile.roles):
                return profile
        return self._base

    def _degrees(self) -> float:
        offered = self._base.wheel.lock_to_lock_deg
        while True:
            typed = self._question("degrees", f"How many degrees does it turn from lock to lock? [{offered:g}]")
            try:
                degrees = float(typed) if typed else offered
            except ValueError:
                degrees = 0.0
            if 40.0 <= degrees <= 2520.0:
                return degrees
            self._say(f"  again, please: degrees: value {typed}: 40 to 2520")

    def _learn_pedals(self) -> tuple[DeviceKey, Pedals, DeviceKey | None]:
        """Learn the pedals, all on one device; the handbrake may be on another, which comes last."""
        found: dict[str, PedalAxis] = {}
        keys: dict[str, DeviceKey] = {}
        for name in PEDALS:

            def learn(name: str = name) -> tuple[AxisAt, PedalAxis]:
                skip = "" if name in NEEDED else f" ({SKIP}: there is none)"
                # The last one learnt is the throttle's, to whose other side the brake may be.
                taken = self._axes[:-1] if name == "brake" else self._axes
                at = self._moved(name, f"Press the {name.upper()} fully and hold it{skip}.", name not in NEEDED, taken)
                if name != "handbrake" and at.device != keys.get("throttle", at.device):
                    raise DeviceError(f"{name}: value on another device: all pedals on one device")
                pedal = pedal_axis_of(self._rest, at)
                if name == "brake":
                    _refuse_one_side(found["throttle"], pedal)
                return at, pedal

            try:
                at, found[name] = self._tried(name, tuple[AxisAt, PedalAxis], learn)
            except Skipped:
                continue
            keys[name] = at.device
            self._axes.append((at.device, at.axis))
        return keys["throttle"], Pedals(**found), keys.get("handbrake")

    def _learn_lever(self, wheel_key: DeviceKey) -> tuple[DeviceKey, Shifter]:
        def learn() -> bool:
            return self._question("lever", f"H pattern: go on. Sequential lever or paddles: {SKIP}.") == SKIP

        if self._tried("lever", bool, learn):
            return wheel_key, Shifter(pattern="sequential", on="wheel")
        gears: list[ButtonAt] = []
        for gear in range(1, _GEARS + 1):
            at = self._gear(gear, f"gear {gear}", gears)
            if at is None:
                break
            gears.append(at)
        back = self._gear(-1, "reverse", gears)
        key = gears[0].device
        on: Any = "wheel" if key == wheel_key else "shifter"
        reverse = None if back is None else back.button
        return key, Shifter(pattern="h", on=on, gears=[at.button for at in gears], reverse=reverse)

    def _gear(self, gear: int, name: str, others: list[ButtonAt]) -> ButtonAt | None:
        optional = gear != 1
        skip = f" ({SKIP}: there is none)" if optional else ""

        def learn() -> ButtonAt:
            at = self._button(f"gear {gear}", f"Lever into {name.upper()}{skip}.", optional)
            if others and at.device != others[0].device:
                raise DeviceError(f"{name}: value on another device: all gears on one device")
            return at

        try:
            found = self._tried(f"gear {gear}", ButtonAt, learn)
        except Skipped:
            return None
        self._pressed.append(found)
        return found

    def _learn_buttons(
        self, wheel_key: DeviceKey, shifter_key: DeviceKey, shifter: Shifter
    ) -> tuple[DeviceKey, Buttons]:
        """Learn the buttons; those of a sequential lever may make its device the shifter."""
        found: dict[str, ButtonBinding] = {}
        shifters = [shifter_key]
        self._question("neutral", "Lever into neutral, hands off the buttons.")
        for name in Buttons.__struct_fields__:
            needed = shifter.pattern == "sequential" and name.startswith("shift_")

            def learn(name: str = name, needed: bool = needed) -> ButtonAt:
                skip = "" if needed else f" ({SKIP}: none)"
                at = self._button(name, f"Hold the button for {name.replace('_', ' ').upper()}{skip}.", not needed)
                becomes_shifter = needed and shifters == [wheel_key]
                if at.device not in (wheel_key, shifters[0]) and not becomes_shifter:
                    raise DeviceError(f"{name}: value on another device: a button of the wheel or the shifter")
                if at.button >= BUTTONS and at.device != wheel_key:
                    raise DeviceError(f"{name}: value the hat of the shifter: one of its buttons, or the wheel's hat")
                return at

            try:
                at = self._tried(name, ButtonAt, learn)
            except Skipped:
                continue
            if at.device != wheel_key:
                shifters[0] = at.device
            self._pressed.append(at)
            on: Literal["wheel", "shifter"] = "wheel" if at.device == wheel_key else "shifter"
            if at.button < BUTTONS:
                found[name] = ButtonBinding(on=on, button=at.button)
            else:
                found[name] = ButtonBinding(on=on, hat=HATS[at.button - BUTTONS])
        return shifters[0], Buttons(**found)

    def _moved(
        self, step: str, text: str, optional: bool = False, taken: Sequence[tuple[DeviceKey, int]] = ()
    ) -> AxisAt:
        self._question(step, text, optional)
        return moved_axis(self._rest, self._look(), taken)

    def _button(self, step: str, text: str, optional: bool) -> ButtonAt:
        self._question(step, text, optional)
        return pressed_button(self._rest, self._look(), self._pressed)

    def _question(self, step: str, text: str, optional: bool = False) -> str:
        try:
            typed = self._ask(step, text).strip().lower()
        except DeviceError as error:
            self._unanswered = error
            raise
        if typed == QUIT:
            raise KeyboardInterrupt
        if typed == SKIP and optional:
            raise Skipped
        return typed

    def _tried(self, step: str, kind: type[Learnt], learn: Callable[[], Learnt]) -> Learnt:
        """Return what a step learns, or has learnt before; one that fails is explained and asked again.

        Raises:
            Skipped: the person has no such part.
        """
        if step in self._learnt:
            if self._learnt[step] is None:
                raise Skipped
            return msgspec.convert(self._learnt[step], kind)
        for tries in itertools.count(1):
            try:
                found = learn()
            except Skipped:
                self._keep(step, None)
                raise
            except DeviceError as error:
                if error is self._unanswered:
                    raise
                self._say(f"  again, please: {error}")
                if tries % TRIES == 0:
                    self._say(f"  {QUIT} gives up for now: what was learnt so far is kept")
            else:
                self._keep(step, msgspec.to_builtins(found))
                return found
        raise AssertionError("unreachable")  # the count has no end

    def _keep(self, step: str, plain: Any) -> None:
        self._learnt[step] = plain
        self._save(self._learnt)

    def _role(self, role: Any, key: DeviceKey) -> RoleBinding:
        entry = self._entries[key]
        same = [known for known in self._base.roles if known.key[:2] == key[:2]]
        return RoleBinding(
            role=role,
            vendor_id=key[0],
            product_id=key[1],
            name=entry.name[:200],
            port=key.port,
            axes=min(entry.axes, 32),
            buttons=min(entry.buttons, BUTTONS),
            hats=min(entry.hats, 4),
            button_labels=next((known.button_labels for known in same if known.role == role), []),
        )


def _provenance(origin: str) -> dict[str, Provenance]:
    captured = Provenance(status="captured", source=origin)
    found = dict.fromkeys(("roles", "wheel", "pedals", "shifter", "buttons"), captured)
    found["wheel.lock_to_lock_deg"] = Provenance(status="documented", source=f"the person's word, {origin}")
    return found


def _with_unlearnt(learnt: CockpitProfile, known: CockpitProfile) -> CockpitProfile:
    """Return a profile with what no step learns as the profile that knows its wheel has it."""
    replace = msgspec.structs.replace
    pedals = {}
    for name in PEDALS:
        pedal, before = getattr(learnt.pedals, name), getattr(known.pedals, name)
        if pedal is not None and before is not None:
            dead_zone = max(pedal.dead_zone, before.dead_zone)
            pedals[name] = replace(pedal, curve=before.curve, dead_zone=dead_zone)
    kept = {key: of for key, of in known.provenance.items() if key.startswith(UNLEARNT) or key.endswith(TUNED)}
    wheel = learnt.wheel
    return replace(
        learnt,
        boot_modes=known.boot_modes,
        wheel=replace(
            known.wheel,
            axis=wheel.axis,
            lock_to_lock_deg=wheel.lock_to_lock_deg,
            grows_to=wheel.grows_to,
            centre_raw=wheel.centre_raw,
        ),
        pedals=replace(learnt.pedals, **pedals),
        shifter=replace(learnt.shifter, top_gear=known.shifter.top_gear, neutral_dwell_s=known.shifter.neutral_dwell_s),
        limits=known.limits,
        force_feedback=known.force_feedback,
        provenance={**learnt.provenance, **kept},
    )


def _refuse_one_side(throttle: PedalAxis, brake: PedalAxis) -> None:
    try:
        Pedals(throttle=throttle, brake=brake)
    except ValueError:
        raise DeviceError(f"brake: value axis {brake.axis}, as the throttle: another axis, or its other side") from None
