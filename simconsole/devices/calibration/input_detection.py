"""Detection of inputs in raw readings: which axis moved, where it rests and ends, which button is held. Pure.

Readings are taken while the person holds still, so that nothing here depends on how fast anybody moves.
"""

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

from simconsole.profiles.device import MAX_BUTTONS, DeviceKey
from simconsole.profiles.parts.axes import MIN_TRAVEL_RAW, PedalAxis, WheelAxis
from simconsole.values.errors import DeviceError

MOVED_RAW: Final = MIN_TRAVEL_RAW
"""An axis that is held further than this from its rest is the one that the person moves."""
CLEAR: Final = 2.0
"""The axis that the person moves goes this many times as far as any other."""
LEAST_DEAD_ZONE: Final = 0.02
MOST_DEAD_ZONE: Final = 0.3
BUTTONS: Final = MAX_BUTTONS
"""How many buttons of a device are looked at; the four directions of its hat follow them (cockpit_settings.py)."""
HATS: Final = ("left", "right", "up", "down")
END_MARGIN: Final = 0.01
"""Share of a pedal's travel that is left out at its end, so that a foot reaches all of it every time."""


class Reading(NamedTuple):
    """One device at one instant."""

    axes: tuple[float, ...]  # -1 to 1
    buttons: int  # mask, from bit `BUTTONS` on that of the hat


class SteadyReading(NamedTuple):
    """One device, held still for a moment."""

    mean: tuple[float, ...]
    spread: tuple[float, ...]  # largest minus smallest
    buttons: int  # held all the time


class AxisAt(NamedTuple):
    """An axis of a device, and where it was held."""

    device: DeviceKey
    axis: int
    raw: float


class ButtonAt(NamedTuple):
    """A button of a device."""

    device: DeviceKey
    button: int


SteadyReadings = dict[DeviceKey, SteadyReading]


def steady_readings(readings: Sequence[dict[DeviceKey, Reading]]) -> SteadyReadings:
    """Return what was held over some readings; a device that is missing in one of them is left out.

    Raises:
        DeviceError: an axis is not a number.
    """
    keys = set.intersection(*(set(reading) for reading in readings)) if readings else set()
    found = {}
    for key in sorted(keys):
        columns = list(zip(*(reading[key].axes for reading in readings), strict=True))
        if not all(math.isfinite(value) for column in columns for value in column):
            raise DeviceError(f"{key[0]:04x}:{key[1]:04x}: axes: value not finite: readings from -1 to 1")
        mask = ~0
        for reading in readings:
            mask &= reading[key].buttons
        found[key] = SteadyReading(
            tuple(sum(column) / len(column) for column in columns),
            tuple(max(column) - min(column) for column in columns),
            mask,
        )
    return found


def moved_axis(rest: SteadyReadings, now: SteadyReadings, taken: Sequence[tuple[DeviceKey, int]] = ()) -> AxisAt:
    """Return the one axis that is held away from its rest.

    Args:
        rest: Everything at rest.
        now: Held now.
        taken: Axes that have a meaning already: they are ignored.

    Raises:
        DeviceError: none is, or several are.
    """
    moves = []
    for key, held in now.items():
        for axis, value in enumerate(held.mean):
            if key in rest and (key, axis) not in taken:
                moves.append((abs(value - rest[key].mean[axis]), AxisAt(key, axis, value)))
    moves.sort(key=lambda move: -move[0])
    if not moves or moves[0][0] < MOVED_RAW:
        raise DeviceError(f"axes: value none moved: one that moves by {MOVED_RAW:g} of its half range")
    if len(moves) > 1 and moves[1][0] * CLEAR > moves[0][0]:
        raise DeviceError(f"axes: value {moves[0][1].axis} and {moves[1][1].axis} moved: only one")
    return moves[0][1]


def pressed_button(
    rest: SteadyReadings, now: SteadyReadings, taken: Sequence[ButtonAt] = (), buttons: int = BUTTONS + len(HATS)
) -> ButtonAt:
    """Return the one of the first `buttons` that is held and was not at rest.

    Raises:
        DeviceError: none is, several are, or it has a meaning already.
    """
    found = [
        ButtonAt(key, button)
        for key, held in now.items()
        if key in rest
        for button in range(buttons)
        if (held.buttons & ~rest[key].buttons) >> button & 1
    ]
    if len(found) != 1:
        numbers = " and ".join(str(at.button) for at in found) or "none"
        raise DeviceError(f"buttons: value {numbers} held: one, from the first {BUTTONS} of its device or its hat")
    if found[0] in taken:
        raise DeviceError(f"buttons: value {found[0].button}: another one, this has a meaning already")
    return found[0]


def pedal_axis_of(rest: SteadyReadings, pressed: AxisAt) -> PedalAxis:
    """Return a pedal from its rest and from where it was held fully pressed.

    The dead zone covers twice the noise at rest; the last percent of the travel is left out.
    """
    at_rest = rest[pressed.device]
    rest_raw = at_rest.mean[pressed.axis]
    span = pressed.raw - rest_raw
    dead = max(LEAST_DEAD_ZONE, 2.0 * at_rest.spread[pressed.axis] / abs(span))
    if dead > MOST_DEAD_ZONE:
        raise DeviceError(f"axis {pressed.axis}: noise at rest: value {dead:.0%} of its travel: at most 15%")
    return PedalAxis(
        axis=pressed.axis,
        rest_raw=_raw(rest_raw),
        full_raw=_raw(pressed.raw - END_MARGIN * span),
        dead_zone=round(math.ceil(dead * 1000.0 - 1e-6) / 1000.0, 3),
    )


def wheel_axis_of(left: AxisAt, right: AxisAt, centre: SteadyReadings, lock_to_lock_deg: float) -> WheelAxis:
    """Return the wheel from both locks and the middle.

    Args:
        left: Where the axis was held at the left lock.
        right: At the right lock.
        centre: Everything, with the wheel straight.
        lock_to_lock_deg: How far the wheel itself turns from lock to lock.

    Raises:
        DeviceError: two different axes moved, the range is small, or the middle lies outside of it.
    """
    if (left.device, left.axis) != (right.device, right.axis):
        raise DeviceError(f"wheel: value axes {left.axis} and {right.axis}: the same one to both sides")
    span = abs(right.raw - left.raw)
    middle = centre[left.device].mean[left.axis]
    if span < 2.0 * MOVED_RAW:
        raise DeviceError(f"wheel: value {span:.2f} from lock to lock: at least {2.0 * MOVED_RAW:g}")
    low, high = sorted((left.raw, right.raw))
    if not low + 0.25 * span <= middle <= high - 0.25 * span:
        raise DeviceError(f"wheel: value {middle:.2f} straight ahead: the middle of {low:.2f} to {high:.2f}")
    return WheelAxis(
        axis=left.axis,
        lock_to_lock_deg=round(lock_to_lock_deg * 2.0 / span, 1),  # the profile's is of the whole axis, -1 to 1
        grows_to="right" if right.raw > left.raw else "left",
        centre_raw=round(middle, 5),
    )


def _raw(value: float) -> float:
    return round(min(1.0, max(-1.0, value)), 5)
