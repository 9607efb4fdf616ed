"""One SUMO round several platforms: each is a vehicle of its, and has SUMO's road users and signals around it."""

from collections.abc import Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING

import numpy as np

from simconsole.session.fleet.company import Beside, Company
from simconsole.session.traffic_source import roads_and_period, sumo_beside
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import ProfileError
from simconsole.world.roads.road_map import Array
from simconsole.world.rules.running_signals import RunningSignals
from simconsole.world.traffic.road_users import Box

if TYPE_CHECKING:
    from simconsole.world.sumo_traffic.sumo_traffic import SumoTraffic


class SharedSumo:
    """Stepped once a period for all platforms, when all have made the period's ticks."""

    def __init__(self, sumo: "SumoTraffic", company: Company, tick_hz: int, period_ticks: int) -> None:
        """Take a SUMO that has the platforms of `company`, in their order, where they start."""
        self._sumo, self._company, self._tick_hz = sumo, company, tick_hz
        self.period_ticks = period_ticks

    def step(self, tick: int) -> None:
        """Let SUMO step if a period of its has ended with this tick, its vehicles of ours where they are now."""
        if tick % self.period_ticks == 0:
            self._sumo.step_all(self._company.boxes())

    def around(self, number: int) -> "OnSumo":
        """Return the road users of the platform of this number: all others of ours, and SUMO's."""
        return OnSumo(self._company.around(number), self._sumo, number, self._tick_hz)


class OnSumo:
    """What the traffic of one platform is made of: the other platforms, and SUMO's road users near it."""

    def __init__(self, beside: Beside, sumo: "SumoTraffic", number: int, tick_hz: int) -> None:
        """Take the other platforms; the platform is the vehicle of this number in SUMO."""
        self._beside, self._sumo, self._number = beside, sumo, number
        self.signals = RunningSignals(sumo.road_map, tick_hz)
        self.signals.take(sumo.signals.now)

    @property
    def lost(self) -> str | None:
        """Why SUMO moves nobody any more, None as long as it does."""
        return self._sumo.lost

    @property
    def ego_error_m(self) -> float:
        """By how much a platform was elsewhere in SUMO than it was put, at most."""
        return self._sumo.ego_error_m

    def road_users(self) -> Array:
        """Return where everybody is, float64 [users, FIELDS] as `RoadUser`."""
        return np.vstack((self._beside.road_users(), self._sumo.road_users(self._number)))

    def step(self, ego: Box | None) -> Array:
        """Return where everybody is now: SUMO has stepped for all platforms."""
        if self.lost is None:
            self.signals.take(self._sumo.signals.now)
        return self.road_users()

    def push(self, number: float, change_mps: float) -> None:
        """Change the speed of one of SUMO's, who has collided; a platform finds the touch itself."""
        if not self._beside.is_platform(number):
            self._sumo.push(number, change_mps)

    def close(self) -> None:
        """Do nothing: SUMO is ended with the drive, once for all."""


def shared_sumo(
    parts: Sequence[ResolvedSession], consoles: Sequence[Console], company: Company, stack: ExitStack
) -> SharedSumo | None:
    """Start the SUMO of a session with several platforms, which `stack` ends; None where it has no traffic.

    Raises:
        ProfileError: SUMO is missing or refuses, or its period is no whole number of control periods.
    """
    first, tick_hz = parts[0], consoles[0].tick_hz
    profile, mode = first.session.environment.traffic, first.session.mode
    if profile is None:
        return None
    _, period_ticks = roads_and_period(first, profile, tick_hz)
    if period_ticks % mode.control_period_ticks:
        raise ProfileError(
            f"environment.traffic.period_ms: value {profile.period_ms}: of several platforms a whole number of"
            f" control periods (mode.control_period_ms: {mode.control_period_ms})"
        )
    sumo = sumo_beside(first, profile, tick_hz, tuple(company.boxes()))
    stack.callback(sumo.close)
    return SharedSumo(sumo, company, tick_hz, period_ticks)
