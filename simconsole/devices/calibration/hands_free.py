"""When the person holds what a step asks for: something is held that was not held before, still for a second. Pure."""

from collections import deque
from typing import Final

from simconsole.devices.calibration.input_detection import Reading
from simconsole.profiles.device import DeviceKey

HELD_S: Final = 1.0
APART_RAW: Final = 0.2
"""Two holds differ by at least this much of an axis's half range, or by a button."""
STILL_RAW: Final = 0.04

Readings = dict[DeviceKey, Reading]


def apart(one: Readings, other: Readings, least: float = APART_RAW) -> bool:
    """Return whether two readings are not the same hold: an axis further than `least` off, or another button."""
    for key, reading in one.items():
        before = other.get(key)
        if before is None or before.buttons != reading.buttons:
            return True
        if any(abs(a - b) > least for a, b in zip(reading.axes, before.axes, strict=True)):
            return True
    return False


class HeldStill:
    """Says when a hold is one to take. What was taken last counts again only after something else was held."""

    def __init__(self, rate_hz: int) -> None:
        self._window: deque[Readings] = deque(maxlen=round(HELD_S * rate_hz))
        self._rest: Readings | None = None
        self._taken: Readings | None = None

    def begin(self) -> None:
        """Begin a step."""
        self._window.clear()

    def add(self, readings: Readings, *, at_rest: bool) -> bool:
        """Take a reading; return whether the last second shows one hold that this step may mean.

        Args:
            readings: All devices now.
            at_rest: The step asks for hands off or for the middle, which may look like rest.
        """
        if self._window and apart(readings, self._window[0], STILL_RAW):
            self._window.clear()
        self._window.append(readings)
        if self._rest is not None and not apart(readings, self._rest):
            self._taken = None if not at_rest else self._taken
            if not at_rest:
                return False
        if len(self._window) < (self._window.maxlen or 0):
            return False
        if not at_rest and self._taken is not None and not apart(readings, self._taken):
            return False
        self._taken = readings
        if self._rest is None:
            self._rest = readings
        return True
