"""Steering without a wheel: keys and sticks turn the hand wheel less and slower the faster the car is. Pure.

The side force of a given angle grows with the square of the speed. A key has one strength and a stick's travel is a
thumb's: both would throw a fast car off the road. So the angle at full deflection falls as the side force grows.
"""

import math
from typing import NamedTuple

from simconsole.devices.calibration.calibrator import wheel_angle
from simconsole.devices.calibration.cockpit_settings import CockpitSettings
from simconsole.devices.calibration.inverse_calibration import wheel_raw
from simconsole.profiles.parts.axes import WheelAxis
from simconsole.values.protocols import DeviceSource
from simconsole.values.signals import DeviceSample
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import RAD_PER_DEG


class Assistance(NamedTuple):
    """How a hand wheel follows keys or a stick."""

    lock_rad: float  # angle at full deflection of a car that stands
    half_at_mps: float  # at this speed it is half of that
    full_s: float  # from the middle to what the speed allows


def assistance_of(wheel: WheelAxis) -> Assistance | None:
    """Return the assistance that a profile describes; None where the axis is that of a real wheel."""
    if wheel.assistance is None:
        return None
    lock_rad = 0.5 * wheel.lock_to_lock_deg * RAD_PER_DEG
    return Assistance(lock_rad, wheel.assistance.half_at_mps, wheel.assistance.full_s)


def limit_rad(speed_mps: float, assistance: Assistance) -> float:
    """Return the hand-wheel angle at full deflection; towards high speeds its side force no longer grows."""
    ratio = speed_mps / assistance.half_at_mps
    return assistance.lock_rad / (1.0 + ratio * ratio)


def rate_radps(speed_mps: float, assistance: Assistance) -> float:
    """Return how fast the hand wheel leaves the middle."""
    return limit_rad(speed_mps, assistance) / assistance.full_s


def turned(now_rad: float, deflection: float, speed_mps: float, assistance: Assistance, step_s: float) -> float:
    """Return the hand-wheel angle one step on.

    It returns to the middle twice as fast as it leaves it, as under the self-aligning torque.

    Args:
        now_rad: The angle, left-positive.
        deflection: Of the stick, 1 full left, -1 full right; a key held is full.
        speed_mps: Of the car; its sign does not matter.
        assistance: How the wheel follows.
        step_s: How long the step is.
    """
    target_rad = min(1.0, max(-1.0, deflection)) * limit_rad(speed_mps, assistance)
    if now_rad * target_rad < 0.0:
        target_rad = 0.0  # through the middle first
    way_rad = target_rad - now_rad
    if abs(target_rad) >= abs(now_rad):
        most_rad = rate_radps(speed_mps, assistance) * step_s
    else:
        largest_rad = max(abs(now_rad), limit_rad(speed_mps, assistance))
        most_rad = 2.0 * largest_rad / assistance.full_s * step_s
    return now_rad + min(most_rad, max(-most_rad, way_rad))


class AssistedSource:
    """A cockpit with a stick: its samples have the wheel axis that the assistance makes of it."""

    def __init__(
        self, source: DeviceSource, settings: CockpitSettings, assistance: Assistance, *, tick_hz: int
    ) -> None:
        """Wrap a source; give it every snapshot, for it must know the car's speed."""
        self._source, self._settings, self._assistance = source, settings, assistance
        self._step_s = 1.0 / tick_hz
        self._angle_rad = self._speed_mps = 0.0

    def publish(self, snapshot: Snapshot) -> None:
        """Note the car's speed."""
        self._speed_mps = snapshot.vehicle.vx_mps

    def poll(self, tick: int) -> DeviceSample:
        """Return the newest sample for `tick`. What cannot be an axis is passed on: calibration refuses it."""
        sample = self._source.poll(tick)
        if not -1.0 <= sample.wheel_axis <= 1.0:
            return sample
        full_rad = abs(
            wheel_angle(math.copysign(1.0, sample.wheel_axis - self._settings.wheel_centre_raw), self._settings)
        )
        deflection = wheel_angle(sample.wheel_axis, self._settings) / full_rad
        self._angle_rad = turned(self._angle_rad, deflection, self._speed_mps, self._assistance, self._step_s)
        return sample._replace(wheel_axis=wheel_raw(self._angle_rad, self._settings))

    def close(self) -> None:
        """Release the devices."""
        self._source.close()
