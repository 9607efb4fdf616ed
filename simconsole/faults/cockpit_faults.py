"""Faults between the devices and the console: each turns a true sample into a wrong one. Pure and seeded.

They act in the order of the list, each on the result of the one before.
"""

from collections import deque
from collections.abc import Callable, Sequence
from typing import Any, Final, TypeAlias

from simconsole.devices.calibration.cockpit_settings import SHIFTER_SHIFT, CockpitSettings
from simconsole.devices.calibration.inverse_calibration import WHEEL_MASK, button_masks
from simconsole.devices.force_feedback.motor import Source
from simconsole.faults.switched import Switched
from simconsole.profiles.device import CockpitProfile, RoleName
from simconsole.profiles.faults import (
    Burst,
    DeviceFault,
    Fault,
    Freeze,
    Invalid,
    Late,
    Noise,
    Stuck,
    Swapped,
    TwoGears,
    Unplug,
)
from simconsole.values.errors import ProfileError
from simconsole.values.kernels import clip
from simconsole.values.signals import NEVER_TICKS, NO_SAMPLE, DeviceSample

AGES: Final[dict[RoleName, str]] = {
    "wheel": "wheel_age_ticks",
    "pedals": "pedals_age_ticks",
    "shifter": "shifter_age_ticks",
    "handbrake": "handbrake_age_ticks",
}
AXES: Final[dict[RoleName, tuple[str, ...]]] = {
    "wheel": ("wheel_axis",),
    "pedals": ("throttle_axis", "brake_axis", "clutch_axis"),
    "shifter": (),
    "handbrake": ("handbrake_axis",),
}
_REST: Final[dict[RoleName, tuple[str, ...]]] = {
    "wheel": ("wheel_buttons", "hat_x", "hat_y", "wheel_motor"),
    "pedals": (),
    "shifter": ("shifter_buttons",),
    "handbrake": (),
}
_READINGS: Final = {
    "not_a_number": float("nan"),
    "infinite": float("inf"),
    "minus_infinite": float("-inf"),
    "huge": 1e308,
}

Values: TypeAlias = dict[str, float]
Effect: TypeAlias = Callable[[DeviceSample, int, int], DeviceSample]
"""(sample, tick, ticks that the fault has been on, 0: off) -> sample."""


class FaultyDevices:
    """A source whose samples pass through faults."""

    def __init__(
        self,
        source: Source,
        faults: Sequence[tuple[Fault, Switched]],
        cockpit: CockpitProfile,
        settings: CockpitSettings,
        tick_hz: int,
    ) -> None:
        """Wrap a source.

        Args:
            source: The true cockpit.
            faults: The faults to apply, each with its switch; all of them `DeviceFault`s.
            cockpit: Its profile: which roles hang on one plug.
            settings: The same as numbers.
            tick_hz: The session's tick rate.

        Raises:
            ProfileError: a fault shows a gear that this cockpit has not.
        """
        self._source = source
        self._effects = [(effect(fault, cockpit, settings, tick_hz), switch) for fault, switch in faults]

    def poll(self, tick: int) -> DeviceSample:
        """Return the sample of `tick` as the faults leave it."""
        sample = self._source.poll(tick)
        for act, switch in self._effects:
            sample = act(sample, tick, switch.ticks)
        return sample if sample.wheel_age_ticks == 0.0 else sample._replace(wheel_motor=0.0)

    def close(self) -> None:
        """Release the devices."""
        self._source.close()


def effect(fault: Fault, cockpit: CockpitProfile, settings: CockpitSettings, tick_hz: int) -> Effect:
    """Return what a fault does to samples, with a memory of its own.

    Raises:
        ProfileError: it shows a gear that this cockpit has not.
        TypeError: it is no fault of a device.
    """
    match fault:
        case Unplug():
            return _unplugged(_on_plug(fault.device, cockpit))
        case Freeze():
            return _Frozen(_on_plug(fault.device, cockpit))
        case Stuck():
            return _StuckAxis(f"{fault.axis}_axis", fault.raw)
        case Swapped():
            return _swapped(f"{fault.axis}_axis", f"{fault.other}_axis")
        case Noise():
            return _noisy((f"{fault.axis}_axis",), fault.amplitude_raw, fault.seed, 1)
        case Late():
            return _Delayed(_on_plug(fault.device, cockpit), max(1, round(fault.by_ms * tick_hz / 1000)), fault.stamped)
        case Invalid():
            return _constant({f"{fault.axis}_axis": _READINGS[fault.reading]})
        case Burst():
            names = tuple(name for role in _on_plug(fault.device, cockpit) for name in AXES[role])
            return _noisy(names, fault.amplitude_raw, fault.seed, max(1, fault.events_per_s // tick_hz))
        case TwoGears():
            return _second_gear(fault.gear, cockpit, settings)
    raise TypeError(f"{type(fault).__name__} is none of {DeviceFault}")


def _on_plug(device: RoleName, cockpit: CockpitProfile) -> tuple[RoleName, ...]:
    """Return every role on the same USB plug: pedals behind the wheel base go with it, a handbrake with its pedals."""
    plugs: dict[RoleName, object] = dict(zip(AGES, AGES, strict=True))
    plugs |= {binding.role: (binding.vendor_id, binding.product_id) for binding in cockpit.roles}
    if cockpit.played_by("handbrake") == "pedals":
        plugs["handbrake"] = plugs["pedals"]
    return tuple(role for role in AGES if plugs[role] == plugs[device])


def _fields(roles: Sequence[RoleName]) -> tuple[str, ...]:
    return tuple(name for role in roles for name in (*AXES[role], *_REST[role]))


def _part(sample: DeviceSample, names: Sequence[str]) -> Values:
    return {name: getattr(sample, name) for name in names}


def _with(sample: DeviceSample, values: Values) -> DeviceSample:
    changes: dict[str, Any] = values
    return sample._replace(**changes)


def _constant(values: Values) -> Effect:
    return lambda sample, tick, ticks: _with(sample, values) if ticks else sample


def _unplugged(roles: Sequence[RoleName]) -> Effect:
    return _constant(dict.fromkeys(_fields(roles), 0.0) | {AGES[role]: NEVER_TICKS for role in roles})


def _swapped(one: str, other: str) -> Effect:
    def act(sample: DeviceSample, tick: int, ticks: int) -> DeviceSample:
        if not ticks:
            return sample
        return _with(sample, {one: getattr(sample, other), other: getattr(sample, one)})

    return act


def _noisy(names: Sequence[str], amplitude_raw: float, seed: int, draws: int) -> Effect:
    """Add noise; of `draws` events in a tick the newest counts. An axis cannot leave its range, whatever shakes it."""

    def act(sample: DeviceSample, tick: int, ticks: int) -> DeviceSample:
        if not ticks:
            return sample
        changed = {}
        for place, name in enumerate(names):
            share = 0.0
            for event in range(draws):
                share = drawn(seed, tick, place, event)
            changed[name] = clip(getattr(sample, name) + amplitude_raw * share, -1.0, 1.0)
        return _with(sample, changed)

    return act


def drawn(seed: int, tick: int, place: int, event: int = 0) -> float:
    """Return a number from -1 to 1 (not included) that depends on nothing but the arguments.

    The mixing function of SplitMix64 (Steele, Lea, Flood: Fast Splittable Pseudorandom Number Generators, 2014).
    """
    state = seed
    for step in (tick, place, event):
        state = (state + step + 1) * 0x9E3779B97F4A7C15 & 0xFFFFFFFFFFFFFFFF
        state = (state ^ state >> 30) * 0xBF58476D1CE4E5B9 & 0xFFFFFFFFFFFFFFFF
        state = (state ^ state >> 27) * 0x94D049BB133111EB & 0xFFFFFFFFFFFFFFFF
        state ^= state >> 31
    return (state >> 11) / 2.0**52 - 1.0


def _second_gear(gear: int, cockpit: CockpitProfile, settings: CockpitSettings) -> Effect:
    masks = (0, 0) if settings.sequential else button_masks(float(gear), 0, settings)[:2]
    if not any(masks):
        raise ProfileError(f"{cockpit.title}: faults: gear: value {gear}: a gear that the H pattern of the shifter has")
    wheel, shifter = masks[0] & WHEEL_MASK, masks[1] & (1 << SHIFTER_SHIFT) - 1

    def act(sample: DeviceSample, tick: int, ticks: int) -> DeviceSample:
        if not ticks:
            return sample
        return sample._replace(
            wheel_buttons=float(int(sample.wheel_buttons) | wheel),
            shifter_buttons=float(int(sample.shifter_buttons) | shifter),
        )

    return act


class _StuckAxis:
    def __init__(self, name: str, raw: float | None) -> None:
        self._name = name
        self._raw = raw
        self._held = 0.0

    def __call__(self, sample: DeviceSample, tick: int, ticks: int) -> DeviceSample:
        if not ticks:
            self._held = getattr(sample, self._name) if self._raw is None else self._raw
            return sample
        return _with(sample, {self._name: self._held})


class _Frozen:
    """Holds the values of the last tick before the fault; their ages grow with every tick."""

    def __init__(self, roles: Sequence[RoleName]) -> None:
        self._names = _fields(roles)
        self._ages = tuple(AGES[role] for role in roles)
        self._before = NO_SAMPLE

    def __call__(self, sample: DeviceSample, tick: int, ticks: int) -> DeviceSample:
        if not ticks:
            self._before = sample
            return sample
        ages = {name: min(NEVER_TICKS, getattr(self._before, name) + ticks) for name in self._ages}
        return _with(sample, _part(self._before, self._names) | ages)


class _Delayed:
    """Returns what the device said some ticks ago; until the delay has passed once, the device is absent."""

    def __init__(self, roles: Sequence[RoleName], delay_ticks: int, stamped: bool) -> None:
        self._names = _fields(roles)
        self._ages = tuple(AGES[role] for role in roles)
        self._delay_ticks = delay_ticks
        self._stamped = stamped
        self._past: deque[DeviceSample] = deque(maxlen=delay_ticks + 1)

    def __call__(self, sample: DeviceSample, tick: int, ticks: int) -> DeviceSample:
        self._past.append(sample)
        if not ticks:
            return sample
        old = self._past[0] if len(self._past) > self._delay_ticks else NO_SAMPLE
        older = float(self._delay_ticks) if self._stamped else 0.0
        ages = {name: min(NEVER_TICKS, getattr(old, name) + older) for name in self._ages}
        return _with(sample, _part(old, self._names) | ages)
