"""How a test driver gets to the speed of a manoeuvre, on a straight line. The car is an automatic. Pure."""

from collections.abc import Callable
from typing import Final

from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.drivers.line_keeper import X_AXIS, state_feedback
from simconsole.drivers.speed_holder import SpeedHolder
from simconsole.values.signals import Mode
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import MPS_PER_KMH

SETTLE_S: Final = 0.6
"""Pedals at rest until the console has seen them, and the time the automatic needs to leave its gear."""
SPARE_MPS: Final = 1.0
"""The run-up goes beyond the test's speed; the car rolls down to it with nothing pressed."""

Pilot = Callable[[Snapshot], Intent | None]
"""Looks at the last tick and says what hands and feet do now; None ends the drive."""
Steps = Callable[[Snapshot, float], Intent | None]
"""The test itself, after the run-up: the last tick, and the time in s since the test began."""


def keep_line(snapshot: Snapshot, ratio: float) -> float:
    """Return the hand-wheel angle in rad that keeps the car on the x axis."""
    seen = snapshot.vehicle
    return ratio * state_feedback(X_AXIS.deviation(seen.x_m, seen.y_m, seen.yaw_rad), seen.yaw_rate_radps)


class RunUp:
    """A pilot that reaches a speed on the x axis and then hands over to the test."""

    def __init__(self, speed_kmh: float, ratio: float, steps: Steps, rolling: bool = True, most: float = 1.0) -> None:
        """Prepare the run-up.

        Args:
            speed_kmh: at which the test begins.
            ratio: hand-wheel angle per road-wheel angle.
            steps: the test.
            rolling: begin it out of gear, rolling down to the speed; otherwise in gear, with the speed held.
            most: throttle of the run-up.
        """
        self._speed_mps = speed_kmh * MPS_PER_KMH
        self._ratio = ratio
        self._steps = steps
        self._rolling = rolling
        self._most = most
        self._released_s: float | None = None
        self._hold = SpeedHolder(self._speed_mps)
        self.began_tick: int | None = None
        """The last tick before the test."""

    def __call__(self, snapshot: Snapshot) -> Intent | None:
        """Return what hands and feet do now."""
        if self.began_tick is not None:
            return self._steps(snapshot, (snapshot.tick - self.began_tick) / snapshot.tick_hz)
        if snapshot.t_s < SETTLE_S or snapshot.arbitration.mode != Mode.MANUAL:
            return Intent()
        hand = keep_line(snapshot, self._ratio)
        speed = snapshot.vehicle.vx_mps
        if not self._rolling:
            if self._hold.settled:
                return self._begin(snapshot)
            return Intent(hand_wheel_rad=hand, throttle=min(self._most, self._hold(snapshot)), gear=1.0)
        if self._released_s is None and speed < self._speed_mps + SPARE_MPS:
            return Intent(hand_wheel_rad=hand, throttle=self._most, gear=1.0)
        if self._released_s is None:
            self._released_s = snapshot.t_s
        if speed <= self._speed_mps and snapshot.t_s > self._released_s + SETTLE_S:
            return self._begin(snapshot)
        return Intent(hand_wheel_rad=hand)

    def _begin(self, snapshot: Snapshot) -> Intent | None:
        self.began_tick = snapshot.tick
        return self._steps(snapshot, 0.0)
