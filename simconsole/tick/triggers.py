"""Whether a trigger of a drive has come: a time, a place, a way, a speed, a gap, a mode or an edge. Pure."""

from typing import NamedTuple

from simconsole.profiles.faults import Trigger
from simconsole.values.layout import read
from simconsole.values.signals import FAR, Button, Event, Mode
from simconsole.values.state_vector import LAYOUT, Snapshot


class WatchedVehicle(NamedTuple):
    """Whom a trigger looks at, at one instant."""

    x_m: float
    y_m: float
    distance_m: float  # driven since the start
    speed_mps: float  # not negative
    gap_m: float  # to somebody else; FAR: nobody
    closing_mps: float  # by which that gap shrinks


class TriggerWatch:
    """Watches for one trigger, tick by tick; once reached it stays so."""

    def __init__(self, trigger: Trigger, tick_hz: int, rising: bool = False) -> None:
        """Watch for `trigger`; a `rising` one must be seen not to be so first, a time is not looked at."""
        self._trigger, self._tick_hz = trigger, tick_hz
        self._delay = round(trigger.delay_s * tick_hz)
        self._start = None if trigger.at_s is None else round(trigger.at_s * tick_hz) + self._delay
        self._was_faster = False
        self._was = rising

    def turn(self, tick: int, before: Snapshot, seen: WatchedVehicle | None = None) -> int | None:
        """Return the tick at which it begins, None where that is not known yet.

        Args:
            tick: the coming tick.
            before: the tick before it.
            seen: whom it looks at; the console's vehicle, if it is left out.
        """
        if self._start is None:
            reached = self._reached(before, own_vehicle(before) if seen is None else seen)
            self._was = self._was and reached
            if reached and not self._was:
                self._start = tick + self._delay
        return self._start

    def _reached(self, before: Snapshot, seen: WatchedVehicle) -> bool:
        trigger = self._trigger
        if trigger.at_distance_m is not None:
            return seen.distance_m >= trigger.at_distance_m
        if trigger.near is not None:
            x, y = seen.x_m - trigger.near.x_m, seen.y_m - trigger.near.y_m
            return x * x + y * y <= trigger.near.radius_m * trigger.near.radius_m
        if trigger.above_mps is not None:
            return seen.speed_mps > trigger.above_mps
        if trigger.below_mps is not None:
            self._was_faster = self._was_faster or seen.speed_mps >= trigger.below_mps
            return self._was_faster and seen.speed_mps < trigger.below_mps
        if trigger.on_mode is not None:
            return before.arbitration.mode == float(Mode[trigger.on_mode.upper()])
        if trigger.on_event is not None:
            pressed = int(before.driver.edges) & Button.FAULT and trigger.on_event == "fault"
            return bool(int(before.events.events) & Event[trigger.on_event.upper()] or pressed)
        return _near_in_front(trigger, seen)


def _near_in_front(trigger: Trigger, seen: WatchedVehicle) -> bool:
    """Return whether a gap is short enough; times are compared as products, for a speed may be 0."""
    if seen.gap_m >= FAR:
        return False
    if trigger.gap_below_m is not None:
        return seen.gap_m < trigger.gap_below_m
    if trigger.headway_below_s is not None:
        return seen.gap_m < trigger.headway_below_s * seen.speed_mps
    return trigger.collision_below_s is not None and seen.gap_m < trigger.collision_below_s * seen.closing_mps


def own_vehicle(before: Snapshot) -> WatchedVehicle:
    """Return the console's vehicle after a tick, and its gap to whom it follows."""
    vehicle, ahead = before.vehicle, read(before.vector, LAYOUT.ahead)
    return WatchedVehicle(
        x_m=vehicle.x_m,
        y_m=vehicle.y_m,
        distance_m=vehicle.distance_m,
        speed_mps=abs(vehicle.vx_mps),
        gap_m=ahead.lead_gap_m,
        closing_mps=vehicle.vx_mps - ahead.lead_speed_mps,
    )
