"""Holding a speed with the throttle: proportional, with an integral that only integrates near the wanted speed. Pure.

Two laws, each with its own tuning. The simulated person's uses the integral of the tick before, integrates slowly, and
not while the pedal is at an end. The test driver's integrates first and quickly, also at an end, and tells when the
speed is held.
"""

from typing import Final

from simconsole.values.state_vector import Snapshot

PATIENT_GAIN_PER_MPS: Final = 0.3
PATIENT_LEARNING_PER_M: Final = 0.05
PATIENT_NEAR_MPS: Final = 2.0
"""The integral only integrates within this deviation from the wanted speed."""

GAIN_PER_MPS: Final = 0.35
LEARNING_PER_M: Final = 0.1
NEAR_MPS: Final = 3.0
HELD_WITHIN_MPS: Final = 0.1
HELD_FOR_S: Final = 1.0


def hold_speed(target_mps: float, speed_mps: float, integral: float, tick_s: float, most: float) -> tuple[float, float]:
    """Return (throttle, integral) of the simulated person; the integral stays while the pedal is at an end."""
    missing_mps = target_mps - speed_mps
    throttle = PATIENT_GAIN_PER_MPS * missing_mps + integral
    if 0.0 < throttle < most and abs(missing_mps) < PATIENT_NEAR_MPS:
        integral += PATIENT_LEARNING_PER_M * missing_mps * tick_s
    return min(most, max(0.0, throttle)), min(most, max(0.0, integral))


class SpeedHolder:
    """The speed controller of the test driver."""

    def __init__(self, speed_mps: float) -> None:
        """Take the speed to hold."""
        self._speed_mps = speed_mps
        self._integral = 0.0
        self._near_s = 0.0

    def __call__(self, snapshot: Snapshot) -> float:
        """Return the throttle."""
        missing = self._speed_mps - snapshot.vehicle.vx_mps
        if abs(missing) < NEAR_MPS:
            self._integral += LEARNING_PER_M * missing / snapshot.tick_hz
        self._near_s = self._near_s + 1.0 / snapshot.tick_hz if abs(missing) < HELD_WITHIN_MPS else 0.0
        self._integral = min(1.0, max(0.0, self._integral))
        return min(1.0, max(0.0, GAIN_PER_MPS * missing + self._integral))

    @property
    def settled(self) -> bool:
        """Whether the speed has been held for a second."""
        return self._near_s > HELD_FOR_S
