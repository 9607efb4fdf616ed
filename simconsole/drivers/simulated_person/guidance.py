"""Where a person wants to go and how fast: straight on, or along a route. Pure."""

from typing import Final, NamedTuple, Protocol

from simconsole.drivers.line_keeper import Line, pure_pursuit
from simconsole.drivers.simulated_person.view import View
from simconsole.profiles.person import Habits, PersonPlan
from simconsole.values.units import MPS_PER_KMH


class Pace(NamedTuple):
    """What the feet should bring about."""

    target_mps: float
    brake: float  # pedal, 0 to 1
    hurried: bool = False  # the engine should work: far below the speed that the way allows


class Guidance(Protocol):
    """What a person steers and paces by. `look` comes first in each tick."""

    def look(self, view: View) -> None:
        """See one tick, whoever drives."""

    def begin(self, view: View, hand_wheel_rad: float) -> None:
        """Start to steer, from where the wheel is."""

    def settle(self, view: View) -> None:
        """Have the car alone, from now: whoever drove has let go."""

    def steer(self, view: View) -> float:
        """Return where the hands should turn the wheel, in rad."""

    def pace(self, view: View) -> Pace:
        """Return what the feet should bring about."""

    def arrived(self, view: View) -> bool:
        """Return whether there is nowhere to go on to."""


class StraightOn:
    """Along the straight through where the person begins, at one speed."""

    def __init__(self, plan: PersonPlan) -> None:
        """Take the plan."""
        self._habits = plan.habits
        self._pace: Final = Pace(plan.cruise_kmh * MPS_PER_KMH, 0.0)
        self._line: Line | None = None
        self._held_rad: float | None = None

    def look(self, view: View) -> None:
        """Take the straight through the first view."""
        if self._line is None:
            self._line = Line(view.x_m, view.y_m, view.yaw_rad)

    def begin(self, view: View, hand_wheel_rad: float) -> None:
        """Hold the wheel as it is: it steers for as long as somebody else does."""
        self._held_rad = hand_wheel_rad

    def settle(self, view: View) -> None:
        """Go straight on from here."""
        self._held_rad = None
        self._line = Line(view.x_m, view.y_m, view.yaw_rad)

    def steer(self, view: View) -> float:
        """Return the hand-wheel angle that leads back to the straight."""
        if self._held_rad is not None or self._line is None:
            return self._held_rad or 0.0
        return steer_along(self._line, view, self._habits)

    def pace(self, view: View) -> Pace:
        """Return the plan's speed."""
        return self._pace

    def arrived(self, view: View) -> bool:
        """Return False: a straight has no end."""
        return False


def steer_along(line: Line, view: View, habits: Habits) -> float:
    """Return the hand-wheel angle in rad that leads back to the line."""
    ahead_m = max(habits.look_ahead_min_m, abs(view.speed_mps) * habits.look_ahead_s)
    beside = line.deviation(view.x_m, view.y_m, view.yaw_rad)
    return pure_pursuit(beside, ahead_m, habits.wheelbase_m) * habits.steering_ratio
