"""A test driver's skills: get to a speed, let the car roll, keep to a line. The car works clutch and gears itself."""

from collections.abc import Callable
from typing import Final

from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.values.signals import Mode
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import MPS_PER_KMH

SETTLE_S: Final = 0.6
"""Pedals at rest until the console has seen them; and what the automatic needs to leave its gear."""
SPARE_MPS: Final = 1.0
"""The run-up goes beyond the test's speed; the car rolls down to it with nothing pressed."""
SPEED_GAIN_PER_MPS: Final = 0.35
LEARNING_PER_M: Final = 0.1
NEAR_MPS: Final = 3.0
"""Only this near to the wanted speed does the foot learn what holds it."""

# Back to the line: by where the car will be a moment on, its heading, and its yaw rate against overdoing it.
LINE_GAIN_RADPM: Final = 0.12
LINE_AHEAD_M: Final = 1.3
HEADING_GAIN: Final = 0.9
YAW_RATE_GAIN_S: Final = 0.25
MOST_ROAD_WHEEL_RAD: Final = 0.5

Pilot = Callable[[Snapshot], Intent | None]
"""Looks at the last tick and says what hands and feet do now; None ends the drive."""
Steps = Callable[[Snapshot, float], Intent | None]
"""The test itself, after the run-up: the last tick, and the time in s since the test began."""


def keep_line(snapshot: Snapshot, ratio: float) -> float:
    """Return the hand-wheel angle in rad that keeps the car on the x axis."""
    seen = snapshot.vehicle
    wanted = -LINE_GAIN_RADPM * (seen.y_m + LINE_AHEAD_M * seen.yaw_rad)
    wanted -= HEADING_GAIN * seen.yaw_rad + YAW_RATE_GAIN_S * seen.yaw_rate_radps
    return ratio * min(MOST_ROAD_WHEEL_RAD, max(-MOST_ROAD_WHEEL_RAD, wanted))


class RunUp:
    """A pilot that gets to a speed on the x axis and then hands over to the test."""

    def __init__(self, speed_kmh: float, ratio: float, steps: Steps, rolling: bool = True, most: float = 1.0) -> None:
        """Take the seat.

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
        self._hold = HoldSpeed(self._speed_mps)
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
            if self._hold.settled(snapshot):
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


class HoldSpeed:
    """A foot that holds a speed: proportional, with an integral that only learns near it."""

    def __init__(self, speed_mps: float) -> None:
        self._speed_mps = speed_mps
        self._learnt = 0.0
        self._near_s = 0.0

    def __call__(self, snapshot: Snapshot) -> float:
        """Return the throttle."""
        missing = self._speed_mps - snapshot.vehicle.vx_mps
        if abs(missing) < NEAR_MPS:
            self._learnt += LEARNING_PER_M * missing / snapshot.tick_hz
        self._near_s = self._near_s + 1.0 / snapshot.tick_hz if abs(missing) < 0.1 else 0.0
        self._learnt = min(1.0, max(0.0, self._learnt))
        return min(1.0, max(0.0, SPEED_GAIN_PER_MPS * missing + self._learnt))

    def settled(self, snapshot: Snapshot) -> bool:
        """Return whether the speed has been held for a second."""
        return self._near_s > 1.0
